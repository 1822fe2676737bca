"""Jobs: submitted, looked at, answered, paused, cancelled; and what they leave behind."""

from __future__ import annotations

import asyncio
from mimetypes import guess_type
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Response
from fastapi import Path as InPath
from fastapi.responses import FileResponse

from foldmill.errors import UnknownName
from foldmill_fabricate.jobs import JobRecord, JobState, Question, Reply, Rest, Submission
from foldmill_fabricate.jobs.values import Happening
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.ledger import SheetRecord
from foldmill_fabricate.service.callers import Caller, Operator, Submitter, Viewer
from foldmill_fabricate.service.desk import Desk
from foldmill_fabricate.service.ids import JobId, OneJob, QuestionId, SheetId
from foldmill_fabricate.service.models import Nothing, PlotterStatus, Priority, SheetPage
from foldmill_fabricate.service.problems import NoSuch
from foldmill_fabricate.service.routes.answers import CHANGING, READING, binary, desk, workshop
from foldmill_fabricate.service.workshop import Workshop

ROUTER = APIRouter(tags=["jobs"])
Shop = Annotated[Workshop, Depends(workshop)]
SOMEBODY = "somebody"
"""Who has sent a request that no token signs, nor ``who``: it need not be who runs the service."""
Who = Annotated[
    str, Query(max_length=60, description="Who says so, where no token tells; for the history.")
]
_SVG = {"content": {"image/svg+xml": {"schema": {"type": "string"}}}, "description": "SVG, mm."}
Name = Annotated[str, InPath(max_length=200)]


def _who(caller: Caller, said: str) -> str:
    return caller.name or said or SOMEBODY


@ROUTER.get("/plotters", responses=READING)
def plotters(shop: Shop, _: Viewer) -> list[PlotterStatus]:
    """List the plotters and what each does now."""
    return shop.plotters()


@ROUTER.post("/jobs", status_code=201, responses=CHANGING)
def submit(asked: Submission, shop: Shop, caller: Submitter, who: Who = "") -> JobRecord:
    """Put a job in the queue of its plotter; the same key again gives the job that is there."""
    job = shop.desk.submit(asked, _who(caller, who))
    shop.wake()
    return job


@ROUTER.get("/jobs", responses=READING)
def jobs(
    shop: Shop,
    _: Viewer,
    state: Annotated[list[JobState] | None, Query(description="Only jobs that stand so.")] = None,
    plotter: Annotated[str, Query(max_length=100, description="Only its jobs.")] = "",
) -> list[JobRecord]:
    """List the last thousand jobs, the newest first."""
    return shop.desk.jobs(state or (), plotter)


@ROUTER.get("/jobs/{job}", responses=READING)
def job(job: JobId, shop: Shop, _: Viewer) -> JobRecord:
    """Tell how a job stands."""
    return shop.desk.job(job)


@ROUTER.get("/questions", responses=READING)
def questions(
    shop: Shop,
    _: Viewer,
    job: OneJob = "",
) -> list[Question]:
    """List what people are asked at the machines now: gates, and how to go on."""
    return shop.desk.questions(job)


@ROUTER.post("/questions/{question}/answer", responses=CHANGING)
def answer(
    question: QuestionId,
    reply: Reply,
    shop: Shop,
    caller: Operator,
    who: Who = "",
) -> JobRecord:
    """Answer a question; its id is good for one answer."""
    asked = shop.desk.store.question(question)
    shop.desk.answer(question, reply, _who(caller, who))
    return shop.desk.job(asked.job)


@ROUTER.post("/jobs/{job}/pause", responses=CHANGING)
def pause(job: JobId, _: Nothing, shop: Shop, caller: Operator, who: Who = "") -> JobRecord:
    """Have nothing more of a job cut for now; at a machine where its tool is up next."""
    return shop.desk.pause(job, _who(caller, who))


@ROUTER.post("/jobs/{job}/resume", responses=CHANGING)
def resume(job: JobId, _: Nothing, shop: Shop, caller: Operator, who: Who = "") -> JobRecord:
    """Take back a pause."""
    found = shop.desk.resume(job, _who(caller, who))
    shop.wake()
    return found


