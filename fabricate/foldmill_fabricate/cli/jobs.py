"""Durable jobs: submit, list, show, answer, pause, resume, cancel, put before others, work."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from foldmill import FoldmillError
from foldmill.errors import InvalidInput
from foldmill_fabricate.cli.asking import told
from foldmill_fabricate.cli.layout import hanging, moment
from foldmill_fabricate.cli.marks import read_marks
from foldmill_fabricate.cli.output import AsJson, say

if TYPE_CHECKING:
    from pydantic import BaseModel

    from foldmill_fabricate.jobs import JobRecord, Jobs, Submission
    from foldmill_fabricate.jobs.values import Happening

V = TypeVar("V", bound="BaseModel")
jobs = typer.Typer(
    name="job", no_args_is_help=True, help="Jobs that wait for a plotter, and survive a crash."
)

JobId = Annotated[str, typer.Argument(help="A job's id, as `job list` shows it.")]
More = Annotated[
    list[str] | None,
    typer.Option("--plotter", help="A plotter beside those of plotters.toml: NAME=PORT@MACHINE."),
]
_NOBODY = "Nobody works on jobs now: start `foldmill serve`, or `foldmill job work`."
Who = Annotated[str, typer.Option(help="Who says so; default: whoever is at the computer.")]


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    app.add_typer(jobs)


@jobs.command()
def submit(
    what: Annotated[
        str,
        typer.Argument(
            help="A job folder of `plan`, an HP-GL drawing (.plt, .hpgl), or a family of designs."
        ),
    ],
    on: Annotated[str, typer.Option(help="The plotter's name.")],
    copies: Annotated[int, typer.Option(min=1, help="How many sheets.")] = 1,
    priority: Annotated[int, typer.Option(help="Higher ones are made first.")] = 0,
    key: Annotated[
        str, typer.Option(help="Idempotency key: the same again gives the job that is there.")
    ] = "",
    preset: Annotated[str, typer.Option(help="Of the family.")] = "",
    param: Annotated[
        list[str] | None, typer.Option(help="NAME=VALUE of the family; repeatable.")
    ] = None,
    material: Annotated[
        str, typer.Option(help="Of a family or drawing: a slug of `materials`.")
    ] = "pp-0.75",
    option: Annotated[
        list[str] | None, typer.Option(help="NAME=VALUE of planning, as relief=needed; repeatable.")
    ] = None,
    pen: Annotated[
        list[str] | None,
        typer.Option(help="Of an HP-GL drawing: PEN=score, cut, inner or skip; for each pen."),
    ] = None,
    plotter: More = None,
    who: Who = "",
    as_json: AsJson = False,
) -> None:
    """Put a job in the queue of a plotter: a planned folder, a drawing, a design to be planned."""
    from foldmill_fabricate.cli.ordering import Words, wanted

    desk, works = _desk(plotter)
    words = Words(preset, param or [], material, option or [], pen or [])
    head: dict[str, Any] = {"plotter": on, "copies": copies, "priority": priority, "key": key}
    asked = _submission(**wanted(desk, what, on, words), **head)
    job = desk.submit(asked, who)
    say(as_json, job.model_dump(mode="json"), told(job))
    if not works and not as_json:
        typer.echo(f"It waits. {_NOBODY}", err=True)


@jobs.command(name="list")
def list_jobs(
    every: Annotated[bool, typer.Option("--all", help="Those that have ended, too.")] = False,
    on: Annotated[str, typer.Option(help="Of one plotter only.")] = "",
    as_json: AsJson = False,
) -> None:
    """List jobs, the newest first, and what people are asked."""
    from foldmill_fabricate.jobs.states import ENDED, JobState

    desk, works = _desk(None)
    states = () if every else [state for state in JobState if state not in ENDED]
    found = desk.jobs(states, on)
    asked = desk.questions()
    rows = [job.model_dump(mode="json") for job in found]
    lines = [told(job, asked) for job in found]
    say(as_json, rows, "\n".join(lines) or "No job is under way.")
    if not works and any(job.state not in ENDED for job in found):
        typer.echo(_NOBODY, err=True)


@jobs.command()
def show(
    job: JobId,
    transcript: Annotated[
        bool, typer.Option("--transcript", help="Name the files of what went over the wire.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Tell all about a job: how it stands, what is asked, who did what and when."""
    desk, _ = _desk(None)
    found, history = desk.job(job), desk.history(job)
    asked = desk.questions(found.id)
    data = found.model_dump(mode="json") | {
        "questions": [one.model_dump(mode="json") for one in asked],
        "history": [one.model_dump(mode="json") for one in history],
    }
    lines = [told(found, asked), f"      plan {found.plan or 'not made yet'}"]
    lines += [f"      sheet {sheet}" for sheet in found.sheets]
    lines += ["", *(_happened(one) for one in history)]
    if transcript:
        lines += ["", *map(str, desk.transcripts(found.id))]
    say(as_json, data, "\n".join(lines))


