"""Rows of the tables of jobs as values, and values as rows."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from sqlalchemy import Connection, Select, case, func, select

from foldmill_fabricate.jobs.errors import NoSuchJob
from foldmill_fabricate.jobs.states import ACTIVE, JobState
from foldmill_fabricate.jobs.tables import JOB_SHEETS, JOBS
from foldmill_fabricate.jobs.values import Event, JobRecord, Order, Submission
from foldmill_fabricate.plotter.errors import Fenced
from foldmill_fabricate.plotter.ledger.ledger import LETTERS
from foldmill_fabricate.plotter.ledger.writing import person as person

WORKER = "foldmill"
"""Who does what no person does."""
_LENGTH = 6

_EVENTS = 0x666F6C64
"""Names the lock of whoever numbers events, within a database."""


@dataclass(frozen=True)
class About:
    """What a plan, or an order, says of itself."""

    title: str
    material: str
    machine: str


def digest(asked: Submission) -> str:
    """Return what tells one submission from another, its key left out.

    Only what differs from the defaults counts: a later version that knows more to ask for has the
    same digest for who does not ask for it.
    """
    told = asked.model_dump(mode="json", exclude={"key"}, exclude_defaults=True)
    return _sha256(json.dumps(told, sort_keys=True))


def is_same(row: Any, asked: Submission) -> bool:
    """Tell whether a job's row is of the same submission, by this version or an earlier one."""
    return row.content in {digest(asked), _earlier_digest(row.order, asked)}


def number_in_order(at: Connection) -> None:
    """Have the events of this transaction numbered in the order in which they can be read.

    PostgreSQL gives a number before others see the row: whoever heard number 5 by then would miss
    number 4. So one writes at a time, from here to the end of its transaction; SQLite does so
    anyway.
    """
    if at.dialect.name == "postgresql":
        at.execute(select(func.pg_advisory_xact_lock(_EVENTS)))


def _earlier_digest(order: str, asked: Submission) -> str:
    """Return the digest that the first versions kept: over each field there was then, as written.

    order : as the row has it, for no later version writes the same; empty where it is another.
    """
    if asked.design is not None and not _is_order(order, asked.design):
        return ""
    head = {"plan": asked.plan, "design": None, "plotter": asked.plotter, "copies": asked.copies}
    told = {**head, "priority": asked.priority, "remakes": asked.remakes}
    text = json.dumps(told, separators=(",", ":"), ensure_ascii=False)
    return _sha256(text.replace('"design":null', f'"design":{order or "null"}', 1))


def _is_order(text: str, design: Order) -> bool:
    try:
        return Order.model_validate_json(text) == design
    except ValidationError:
        return False


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def new_id(at: Connection) -> str:
    """Return a short id that no job has."""
    while True:
        name = "".join(secrets.choice(LETTERS) for _ in range(_LENGTH))
        if at.execute(select(JOBS.c.id).where(JOBS.c.id == name)).first() is None:
            return name


def job_values(asked: Submission, about: About, content: str) -> dict[str, Any]:
    """Return what a job is stored with when it is new."""
    return {
        "key": asked.key or None,
        "content": content,
        "plotter": asked.plotter,
        "plan": asked.plan,
        "order": asked.design.model_dump_json() if asked.design else "",
        "copies": asked.copies,
        "priority": asked.priority,
        "begun": False,
        "remakes": asked.remakes,
        **vars(about),
    }


def job_row(at: Connection, name: str, *, lock: bool = False) -> Any:
    """Return a job's row; lock : nobody else changes it until the transaction ends."""
    wanted = select(JOBS).where(JOBS.c.id == name.upper())
    row = at.execute(wanted.with_for_update() if lock else wanted).first()
    if row is None:
        raise NoSuchJob(
            f"There is no job {name[:20]!r}; `foldmill job list` shows those there are."
        )
    return row


def held_row(at: Connection, name: str, token: int) -> Any:
    """Return a job's row, locked, for the hand that holds it; raises Fenced for another."""
    row = job_row(at, name, lock=True)
    require_hold(row.token, token, row.id)
    return row


def require_hold(current: int, token: int, name: str) -> None:
    """Raise Fenced where a token is no longer the one of its job."""
    if current != token:
        raise Fenced(f"Job {name} was taken over by another process; this one stops.")


def sheets(at: Connection, names: Collection[str]) -> dict[str, tuple[str, ...]]:
    """Return the ids of the sheets that jobs have begun, in order, by the job."""
    wanted = select(JOB_SHEETS.c.job, JOB_SHEETS.c.sheet).where(JOB_SHEETS.c.job.in_(names))
    found: dict[str, tuple[str, ...]] = dict.fromkeys(names, ())
    for job, sheet in at.execute(wanted.order_by(JOB_SHEETS.c.number)):
        found[job] += (sheet,)
    return found


def records(at: Connection, found: Sequence[Any]) -> list[JobRecord]:
    """Return rows as values; the sheets of all are asked for at once."""
    names = set(JobRecord.model_fields) - {"state", "sheets"}
    begun = sheets(at, [row.id for row in found])
    return [
        JobRecord(
            state=JobState(row.state),
            sheets=begun[row.id],
            **{name: getattr(row, name) for name in names},
        )
        for row in found
    ]


def event(row: Any) -> Event:
    """Return a row as a value."""
    head = {name: getattr(row, name) for name in ("number", "when", "job", "who", "what")}
    return Event(state=JobState(row.state), **head)


def next_job(plotter: str) -> Select[Any]:
    """Return the statement that finds the job that has a plotter, or else is next on it."""
    has = JOBS.c.begun & JOBS.c.state.in_([state.value for state in ACTIVE])
    waits = JOBS.c.state == JobState.SUBMITTED.value
    first = case((has, 0), else_=1)
    wanted = select(JOBS).where(JOBS.c.plotter == plotter, has | waits)
    order = wanted.order_by(first, JOBS.c.priority.desc(), JOBS.c.number)
    return order.limit(1).with_for_update()


def cannot(row: Any, what: str) -> str:
    """Say why a job cannot be changed."""
    begun = " and begun" if row.begun and row.state != JobState.RUNNING.value else ""
    return f"Job {row.id} is {row.state}{begun}; it cannot {what}."
