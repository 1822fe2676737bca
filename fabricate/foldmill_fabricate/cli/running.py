"""Driving a plotter, real or simulated: send, plotters, demo."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from foldmill import FoldmillError
from foldmill_fabricate.cli.choices import Folder, temperatures
from foldmill_fabricate.cli.marks import read_marks
from foldmill_fabricate.cli.output import AsJson, say
from foldmill_fabricate.cli.progress import ProgressLine

if TYPE_CHECKING:
    from foldmill_fabricate.delivering import Sent
    from foldmill_fabricate.passes import Plan
    from foldmill_fabricate.plotter.sender import Delivery
    from foldmill_fabricate.sending import Job


class PassChoice(StrEnum):
    """Which face is worked on."""

    FRONT = "front"
    REVERSE = "reverse"


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    app.command()(send)
    app.command()(plotters)
    app.command()(demo)


def send(
    path: Folder,
    port: Annotated[
        str, typer.Option(help="/dev/ttyUSB0, COM3, socket://host:port, or sim://MACHINE.")
    ],
    only: Annotated[PassChoice | None, typer.Option("--pass", help="One face only.")] = None,
    marks: Annotated[
        str,
        typer.Option(help="Where holes are seen after the flip: x1,y1;x2,y2;… in mm on the mat."),
    ] = "",
    sheet: Annotated[
        str, typer.Option(help="The id of the sheet to go on with; new for another one.")
    ] = "",
    go_on: Annotated[
        str, typer.Option(help="Where a program in doubt goes on: STROKE, or STROKE.VERTEX.")
    ] = "",
    finished: Annotated[
        bool, typer.Option("--finished", help="The program in doubt is cut whole.")
    ] = False,
    overlap: Annotated[
        float, typer.Option(min=0, max=20, help="mm of a through-cut that are cut again.")
    ] = 0.0,
    witness: Annotated[
        str,
        typer.Option(help="Where the F is seen after the flip, on top or through: x,y in mm."),
    ] = "",
    temperature: Annotated[
        str | None, typer.Option(help="FRONT,REVERSE: °C of the sheet at both passes, as 21,24.")
    ] = None,
    test_cut: Annotated[
        bool,
        typer.Option("--test-cut", help="Try each process first: 20 mm in the waste."),
    ] = False,
    yes: Annotated[
        bool, typer.Option("--yes", help="Answer every prompt; on simulators only.")
    ] = False,
    draw: Annotated[
        Path | None, typer.Option(help="With sim://: a folder for pictures of what was cut.")
    ] = None,
    transcript: Annotated[
        Path | None, typer.Option(help="A file for what goes over the wire, one JSON line each.")
    ] = None,
    who: Annotated[
        str, typer.Option(help="Who stands at the machine; default: whoever is at the computer.")
    ] = "",
    as_json: AsJson = False,
) -> None:
    """Verify a job folder again and send it, prompting before each set-up.

    A software stop (Ctrl-C) is no emergency stop: keep a hand near the machine's own.
    """
    from foldmill_fabricate.cli.person import operator, read_word
    from foldmill_fabricate.delivering import own_ledger, send_job
    from foldmill_fabricate.passes import Face
    from foldmill_fabricate.plotter.ledger import State
    from foldmill_fabricate.sending import open_job

    if draw is not None and not port.startswith("sim://"):
        raise FoldmillError("--draw shows what a sim:// plotter cut; a real one shows it itself.")
    if draw is not None and draw.exists() and not draw.is_dir():
        raise FoldmillError(f"--draw: {draw} is a file; name a folder for the pictures.")
    word = read_word(go_on, finished, overlap)
    job = open_job(path, read_marks(marks), _one(read_marks(witness)))
    _refuse_another_machine(port, job)
    faces = [Face(only.value)] if only else list(Face)
    if job.fit:
        typer.echo(f"The reverse is fitted to the marks: {job.fit}", err=as_json)
    _tell_budget(job.plan, temperature, as_json)
    done: list[Sent] = []
    bar = ProgressLine(as_json)
    with stopping_on_signals():
        hands = operator(port, yes, word)
        parts = send_job(
            job,
            port,
            hands,
            faces,
            bar.tell,
            own_ledger(port, who),
            sheet=sheet,
            test_cut=test_cut,
            transcript=transcript,
        )
        for sent in parts:
            if not done:
                bar.end(f"Sheet {sent.sheet}")
            done.append(sent)
            bar.end(f"{sent.program.name}: {_ended(sent.delivery)}")
    if draw is not None:
        _draw(port, draw, as_json, job.plan)
    if as_json:
        rows = [
            {
                "sheet": sent.sheet,
                "program": sent.program.name,
                "state": sent.state.value,
                "delivery": vars(sent.delivery),
            }
            for sent in done
        ]
        say(True, rows, "")
    if not all(sent.state is State.DONE for sent in done):
        typer.echo(
            "The job is not finished; look at the sheet before anything is cut again.", err=True
        )
        raise typer.Exit(1)


def plotters(
    ask: Annotated[
        list[str] | None,
        typer.Option(help="A port to open and ask who is there; repeatable. Never one at work."),
    ] = None,
    machine: Annotated[
        str, typer.Option(help="The profile by which it is opened: baud rate and language.")
    ] = "generic-hpgl-600",
    as_json: AsJson = False,
) -> None:
    """List the serial ports; open and ask only those named by --ask.

    A question that meets a machine at work becomes a part of its program, so none is asked unless
    you say at which port.
    """
    from foldmill_fabricate import shelf
    from foldmill_fabricate.plotter import ports

    profile = shelf.machine(machine)
    named = ask or []
    rows = [row for row in ports.listed() if row.address not in named]
    rows += [ports.asked(address, profile) for address in named]
    lines = [
        f"{row.address}  {row.title}  {row.state}{': ' + row.answer if row.answer else ''}"
        for row in rows
    ]
    say(as_json, [vars(row) for row in rows], "\n".join(lines) or "There are no serial ports.")


def _one(read: list[tuple[float, float]]) -> tuple[float, float] | None:
    if len(read) > 1:
        raise FoldmillError("--witness takes one place: the middle of the F.")
    return read[0] if read else None


def _tell_budget(plan: Plan, temperature: str | None, as_json: bool) -> None:
    """Say how far the faces may be apart where the sheet's temperatures were given."""
    from foldmill_fabricate.plan import budget

    if temperature is None:
        return
    warm = plan.model_copy(update={"temperatures": temperatures(temperature)})
    found = budget.reckon(warm)
    if found is not None:
        typer.echo(budget.sentence(found), err=as_json)


