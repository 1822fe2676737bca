"""What may be done with jobs: one set of verbs for the terminal, the HTTP API and scripts.

It reads and writes the store; whoever works on the jobs hears of it there. ``client`` offers the
same verbs over HTTP. What only some verbs need is loaded by those: who lists jobs waits for no
planner.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.jobs.errors import JobRefused
from foldmill_fabricate.jobs.places import Places
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.jobs.plotters import Plotter, find
from foldmill_fabricate.jobs.rows import About, person
from foldmill_fabricate.jobs.states import JobState
from foldmill_fabricate.jobs.store import JobStore
from foldmill_fabricate.jobs.values import Happening, JobRecord, Question, Reply, Rest, Submission
from foldmill_fabricate.plotter.ledger import SheetRecord, State

if TYPE_CHECKING:
    from foldmill_fabricate.foreign import Asked


class Jobs(Protocol):
    """The verbs, wherever the jobs are."""

    def keep(self, folder: Path) -> str:
        """Keep a job folder; return the id of its plan."""
        ...

    def keep_drawing(self, content: bytes, asked: Asked) -> str:
        """Plan an HP-GL drawing from elsewhere and keep that; return the id of its plan."""
        ...

    def submit(self, asked: Submission, who: str = "") -> JobRecord:
        """Put a job in the queue of its plotter."""
        ...

    def machine_of(self, plotter: str) -> str:
        """Return the slug of a plotter's machine."""
        ...

    def jobs(self, states: Sequence[JobState] = (), plotter: str = "") -> list[JobRecord]:
        """Return jobs, the newest first."""
        ...

    def job(self, name: str) -> JobRecord:
        """Return a job."""
        ...

    def questions(self, job: str = "") -> list[Question]:
        """Return what people are asked now."""
        ...

    def answer(self, question: str, reply: Reply, who: str = "") -> None:
        """Answer a question, once."""
        ...

    def pause(self, name: str, who: str = "") -> JobRecord:
        """Have nothing more cut for now."""
        ...

    def resume(self, name: str, who: str = "") -> JobRecord:
        """Take back a pause."""
        ...

    def cancel(self, name: str, who: str = "") -> JobRecord:
        """End a job."""
        ...

    def prioritise(self, name: str, priority: int, who: str = "") -> JobRecord:
        """Change a job's place in the queue."""
        ...

    def remake(self, name: str, said: Rest, who: str = "") -> JobRecord:
        """Submit a job of what is missing on a sheet of an ended job."""
        ...

    def history(self, name: str) -> list[Happening]:
        """Return who did what, and when, to a job and its sheets."""
        ...

    def transcripts(self, name: str) -> list[str]:
        """Return the names of what went over the wire for a job, the oldest first."""
        ...