@jobs.command()
def answer(
    question: Annotated[str, typer.Argument(help="A question's id; it is good for one answer.")],
    no: Annotated[bool, typer.Option("--no", help="No; at a gate it ends the job.")] = False,
    sheet: Annotated[str, typer.Option(help="The id that is written on the sheet.")] = "",
    thickness: Annotated[float | None, typer.Option(help="Of the sheet, mm.")] = None,
    temperature: Annotated[float | None, typer.Option(help="Of the sheet, °C.")] = None,
    exposure: Annotated[float | None, typer.Option(help="mm, where set otherwise.")] = None,
    touched: Annotated[bool, typer.Option("--touched", help="The sheet was moved.")] = False,
    marks: Annotated[
        str, typer.Option(help="Where registration marks are seen: x1,y1;x2,y2;… in mm.")
    ] = "",
    verdict: Annotated[str, typer.Option(help="Of a test cut: good, again or stop.")] = "",
    go_on: Annotated[
        str, typer.Option(help="Where a program in doubt goes on: STROKE, or STROKE.VERTEX.")
    ] = "",
    finished: Annotated[bool, typer.Option("--finished", help="All of it is cut.")] = False,
    spoiled: Annotated[bool, typer.Option("--spoiled", help="Give the sheet up.")] = False,
    overlap: Annotated[
        float, typer.Option(min=0, max=20, help="mm of a through-cut that are cut again.")
    ] = 0.0,
    who: Who = "",
) -> None:
    """Say that what a job asks for is done, or how it goes on."""
    from foldmill_fabricate.cli.person import read_word
    from foldmill_fabricate.jobs import Reply

    word = read_word(go_on, finished, overlap)
    if spoiled and word:
        raise FoldmillError("--spoiled gives the sheet up; it goes on nowhere.")
    spoken: dict[str, Any] = {"word": "spoiled"} if spoiled else {}
    if word is not None:
        spoken = {"word": word.word.value, "vertex": word.vertex, "overlap": word.overlap}
        spoken |= {"stroke": word.stroke + 1} if go_on else {}
    reply = _stated(
        Reply,
        ok=not no,
        sheet=sheet,
        thickness=thickness,
        temperature=temperature,
        exposure=exposure,
        touched=touched,
        marks=tuple(read_marks(marks)),
        verdict=verdict,
        **spoken,
    )
    desk, works = _desk(None)
    desk.answer(question, reply, who)
    typer.echo("Answered." if works else f"Answered, to be asked anew. {_NOBODY}")


@jobs.command()
def pause(job: JobId, who: Who = "", as_json: AsJson = False) -> None:
    """Have nothing more of a job cut for now: a machine stops where its tool is up next."""
    _told(_desk(None)[0].pause(job, who), as_json)


@jobs.command()
def resume(job: JobId, who: Who = "", as_json: AsJson = False) -> None:
    """Go on with a job that was paused."""
    _told(_desk(None)[0].resume(job, who), as_json)


@jobs.command()
def cancel(job: JobId, who: Who = "", as_json: AsJson = False) -> None:
    """End a job, at a machine at once; it is no emergency stop."""
    _told(_desk(None)[0].cancel(job, who), as_json)


@jobs.command()
def priority(
    job: JobId,
    value: Annotated[int, typer.Argument(help="Higher ones are made first.")],
    who: Who = "",
    as_json: AsJson = False,
) -> None:
    """Change a job's place among those that wait for the same plotter."""
    _told(_desk(None)[0].prioritise(job, value, who), as_json)


@jobs.command()
def remake(
    job: JobId,
    sheet: Annotated[str, typer.Option(help="Its id; default: the last of the job.")] = "",
    doubtful: Annotated[
        list[str] | None,
        typer.Option(
            help="Of strokes in doubt: cut, missing, or those that are missing, as 3,5-8; PROGRAM: "
            "before it where there are several; repeatable."
        ),
    ] = None,
    half: Annotated[
        list[str] | None, typer.Option(help="Strokes that are cut in part; repeatable.")
    ] = None,
    rank: Annotated[int, typer.Option("--priority", help="Higher ones are made first.")] = 0,
    who: Who = "",
    as_json: AsJson = False,
) -> None:
    """Submit what is missing on a sheet of a job that was cancelled, or on one given up."""
    from foldmill_fabricate.jobs import Rest

    given = {"doubtful": doubtful or (), "half": half or (), "priority": rank}
    said = _stated(Rest, sheet=sheet, **given)
    _told(_desk(None)[0].remake(job, said, who), as_json)


@jobs.command()
def work(
    plotter: More = None,
    host_name: Annotated[
        str, typer.Option(help="Of this computer, always the same; with a database of many.")
    ] = "",
) -> None:
    """Work on jobs in the foreground, until Ctrl-C: the machines are stopped then."""
    from foldmill_fabricate.cli.working import work_here

    work_here(plotter or [], host_name, typer.echo)


def _desk(more: list[str] | None) -> tuple[Jobs, bool]:
    """Return where jobs are spoken of, and whether anybody works on them now."""
    from foldmill_fabricate.cli.working import desk

    return desk(more or [])


def _submission(**given: Any) -> Submission:
    """Return what is submitted; raises InvalidInput with the sentence."""
    from foldmill_fabricate.jobs import Submission

    return _stated(Submission, **given)


def _stated(kind: type[V], **given: Any) -> V:
    """Return what was stated as a value; raises InvalidInput with the sentence."""
    from pydantic import ValidationError

    from foldmill.refusals import explain

    try:
        return kind.model_validate(given)
    except ValidationError as error:
        raise InvalidInput(explain(error, kind)) from None


def _happened(one: Happening) -> str:
    what = f"{one.sheet} {one.what}".strip()
    return hanging(f"      {moment(one.when)}  {one.who}: {what}", " " * 31)


def _told(job: JobRecord, as_json: bool) -> None:
    say(as_json, job.model_dump(mode="json"), told(job))