@ROUTER.post("/jobs/{job}/cancel", responses=CHANGING)
def cancel(job: JobId, _: Nothing, shop: Shop, caller: Operator, who: Who = "") -> JobRecord:
    """End a job, at a machine at once; this is no emergency stop."""
    return shop.desk.cancel(job, _who(caller, who))


@ROUTER.post("/jobs/{job}/priority", responses=CHANGING)
def priority(job: JobId, to: Priority, shop: Shop, caller: Operator, who: Who = "") -> JobRecord:
    """Change a job's place in the queue."""
    return shop.desk.prioritise(job, to.priority, _who(caller, who))


@ROUTER.post("/jobs/{job}/remake", status_code=201, responses=CHANGING)
def remake(job: JobId, said: Rest, shop: Shop, caller: Operator, who: Who = "") -> JobRecord:
    """Submit a job of what is missing on a sheet of a job that has ended."""
    made = shop.desk.remake(job, said, _who(caller, who))
    shop.wake()
    return made


@ROUTER.get("/jobs/{job}/history", responses=READING)
def history(job: JobId, shop: Shop, _: Viewer) -> list[Happening]:
    """Tell who did what, and when, to a job and its sheets."""
    return shop.desk.history(job)


@ROUTER.get("/jobs/{job}/sheets", responses=READING)
def sheets(job: JobId, shop: Shop, _: Viewer) -> list[SheetPage]:
    """Tell how far each sheet is: strokes that are certain, doubtful, left."""
    return shop.sheets(shop.desk.job(job))


@ROUTER.get(
    "/jobs/{job}/sheets/{sheet}/{face}.svg",
    responses=READING | {200: _SVG},
    response_class=Response,
)
async def as_cut(
    job: JobId,
    sheet: SheetId,
    face: Face,
    shop: Shop,
    at: Annotated[Desk, Depends(desk)],
    _: Viewer,
) -> Response:
    """Get a drawing of a face as it is cut: what is certain, doubtful, left."""
    folder, cut = await asyncio.to_thread(_sheet_of, shop, job, sheet)
    drawn = await at.as_cut(folder, cut, face)
    return Response(drawn, media_type="image/svg+xml")


def _sheet_of(shop: Workshop, job: str, sheet: str) -> tuple[Path, SheetRecord]:
    """Return the job folder of a job and one of its sheets; raises NoSuch for none."""
    found = shop.desk.job(job)
    if sheet.upper() not in found.sheets:
        raise NoSuch(str(UnknownName.of(f"sheet of job {found.id}", sheet, found.sheets)))
    return shop.desk.plans.folder(found.plan), shop.desk.sheet(sheet)


@ROUTER.get("/jobs/{job}/transcripts", responses=READING)
def transcripts(job: JobId, shop: Shop, _: Viewer) -> list[str]:
    """List the transcripts of a job: what went over the wire, the oldest first."""
    return [path.name for path in shop.places.transcripts(shop.desk.job(job).id)]


@ROUTER.get(
    "/jobs/{job}/transcripts/{name}",
    responses=READING | binary("application/jsonl", "One JSON object a line."),
    response_class=FileResponse,
)
def transcript(job: JobId, name: Name, shop: Shop, _: Viewer) -> FileResponse:
    """Get what went over the wire, with times."""
    known = {path.name: path for path in shop.places.transcripts(shop.desk.job(job).id)}
    if name not in known:
        raise NoSuch(str(UnknownName.of("transcript", name, known)))
    return FileResponse(known[name], media_type="application/jsonl")


@ROUTER.get(
    "/jobs/{job}/files/{name}",
    responses=READING | binary("application/octet-stream", "The file, as its name says."),
    response_class=FileResponse,
)
def file(job: JobId, name: Name, shop: Shop, _: Viewer) -> FileResponse:
    """Get a file of the plan that a job is made from: plan.json has material and machine whole."""
    folder = shop.desk.plans.folder(shop.desk.job(job).plan)
    known = {path.name: path for path in folder.iterdir()}
    if name not in known:
        raise NoSuch(str(UnknownName.of("file", name, known)))
    kind = guess_type(name)[0] or "application/octet-stream"
    return FileResponse(known[name], media_type=kind, filename=name)