@contextmanager
def stopping_on_signals() -> Iterator[None]:
    """Treat SIGTERM and SIGHUP as Ctrl-C: the sender stops the machine before it leaves."""

    def interrupt(number: int, _frame: object) -> None:
        raise KeyboardInterrupt(signal.Signals(number).name)

    names = [getattr(signal, name, None) for name in ("SIGTERM", "SIGHUP")]
    before = {number: signal.signal(number, interrupt) for number in names if number}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def demo(
    output: Annotated[
        Path, typer.Option("-o", "--output", help="The folder to make it in.")
    ] = Path("out/stool"),
) -> None:
    """Make the stool end to end: design, check, plan, verify, send to the simulated plotter."""
    from foldmill_fabricate.cli.demo import make_stool

    make_stool(output, typer.echo)


def _refuse_another_machine(url: str, job: Job) -> None:
    from foldmill_fabricate.plotter.simulator import devices

    if not url.startswith("sim://"):
        return
    there, wanted = devices.behind(url).machine.slug, job.plan.machine.slug
    if there != wanted:
        raise FoldmillError(
            f"This job is made for {wanted}, and {url} is {there}: plan it for that machine, or "
            f"send it to sim://{wanted}."
        )


def _draw(url: str, folder: Path, aside: bool, plan: Plan) -> None:
    from foldmill_fabricate.plotter.simulator import devices
    from foldmill_fabricate.plotter.simulator.draw import draw

    simulator = devices.behind(url)
    for path in draw(simulator.sheet, simulator.machine, folder, plan):
        typer.echo(f"drawn: {path}", err=aside)


def _ended(delivery: Delivery) -> str:
    """Say how a delivery ended, and what is wrong with that or not known."""
    from foldmill_fabricate.plotter.endings import Status

    known = delivery.status is Status.EXECUTED
    words = delivery.fault or ("" if known else delivery.proved)
    return f"{delivery.status}. {words}" if words else str(delivery.status)
