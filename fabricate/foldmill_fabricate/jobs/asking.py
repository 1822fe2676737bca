"""Questions to the person at a machine: each is asked under an id of its own, good for one answer.

A click that comes late, or twice, meets an id that is spent: it never answers the next question.
"""

from __future__ import annotations

import json
import secrets
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import Connection, insert, select, update

from foldmill_fabricate.jobs.errors import Clash, NoSuchJob
from foldmill_fabricate.jobs.states import JobState
from foldmill_fabricate.jobs.tables import QUESTIONS
from foldmill_fabricate.jobs.values import Kind, Question, Reply

_OPEN, _ANSWERED, _WITHDRAWN = "open", "answered", "withdrawn"
_STANDSTILL = frozenset({Kind.DECIDE, Kind.TROUBLE, Kind.ANOTHER})


@dataclass(frozen=True)
class Asked:
    """What is to be asked."""

    job: str
    kind: Kind
    text: str
    sheet: str = ""
    program: int | None = None
    setup: str = ""
    face: str = ""
    data: Mapping[str, Any] = field(default_factory=dict)

    @property
    def waits_as(self) -> JobState:
        """How the job stands until it is answered."""
        return JobState.NEEDS_OPERATOR if self.kind in _STANDSTILL else JobState.WAITING

    @property
    def why(self) -> str:
        """What the job's record says meanwhile."""
        return self.text.splitlines()[0]


def put(at: Connection, asked: Asked, when: str) -> Question:
    """Write a question down."""
    row: dict[str, Any] = {**vars(asked), "data": json.dumps(dict(asked.data), sort_keys=True)}
    row |= {"kind": asked.kind.value, "asked": when, "id": secrets.token_hex(8)}
    at.execute(insert(QUESTIONS).values(state=_OPEN, **row))
    return Question(**{**row, "data": dict(asked.data)})


def open_ones(at: Connection, job: str = "") -> list[Question]:
    """Return the questions that wait for an answer, the oldest first."""
    wanted = select(QUESTIONS).where(QUESTIONS.c.state == _OPEN).order_by(QUESTIONS.c.number)
    if job:
        wanted = wanted.where(QUESTIONS.c.job == job.upper())
    return [_value(row) for row in at.execute(wanted).all()]


def find(at: Connection, name: str) -> Question:
    """Return a question that waits for its answer; raises NoSuchJob, or Clash once it has it."""
    row = at.execute(select(QUESTIONS).where(QUESTIONS.c.id == name)).first()
    if row is None:
        raise NoSuchJob(f"There is no question {name[:20]!r}; look at the job again.")
    if row.state != _OPEN:
        raise Clash(
            f"This question of job {row.job} was {row.state} already; look at the job again."
        )
    return _value(row)


def answer(at: Connection, name: str, reply: Reply, who: str) -> bool:
    """Write an answer down; False where there is one already."""
    same = (QUESTIONS.c.id == name) & (QUESTIONS.c.state == _OPEN)
    values = {"state": _ANSWERED, "answer": reply.model_dump_json(), "who": who}
    return bool(at.execute(update(QUESTIONS).where(same).values(**values)).rowcount == 1)


def told(question: Question, reply: Reply) -> str:
    """Return what was answered, for the history."""
    if not reply.ok:
        return "no"
    given = reply.model_dump(exclude_defaults=True, exclude={"marks"})
    if reply.marks:
        given["marks"] = len(reply.marks)
    if question.kind is Kind.DECIDE and not reply.word:
        given["word"] = "where the machine stands"
    words = ", ".join(str(given[n]) if n == "word" else f"{n} {given[n]}" for n in given)
    return words or "yes"


def reply(at: Connection, name: str) -> tuple[Reply, str] | None:
    """Return an answer and who gave it; None while there is none."""
    row = at.execute(select(QUESTIONS).where(QUESTIONS.c.id == name)).one()
    if row.state != _ANSWERED:
        return None
    return Reply.model_validate_json(row.answer), str(row.who)


def withdraw(at: Connection, job: str) -> None:
    """Take back what a job has asked; its ids are spent."""
    waiting = (QUESTIONS.c.job == job) & (QUESTIONS.c.state == _OPEN)
    at.execute(update(QUESTIONS).where(waiting).values(state=_WITHDRAWN))


def _value(row: Any) -> Question:
    names = ("id", "job", "sheet", "program", "setup", "face", "text", "asked")
    head = {name: getattr(row, name) for name in names}
    return Question(kind=Kind(row.kind), data=json.loads(row.data), **head)
