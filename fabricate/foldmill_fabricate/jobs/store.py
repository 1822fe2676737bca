"""Jobs in a database: every change is a compare-and-set, told in the job's events, in one go."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, insert, update
from sqlalchemy.exc import IntegrityError, SQLAlchemyError

from foldmill_fabricate.jobs import asking, rows
from foldmill_fabricate.jobs.errors import Clash, JobRefused
from foldmill_fabricate.jobs.reading import CANCEL as CANCEL
from foldmill_fabricate.jobs.reading import PAUSE as PAUSE
from foldmill_fabricate.jobs.reading import JobReader
from foldmill_fabricate.jobs.states import ACTIVE, FOLLOWS, JobState
from foldmill_fabricate.jobs.tables import EVENTS, JOB_SHEETS, JOBS, METADATA
from foldmill_fabricate.jobs.values import (
    MOST_URGENT,
    JobRecord,
    Question,
    Reply,
    Submission,
)
from foldmill_fabricate.plotter.errors import LedgerFailed, LedgerRefused
from foldmill_fabricate.plotter.ledger import Ledger
from foldmill_fabricate.plotter.ledger.ledger import utc
from foldmill_fabricate.plotter.ledger.tables import connect
from foldmill_fabricate.plotter.ledger.writing import stamp


class JobStore(JobReader):
    """Jobs and the ledger of their sheets, in one database.

    place : a file, made where there is none, or an SQLAlchemy URL. now : the time on the wall.
    Raises LedgerRefused where it cannot be opened.
    """

    def __init__(self, place: Path | str, now: Callable[[], datetime] = utc) -> None:
        self.ledger = Ledger(place, now, rows.WORKER)
        self._now = now
        try:
            self._engine = connect(place)
            METADATA.create_all(self._engine)
        except LedgerFailed:
            raise
        except SQLAlchemyError as error:
            raise LedgerRefused(f"{place} cannot be opened: {str(error).splitlines()[0]}") from None

    def close(self) -> None:
        """Let go of the database."""
        self._engine.dispose()
        self.ledger.close()

    # ── what is asked for ────────────────────────────────────────────────────────────────────────

    def submit(self, asked: Submission, about: rows.About, who: str = "") -> JobRecord:
        """Keep a job; a key that was used before for the same gives the job that is there.

        about : what the plan says of itself, or the order. Raises Clash for a key that was used
        for something else.
        """
        content = rows.digest(asked)
        if asked.key and (known := self._by_key(asked.key)):
            return _same(known, asked, self)
        try:
            with self._engine.begin() as at:
                name = rows.new_id(at)
                state = JobState.SUBMITTED if asked.plan else JobState.PLANNING
                values = rows.job_values(asked, about, content)
                row = {"id": name, "state": state.value, "submitted": stamp(self._now())}
                at.execute(insert(JOBS).values(who=who or rows.person(), **row, **values))
                what = f"{asked.copies} × {about.title} for {asked.plotter}"
                self._note(at, name, f"submitted: {what}", state, who)
        except IntegrityError:
            known = self._by_key(asked.key) if asked.key else None
            if known is None:
                raise
            return _same(known, asked, self)
        return self.job(name)

    def planned(self, name: str, plan: str, about: rows.About) -> JobRecord:
        """Say which plan an ordered design has become; the job waits for its plotter from now on.

        One that was cancelled meanwhile stays so.
        """
        values = {"plan": plan, **vars(about)}
        self._change(name, JobState.SUBMITTED, "planned", from_=JobState.PLANNING, values=values)
        return self.job(name)

    def refused(self, name: str, why: str) -> JobRecord:
        """Say that an ordered design cannot be planned."""
        self._change(name, JobState.FAILED, why, from_=JobState.PLANNING, note=why)
        return self.job(name)

    def hold(self, name: str, why: str) -> None:
        """Say why an ordered design is not planned yet; it is tried again."""
        with self._engine.begin() as at:
            row = rows.job_row(at, name, lock=True)
            if row.state == JobState.PLANNING.value and row.note != why:
                self._set(at, row, JobState.PLANNING, f"not planned yet: {why}", rows.WORKER, why)

    # ── what a person wants ──────────────────────────────────────────────────────────────────────

    def pause(self, name: str, who: str = "") -> JobRecord:
        """Have nothing more of a job cut for now; at a machine that is where the tool is up."""
        return self._want(name, PAUSE, JobState.PAUSED, who)

    def cancel(self, name: str, who: str = "") -> JobRecord:
        """End a job; at a machine that is at once. What is cut stays in the ledger."""
        return self._want(name, CANCEL, JobState.CANCELLED, who)

    def _want(self, name: str, wish: str, to: JobState, who: str) -> JobRecord:
        with self._engine.begin() as at:
            row = rows.job_row(at, name, lock=True)
            state = JobState(row.state)
            if to not in FOLLOWS[state] and not (row.begun and state in ACTIVE):
                raise JobRefused(rows.cannot(row, f"be {to.value}"))
            if row.begun:
                if row.wish != CANCEL:
                    at.execute(update(JOBS).where(JOBS.c.id == row.id).values(wish=wish))
                self._note(at, row.id, f"to be {to.value}", state, who)
            else:
                self._set(at, row, to, f"{to.value} before it was begun", who)
        return self.job(name)

    def resume(self, name: str, who: str = "") -> JobRecord:
        """Take back a pause."""
        with self._engine.begin() as at:
            row = rows.job_row(at, name, lock=True)
            paused = row.state == JobState.PAUSED.value
            if (not paused and row.wish != PAUSE) or row.wish == CANCEL:
                raise JobRefused(rows.cannot(row, "be resumed"))
            if row.wish == PAUSE:
                at.execute(update(JOBS).where(JOBS.c.id == row.id).values(wish=""))
            if not row.begun:
                self._set(at, row, JobState.SUBMITTED, "resumed", who)
            else:
                self._note(at, row.id, "to be resumed", JobState(row.state), who)
        return self.job(name)

    def prioritise(self, name: str, priority: int, who: str = "") -> JobRecord:
        """Change a job's place among those that wait for the same plotter."""
        if abs(priority) > MOST_URGENT:
            raise JobRefused(f"A priority lies between -{MOST_URGENT} and {MOST_URGENT}.")
        with self._engine.begin() as at:
            row = rows.job_row(at, name, lock=True)
            state = JobState(row.state)
            if row.begun or not FOLLOWS[state]:
                raise JobRefused(rows.cannot(row, "change its place"))
            at.execute(update(JOBS).where(JOBS.c.id == row.id).values(priority=priority))
            self._note(at, row.id, f"priority {priority}", state, who)
        return self.job(name)

    # ── what the worker does ─────────────────────────────────────────────────────────────────────

    def take(self, plotter: str) -> tuple[JobRecord, int] | None:
        """Return the job that has this plotter, or is next on it, and the token to work on it.

        A job that another hand had keeps nothing of that hand's questions.
        """
        wanted = rows.next_job(plotter)
        with self._engine.begin() as at:
            row = at.execute(wanted).first()
            if row is None:
                return None
            token = row.token + 1
            again = "taken up again" if row.begun else "begun"
            values = {"begun": True, "token": token}
            same = (JOBS.c.id == row.id) & (JOBS.c.token == row.token) & (JOBS.c.state == row.state)
            state = JobState.RUNNING
            done = at.execute(update(JOBS).where(same).values(state=state.value, note="", **values))
            if done.rowcount != 1:
                return None
            asking.withdraw(at, row.id)
            self._note(at, row.id, again, state, rows.WORKER)
        return self.job(row.id), token

    def move(self, name: str, token: int, to: JobState, note: str = "") -> None:
        """Change a job's state, as the one that holds its token; raises Fenced for another."""
        with self._engine.begin() as at:
            row = rows.held_row(at, name, token)
            if row.state != to.value:
                row = self._unpaused(at, row, to)
                self._set(at, row, to, note or to.value, rows.WORKER, note=note)

    def begin_sheet(self, name: str, token: int, sheet: str) -> int:
        """Keep the id of the next sheet of a job; return which one it is: 1, 2, 3 …"""
        with self._engine.begin() as at:
            row = rows.held_row(at, name, token)
            number = 1 + len(rows.sheets(at, [row.id])[row.id])
            at.execute(insert(JOB_SHEETS).values(job=name, number=number, sheet=sheet))
            self._note(at, name, f"sheet {sheet} begun", JobState(row.state), rows.WORKER)
        return number

    def tell(self, name: str, what: str) -> None:
        """Add to the history of a job what no change of it tells."""
        with self._engine.begin() as at:
            row = rows.job_row(at, name)
            self._note(at, row.id, what, JobState(row.state), rows.WORKER)

    def end_abandoned(self, name: str) -> None:
        """End a job that a person wants to end, and whose plotter is no longer there."""
        with self._engine.begin() as at:
            row = rows.job_row(at, name, lock=True)
            if row.wish == CANCEL and JobState(row.state) in ACTIVE:
                at.execute(update(JOBS).where(JOBS.c.id == row.id).values(token=row.token + 1))
                why = f"A person ended it; its plotter {row.plotter} is no longer there."
                self._set(at, row, JobState.CANCELLED, why, rows.WORKER, why)

    # ── questions ────────────────────────────────────────────────────────────────────────────────

    def ask(self, token: int, question: asking.Asked) -> Question:
        """Ask a person; raises Fenced for a hand that lost the job."""
        with self._engine.begin() as at:
            row = rows.held_row(at, question.job, token)
            asking.withdraw(at, row.id)
            made = asking.put(at, question, stamp(self._now()))
            waits = question.waits_as
            row = self._unpaused(at, row, waits)
            self._set(at, row, waits, f"asks: {question.kind.value}", rows.WORKER, question.why)
        return made

    def answer(self, name: str, reply: Reply, who: str = "") -> None:
        """Answer a question, once; raises Clash where somebody has, NoSuchJob for no question."""
        with self._engine.begin() as at:
            question = asking.find(at, name)
            if not asking.answer(at, name, reply, who or rows.person()):
                raise Clash("Somebody has answered this meanwhile; look at the job again.")
            row = rows.job_row(at, question.job)
            what = f"answered: {question.kind.value}: {asking.told(question, reply)}"
            self._note(at, row.id, what, JobState(row.state), who)

    # ── parts of a transaction ───────────────────────────────────────────────────────────────────

    def _change(
        self,
        name: str,
        to: JobState,
        what: str,
        *,
        from_: JobState,
        note: str = "",
        values: dict[str, Any] | None = None,
    ) -> None:
        with self._engine.begin() as at:
            row = rows.job_row(at, name, lock=True)
            if row.state == from_.value:
                if values:
                    at.execute(update(JOBS).where(JOBS.c.id == row.id).values(**values))
                self._set(at, row, to, what, rows.WORKER, note)

    def _unpaused(self, at: Connection, row: Any, to: JobState) -> Any:
        """Lead a paused job over running to where its holder brings it.

        A pause is heard beside the work, at any moment: it must stop none of its steps.
        """
        paused = row.state == JobState.PAUSED.value
        if not paused or to in FOLLOWS[JobState.PAUSED]:
            return row
        self._set(at, row, JobState.RUNNING, JobState.RUNNING.value, rows.WORKER)
        return rows.job_row(at, row.id)

    def _set(
        self, at: Connection, row: Any, to: JobState, what: str, who: str, note: str = ""
    ) -> None:
        """Change a state in a transaction that has locked the row."""
        state = JobState(row.state)
        if to is not state and to not in FOLLOWS[state]:
            raise JobRefused(rows.cannot(row, f"be {to.value}"))
        ended = {"ended": stamp(self._now()), "wish": ""} if not FOLLOWS[to] else {}
        if not FOLLOWS[to]:
            asking.withdraw(at, row.id)
        values = {"state": to.value, "note": note, **ended}
        at.execute(update(JOBS).where(JOBS.c.id == row.id).values(**values))
        self._note(at, row.id, what, to, who)

    def _note(self, at: Connection, name: str, what: str, state: JobState, who: str) -> None:
        row = {"when": stamp(self._now()), "job": name, "who": who or rows.person(), "what": what}
        rows.number_in_order(at)
        at.execute(insert(EVENTS).values(state=state.value, **row))


def _same(row: Any, asked: Submission, store: JobStore) -> JobRecord:
    if not rows.is_same(row, asked):
        raise Clash(
            f"The key {asked.key!r} was used before for job {row.id}, which is something else. "
            "Take another key for this one."
        )
    return store.job(row.id)
