"""Jobs in a database, read: every answer is of one moment, and keeps no writer waiting."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Engine, func, select

from foldmill_fabricate.jobs import asking, rows
from foldmill_fabricate.jobs.states import ENDED, JobState
from foldmill_fabricate.jobs.tables import EVENTS, JOB_SHEETS, JOBS
from foldmill_fabricate.jobs.values import Event, JobRecord, Question, Reply
from foldmill_fabricate.plotter.ledger.tables import SHEETS, reading

PAUSE, CANCEL = "pause", "cancel"
"""What a person may want of a job that has its plotter."""


@dataclass(frozen=True)
class Standing:
    """How a job stands that has not ended: what is looked at all the time, in one look."""

    id: str
    plotter: str
    state: JobState
    begun: bool
    wish: str
    """what a person wants of it and is not done yet"""

    @property
    def is_due(self) -> bool:
        """Whether it has its plotter, or waits for nothing else."""
        return self.state is JobState.SUBMITTED or self.begun

    def is_abandoned(self, plotters: Collection[str]) -> bool:
        """Whether a person wants it to end, and it was begun on a plotter that is none of these."""
        return self.begun and self.wish == CANCEL and self.plotter not in plotters


class JobReader:
    """What there is in a store of jobs. Every method raises LedgerFailed where it is away."""

    _engine: Engine

    def job(self, name: str) -> JobRecord:
        """Return a job; raises NoSuchJob."""
        with reading(self._engine) as at:
            return rows.records(at, [rows.job_row(at, name)])[0]

    def order(self, name: str) -> str:
        """Return the order of a design as JSON; empty for a job of a plan."""
        with reading(self._engine) as at:
            return str(rows.job_row(at, name).order)

    def jobs(
        self, states: Sequence[JobState] = (), plotter: str = "", limit: int = 1000
    ) -> list[JobRecord]:
        """Return jobs, the newest first; states : only those that stand so."""
        wanted = select(JOBS).order_by(JOBS.c.number.desc()).limit(limit)
        if states:
            wanted = wanted.where(JOBS.c.state.in_([state.value for state in states]))
        if plotter:
            wanted = wanted.where(JOBS.c.plotter == plotter)
        with reading(self._engine) as at:
            return rows.records(at, at.execute(wanted).all())

    def counts(self) -> dict[JobState, int]:
        """Return how many jobs stand so, for each state."""
        wanted = select(JOBS.c.state, func.count()).group_by(JOBS.c.state)
        with reading(self._engine) as at:
            found = {state: int(count) for state, count in at.execute(wanted)}
        return {state: found.get(state.value, 0) for state in JobState}

    def plans_needed(self) -> set[str]:
        """Return the ids of the plans that a job, or the record of a sheet, refers to."""
        with reading(self._engine) as at:
            by_jobs = at.execute(select(JOBS.c.plan).distinct()).scalars().all()
            by_sheets = at.execute(select(SHEETS.c.job).distinct()).scalars().all()
        return {*by_jobs, *by_sheets} - {""}

    def standing(self) -> list[Standing]:
        """Return how every job stands that has not ended, in the order they came."""
        columns = (JOBS.c.id, JOBS.c.plotter, JOBS.c.state, JOBS.c.begun, JOBS.c.wish)
        wanted = select(*columns).where(JOBS.c.state.not_in([state.value for state in ENDED]))
        with reading(self._engine) as at:
            found = at.execute(wanted.order_by(JOBS.c.number)).all()
        return [Standing(row[0], row[1], JobState(row[2]), *row[3:]) for row in found]

    def due(self) -> dict[str, int]:
        """Return how many jobs of each plotter wait for it or have it."""
        return dict(Counter(job.plotter for job in self.standing() if job.is_due))

    def events(self, after: int = 0, job: str = "", limit: int = 1000) -> list[Event]:
        """Return what happened after an event, the oldest first."""
        wanted = select(EVENTS).where(EVENTS.c.number > after).order_by(EVENTS.c.number)
        if job:
            wanted = wanted.where(EVENTS.c.job == job)
        with reading(self._engine) as at:
            return [rows.event(row) for row in at.execute(wanted.limit(limit)).all()]

    def last_event(self) -> int:
        """Return the number of the newest event; 0 for none."""
        with reading(self._engine) as at:
            return int(at.execute(select(func.max(EVENTS.c.number))).scalar() or 0)

    def wish(self, name: str, token: int) -> str:
        """Return what a person wants of a job: pause, cancel, or nothing.

        Raises Fenced for a hand that lost the job.
        """
        with reading(self._engine) as at:
            row = at.execute(select(JOBS.c.wish, JOBS.c.token).where(JOBS.c.id == name)).one()
        rows.require_hold(row.token, token, name)
        return str(row.wish)

    def questions(self, job: str = "") -> list[Question]:
        """Return what a person is asked now, of one job or of all."""
        with reading(self._engine) as at:
            return asking.open_ones(at, job)

    def question(self, name: str) -> Question:
        """Return a question that waits for its answer; raises NoSuchJob, Clash once it has it."""
        with reading(self._engine) as at:
            return asking.find(at, name)

    def reply(self, name: str) -> tuple[Reply, str] | None:
        """Return the answer to a question and who gave it; None while there is none."""
        with reading(self._engine) as at:
            return asking.reply(at, name)

    def unbegun_remakes(self, sheet: str) -> int:
        """Return how many jobs of the rest of a sheet have ended before a sheet was begun."""
        began = select(JOB_SHEETS.c.job).where(JOB_SHEETS.c.job == JOBS.c.id).exists()
        wanted = select(func.count()).where(JOBS.c.remakes == sheet, ~began)
        with reading(self._engine) as at:
            ended = JOBS.c.state.in_([state.value for state in ENDED])
            return int(at.execute(wanted.where(ended)).scalar() or 0)

    def _by_key(self, key: str) -> Any:
        with reading(self._engine) as at:
            return at.execute(select(JOBS).where(JOBS.c.key == key)).first()
