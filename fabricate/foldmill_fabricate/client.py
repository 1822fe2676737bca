"""A client of the service, typed: the values of the API, and its refusals as the errors they are.

    with Client() as service:                       # the service of this user on this computer
        star = service.design(DesignRequest(family="rotational", preset="star-n6"))
        plan = service.planned(PlanRequest(pattern=star.id, material="pp-0.75",
                                           machine="generic-hpgl-600"))
        job = service.submit(Submission(plan=plan.plan, plotter="bench"))
        for event in service.follow(job=job.id):
            ...

It has the verbs of ``foldmill_fabricate.jobs.Jobs``, so that whoever uses those need not know where
the jobs are. A service elsewhere wants a token, and its name signs; else ``who`` does, by default
whoever is at this computer.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from foldmill_fabricate.calling import Calling
from foldmill_fabricate.files import write_all
from foldmill_fabricate.jobs.rows import person
from foldmill_fabricate.jobs.states import JobState
from foldmill_fabricate.jobs.values import (
    Event,
    Happening,
    JobRecord,
    Question,
    Reply,
    Rest,
    Submission,
)
from foldmill_fabricate.names import PLAN
from foldmill_fabricate.service import answers, models
from foldmill_fabricate.service.answers import Unreachable as Unreachable
from foldmill_fabricate.service.unpacking import pack

if TYPE_CHECKING:
    from foldmill_fabricate.foreign import Asked

T = TypeVar("T")
_LOOK = 0.3
"""s between two looks at a plan that is being made."""


class Client(Calling):
    """A service, at an address.

    url : by default where this user's service says it is. token : as ``foldmill serve --new-token``
    told it. seconds : how long an answer may take. Raises Unreachable where no service runs,
    InvalidInput for what is no address or no token.
    """

    # ── what there is ────────────────────────────────────────────────────────────────────────────

    def about(self) -> models.About:
        """Return what answers, and what this client may do."""
        return self._get(models.About, "")

    def families(self) -> list[models.FamilyRow]:
        """Return the families of patterns."""
        return self._get(list[models.FamilyRow], "/families")

    def family(self, slug: str) -> models.Family:
        """Return a family with its parameters."""
        return self._get(models.Family, f"/families/{answers.quoted(slug)}")

    def materials(self) -> list[models.PresetRow]:
        """Return the sheet materials."""
        return self._get(list[models.PresetRow], "/materials")

    def material(self, slug: str) -> models.PresetPage:
        """Return a material with its fields."""
        return self._get(models.PresetPage, f"/materials/{answers.quoted(slug)}")

    def machines(self) -> list[models.PresetRow]:
        """Return the machines."""
        return self._get(list[models.PresetRow], "/machines")

    def machine(self, slug: str) -> models.PresetPage:
        """Return a machine with its fields."""
        return self._get(models.PresetPage, f"/machines/{answers.quoted(slug)}")

    def plotters(self) -> list[models.PlotterStatus]:
        """Return the plotters, and what each does now."""
        return self._get(list[models.PlotterStatus], "/plotters")

    # ── patterns and plans ───────────────────────────────────────────────────────────────────────

    def design(self, request: models.DesignRequest) -> models.Pattern:
        """Make a design."""
        return self._post(models.Pattern, "/designs", request.model_dump(mode="json"))

    def upload(
        self,
        content: bytes,
        said: models.Upload = models.Upload(),  # noqa: B008 - frozen
    ) -> models.Pattern:
        """Keep the pattern of a file; ``said`` : what it is, and what it does not say itself."""
        asked = said.model_dump(mode="json", exclude_defaults=True)
        return self._send(models.Pattern, "/patterns", content, asked)

    def pattern(self, digest: str) -> models.Pattern:
        """Return what is known of a pattern."""
        return self._get(models.Pattern, f"/patterns/{answers.quoted(digest)}")

    def fold(self, digest: str) -> bytes:
        """Return the FOLD file of a pattern."""
        return self._bytes(f"/patterns/{answers.quoted(digest)}/pattern.fold")

    def drawing(self, digest: str, name: str) -> bytes:
        """Return a drawing of a pattern, such as pattern.svg or folded.glb."""
        return self._bytes(f"/patterns/{answers.quoted(digest)}/drawings/{answers.quoted(name)}")

    def check(self, digest: str) -> models.Report:
        """Check that a pattern folds."""
        return self._get(models.Report, f"/patterns/{answers.quoted(digest)}/check")

    def plan(self, request: models.PlanRequest) -> models.PlanStatus:
        """Have a sheet planned; return how that stands."""
        return self._post(models.PlanStatus, "/plans", request.model_dump(mode="json"))

    def plan_status(self, digest: str) -> models.PlanStatus:
        """Return how a plan stands."""
        return self._get(models.PlanStatus, f"/plans/{answers.quoted(digest)}")

    def planned(self, request: models.PlanRequest) -> models.PlanStatus:
        """Have a sheet planned and wait for it; raises CannotPlan with the sentence."""
        status = self.plan(request)
        while status.state is models.PlanState.WAITING:
            time.sleep(_LOOK)
            status = self.plan_status(status.id)
        return answers.done(status)

    def plan_drawing(self, content: bytes, asked: Asked) -> models.KeptPlan:
        """Have an HP-GL drawing from elsewhere planned, proved and kept, as ``asked`` says."""
        said = asked.model_dump(mode="json", exclude_defaults=True)
        return self._send(models.KeptPlan, "/plans/drawn", content, said)

    def verification(self, digest: str) -> models.Verification:
        """Verify a plan on a virtual sheet."""
        return self._get(models.Verification, f"/plans/{answers.quoted(digest)}/verification")

    def save(self, plan: models.PlanStatus, folder: Path) -> None:
        """Write the files of a plan that is done into a folder, plan.json last."""
        names = sorted((row.name for row in plan.files), key=lambda name: name == PLAN)
        write_all(folder, {n: self._bytes(f"/plans/{plan.id}/files/{n}") for n in names})

    # ── jobs ─────────────────────────────────────────────────────────────────────────────────────

    def keep(self, folder: Path) -> str:
        """Keep a job folder; return the id of its plan. Raises OSError where it cannot be read."""
        return self._send(models.KeptPlan, "/plans/kept", pack(folder), {}).plan

    def keep_drawing(self, content: bytes, asked: Asked) -> str:
        """Have an HP-GL drawing planned and kept; return the id of its plan."""
        return self.plan_drawing(content, asked).plan

    def submit(self, asked: Submission, who: str = "") -> JobRecord:
        """Put a job in the queue of its plotter."""
        return self._change("/jobs", asked.model_dump(mode="json"), who)

    def machine_of(self, plotter: str) -> str:
        """Return the slug of a plotter's machine; raises NoSuchJob."""
        return answers.named(self.plotters(), plotter).machine

    def jobs(self, states: Sequence[JobState] = (), plotter: str = "") -> list[JobRecord]:
        """Return jobs, the newest first."""
        asked = {"state": [state.value for state in states], "plotter": plotter}
        return self._get(list[JobRecord], "/jobs", asked)

    def job(self, name: str) -> JobRecord:
        """Return a job."""
        return self._get(JobRecord, f"/jobs/{answers.quoted(name)}")

    def questions(self, job: str = "") -> list[Question]:
        """Return what people are asked now."""
        return self._get(list[Question], "/questions", {"job": job})

    def answer(self, question: str, reply: Reply, who: str = "") -> None:
        """Answer a question, once."""
        path = f"/questions/{answers.quoted(question)}/answer"
        self._change(path, reply.model_dump(mode="json"), who)

    def pause(self, name: str, who: str = "") -> JobRecord:
        """Have nothing more of a job cut for now."""
        return self._want(name, "pause", {}, who)

    def resume(self, name: str, who: str = "") -> JobRecord:
        """Take back a pause."""
        return self._want(name, "resume", {}, who)

    def cancel(self, name: str, who: str = "") -> JobRecord:
        """End a job."""
        return self._want(name, "cancel", {}, who)

    def prioritise(self, name: str, priority: int, who: str = "") -> JobRecord:
        """Change a job's place in the queue."""
        return self._want(name, "priority", {"priority": priority}, who)

    def remake(self, name: str, said: Rest, who: str = "") -> JobRecord:
        """Submit a job of what is missing on a sheet of an ended job."""
        return self._want(name, "remake", said.model_dump(mode="json"), who)

    def history(self, name: str) -> list[Happening]:
        """Return who did what, and when, to a job and its sheets."""
        return self._get(list[Happening], f"/jobs/{answers.quoted(name)}/history")

    def sheets(self, name: str) -> list[models.SheetPage]:
        """Return how far each sheet of a job is."""
        return self._get(list[models.SheetPage], f"/jobs/{answers.quoted(name)}/sheets")

    def as_cut(self, name: str, sheet: str, face: str) -> bytes:
        """Return a drawing, SVG, of how a face of a sheet is cut by now."""
        path = f"/jobs/{answers.quoted(name)}/sheets/{answers.quoted(sheet)}"
        return self._bytes(f"{path}/{answers.quoted(face)}.svg")

    def transcripts(self, name: str) -> list[str]:
        """Return the names of what went over the wire for a job, the oldest first."""
        return self._get(list[str], f"/jobs/{answers.quoted(name)}/transcripts")

    def transcript(self, name: str, file: str) -> bytes:
        """Return what went over the wire, JSON lines."""
        path = f"/jobs/{answers.quoted(name)}/transcripts/{answers.quoted(file)}"
        return self._bytes(path)

    def job_file(self, name: str, file: str) -> bytes:
        """Return a file of the plan that a job is made from."""
        return self._bytes(f"/jobs/{answers.quoted(name)}/files/{answers.quoted(file)}")

    def follow(
        self,
        after: int = 0,
        job: str = "",
        patience: float = 60.0,
        tell: Callable[[Any], None] = lambda _progress: None,
    ) -> Iterator[Event]:
        """Yield what happens to jobs, from the event after ``after`` on, without end.

        A connection that breaks is made again, and nothing is missed nor told twice; raises
        Unreachable after ``patience`` seconds without one. tell : hears how far sheets are.
        """
        return answers.follow(self._http, after, job, patience, tell)

    # ── on the wire ──────────────────────────────────────────────────────────────────────────────

    def _want(self, name: str, verb: str, body: Any, who: str) -> JobRecord:
        return self._change(f"/jobs/{answers.quoted(name)}/{verb}", body, who)

    def _change(self, path: str, body: Any, who: str) -> JobRecord:
        """Change a job in somebody's name; where the service wants a token, that is the token's."""
        signed = {"who": who or person()[:60]}
        return self._read(JobRecord, self._answered("POST", path, json=body, params=signed))