class Desk:
    """The verbs on the store itself. Raises FoldmillErrors with the sentence."""

    def __init__(
        self, places: Places, plotters: Mapping[str, Plotter], store: JobStore | None = None
    ) -> None:
        self.places, self.plotters = places, plotters
        self.store = store or JobStore(places.ledger)
        self.plans = Plans(places.plans, places.keep_days)

    def keep(self, folder: Path) -> str:
        """Keep a job folder; return the id of its plan."""
        return self.plans.keep(folder)

    def keep_drawing(self, content: bytes, asked: Asked) -> str:
        """Plan an HP-GL drawing from elsewhere and keep that; return the id of its plan.

        Raises UnknownName for its material or machine, or what ``foreign.make_folder`` raises.
        """
        from foldmill_fabricate import shelf
        from foldmill_fabricate.foreign import make_folder

        of, on = shelf.material(asked.material), shelf.machine(asked.machine)
        with tempfile.TemporaryDirectory(prefix="foldmill-") as place:
            make_folder(content, asked, of, on, Path(place) / "job")
            return self.plans.keep(Path(place) / "job")

    def submit(self, asked: Submission, who: str = "") -> JobRecord:
        """Put a job in the queue of its plotter.

        Raises NoSuchJob for a plan or plotter that there is not, JobRefused where the plotter is
        another machine than the plan is for, or the plan is not the rest of the sheet it says.
        """
        plotter = find(self.plotters, asked.plotter)
        if bool(asked.plan) == (asked.design is not None):
            raise JobRefused("Submit a plan, or a design to be planned: one of both.")
        if asked.design is not None:
            name = f"{asked.design.family} {asked.design.preset}".strip()
            about, remakes = About(name, asked.design.material, asked.design.machine), ""
        else:
            about, has_programs, remakes = self.plans.told(asked.plan)
            if not has_programs:
                raise CannotSend("This plan holds drawings only; plan it again without --to.")
        if asked.remakes not in {"", remakes}:
            raise JobRefused(f"This is no plan of what is missing on sheet {asked.remakes!r}.")
        if about.machine != plotter.machine:
            raise JobRefused(
                f"This job is planned for {about.machine}, and {plotter.name} is a "
                f"{plotter.machine}: plan it for that machine, or choose another plotter."
            )
        return self.store.submit(asked, about, who)

    def machine_of(self, plotter: str) -> str:
        """Return the slug of a plotter's machine; raises NoSuchJob."""
        return find(self.plotters, plotter).machine

    def jobs(self, states: Sequence[JobState] = (), plotter: str = "") -> list[JobRecord]:
        """Return jobs, the newest first."""
        return self.store.jobs(states, plotter)

    def job(self, name: str) -> JobRecord:
        """Return a job."""
        return self.store.job(name)

    def questions(self, job: str = "") -> list[Question]:
        """Return what people are asked now."""
        return self.store.questions(self.store.job(job).id if job else "")

    def answer(self, question: str, reply: Reply, who: str = "") -> None:
        """Answer a question, once; what cannot be is refused with its sentence."""
        from foldmill_fabricate.jobs.judging import judge

        asked = self.store.question(question)
        job = self.store.job(asked.job)
        judge(asked, reply, lambda: self.plans.plan(job.plan), self.store.ledger)
        self.store.answer(question, reply, who)

    def pause(self, name: str, who: str = "") -> JobRecord:
        """Have nothing more cut for now; at a machine that is where its tool is up next."""
        return self.store.pause(name, who)

    def resume(self, name: str, who: str = "") -> JobRecord:
        """Take back a pause."""
        return self.store.resume(name, who)

    def cancel(self, name: str, who: str = "") -> JobRecord:
        """End a job; at a machine that is at once. What is cut stays in the ledger."""
        return self.store.cancel(name, who)

    def prioritise(self, name: str, priority: int, who: str = "") -> JobRecord:
        """Change a job's place in the queue."""
        return self.store.prioritise(name, priority, who)

    def remake(self, name: str, said: Rest, who: str = "") -> JobRecord:
        """Plan what is missing on a sheet of an ended job, and submit that for the same plotter.

        The same sheet again gives the job that is there, unless that ended before it was begun.
        Raises JobRefused for a job that has not ended or a sheet that is not its own, CannotPlan
        for what cannot be made.
        """
        from foldmill_fabricate.jobs.rest import plan_rest_elsewhere

        job = self.store.job(name)
        sheet = said.sheet.upper() or (job.sheets[-1] if job.sheets else "")
        if not job.is_ended:
            raise JobRefused(
                f"Job {job.id} has not ended, it is {job.state.value}: cancel it first."
            )
        if sheet not in job.sheets:
            known = ", ".join(job.sheets) or "none was begun"
            raise JobRefused(f"Sheet {sheet!r} is none of job {job.id}: {known}.")
        self._give_up(sheet, who)
        with tempfile.TemporaryDirectory(prefix="foldmill-") as place:
            folder = Path(place) / "rest"
            plan_rest_elsewhere(self.places, self.plans.folder(job.plan), folder, sheet, said)
            plan = self.plans.keep(folder)
        asked = Submission(
            plan=plan,
            remakes=sheet,
            plotter=job.plotter,
            priority=said.priority,
            key=self._key_of_rest(sheet),
        )
        return self.submit(asked, who)

    def _key_of_rest(self, sheet: str) -> str:
        """Return the key of the one job that makes the rest of a sheet.

        A job of it that ended before it was begun has made nothing, and does not stand for it.
        """
        idle = self.store.unbegun_remakes(sheet)
        return f"the rest of {sheet}, {1 + idle}" if idle else f"the rest of {sheet}"

    def _give_up(self, sheet: str, who: str) -> None:
        """Give up a sheet that its ended job has left between two programs."""
        record = self.store.ledger.sheet(sheet)
        settled = {State.READY, State.DONE}
        if record.is_begun and record.is_open and {one.state for one in record.records} <= settled:
            self.store.ledger.give_up(sheet, who or person())

    def history(self, name: str) -> list[Happening]:
        """Return who did what, and when, to a job and its sheets."""
        job = self.store.job(name)
        lines = [
            Happening(when=one.when, who=one.who, what=one.what)
            for one in self.store.events(job=job.id, limit=100_000)
        ]
        for sheet in job.sheets:
            lines += [
                Happening(when=when, who=who, what=what, sheet=sheet)
                for when, who, what in self.store.ledger.history(sheet)
            ]
        return sorted(lines, key=lambda line: line.when)

    def transcripts(self, name: str) -> list[str]:
        """Return the files of what went over the wire for a job, the oldest first."""
        return [str(path) for path in self.places.transcripts(self.store.job(name).id)]

    def sheet(self, name: str) -> SheetRecord:
        """Return what the ledger knows of a sheet."""
        return self.store.ledger.sheet(name)
