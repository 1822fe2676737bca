"""Leading a machine about with its tool up: frame, jog, register."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from foldmill import FoldmillError
from foldmill_fabricate.cli.choices import Folder
from foldmill_fabricate.cli.marks import read_marks
from foldmill_fabricate.cli.output import AsJson, say
from foldmill_fabricate.cli.running import PassChoice, stopping_on_signals

if TYPE_CHECKING:
    from foldmill_fabricate.jogging import Jogger
    from foldmill_fabricate.machines import Machine
    from foldmill_fabricate.plotter.ledger import SheetRecord
    from foldmill_fabricate.sending import Job

Port = Annotated[
    str, typer.Option(help="/dev/ttyUSB0, COM3, socket://host:port, or sim://MACHINE.")
]
_KEYS = {"a": (-1.0, 0.0), "d": (1.0, 0.0), "w": (0.0, 1.0), "s": (0.0, -1.0)}


def add_to(app: typer.Typer) -> None:
    """Add these commands to the application."""
    app.command()(frame)
    app.command(context_settings={"ignore_unknown_options": True})(jog)
    app.command()(register)


def frame(
    path: Folder,
    port: Port,
    only: Annotated[PassChoice, typer.Option("--pass", help="Of which face.")] = PassChoice.FRONT,
    marks: Annotated[
        str, typer.Option(help="Where holes are seen after the flip: x1,y1;x2,y2;… in mm.")
    ] = "",
    as_json: AsJson = False,
) -> None:
    """Trace the box of all that a face gets, tool up, slowly, to see whether it is on the sheet."""
    from foldmill_fabricate import jogging
    from foldmill_fabricate.passes import Face
    from foldmill_fabricate.sending import open_job

    job = open_job(path, read_marks(marks))
    fit = job.fit.fit if job.fit else None
    corners = jogging.box(job.plan, fit, [Face(only.value)])
    with _led(port, job.plan.machine, "frame") as jogger:
        jogging.frame(jogger, corners)
    (x, y), (u, v) = corners[0], corners[2]
    text = f"Traced ({x:.2f}, {y:.2f}) to ({u:.2f}, {v:.2f}) mm on the mat, the tool up."
    say(as_json, {"box": [float(each) for each in (x, y, u, v)]}, text)


def jog(
    dx: Annotated[float, typer.Argument(help="mm to the right.")],
    dy: Annotated[float, typer.Argument(help="mm up.")],
    port: Port,
    machine: Annotated[str, typer.Option(help="A slug of `foldmill machines`.")],
    as_json: AsJson = False,
) -> None:
    """Move the tool by some mm, up, within the machine's limits."""
    from foldmill_fabricate import shelf

    with _led(port, shelf.machine(machine), "jog") as jogger:
        jogger.by(dx, dy)
        x, y = jogger.at or (0.0, 0.0)
    say(as_json, {"at": [x, y]}, f"The tool is at ({x:.2f}, {y:.2f}) mm on the mat, up.")


def register(
    path: Folder,
    port: Port,
    sheet: Annotated[str, typer.Option(help="The id of the sheet that lies there, if begun.")] = "",
    as_json: AsJson = False,
) -> None:
    """Measure registration marks after the flip: jog the tool above each, and store what is found.

    At each mark type steps as dx,dy in mm, or a, d, w, s with a number (d 0.5), and Enter once the
    tool stands over its middle; - leaves a mark out. `send` then fits the reverse to them.
    """
    from foldmill_fabricate import jogging
    from foldmill_fabricate.delivering import own_ledger
    from foldmill_fabricate.sending import open_job

    job = open_job(path)
    wanted = jogging.expected_marks(job.plan)
    ledger = own_ledger(port)
    found: list[tuple[float, float]] = []
    laid = _sheet(ledger.open_sheets(job.id), sheet, job)
    with _led(port, job.plan.machine, "register") as jogger:
        typer.echo(_HOW, err=True)
        for number, spot in enumerate(wanted, 1):
            jogger.go(spot)
            if _over(jogger, number, len(wanted)) and jogger.at:
                found.append(jogger.at)
    fit = job.fitted(found).fit
    if laid is not None:
        told = {"marks": [[round(x, 4), round(y, 4)] for x, y in found]}
        ledger.answer(laid.id, None, "marks", told)
    text = ";".join(f"{x:.3f},{y:.3f}" for x, y in found)
    kept = f"kept for sheet {laid.id}" if laid else "no sheet of this job is begun: give them"
    lines = f'{fit}\nThe marks are {kept}\nfoldmill send {path} --port {port} --marks "{text}"'
    say(as_json, {"marks": found, "sheet": laid.id if laid else None, "fit": str(fit)}, lines)


_HOW = (
    "Lead the tool over the middle of each mark: type dx,dy in mm, or a, d, w, s (left, right, up, "
    "down) with how far, as d 0.5.\nEnter takes the place, - leaves the mark out, Ctrl-C ends and "
    "keeps nothing."
)


def _sheet(begun: list[SheetRecord], name: str, job: Job) -> SheetRecord | None:
    """Return the sheet whose marks are measured; raises FoldmillError where that is not certain."""
    if name:
        for one in begun:
            if one.id == name.upper():
                return one
        raise FoldmillError(f"No open sheet of {job.path} has the id {name}.")
    if len(begun) > 1:
        ids = ", ".join(one.id for one in begun)
        raise FoldmillError(f"Several sheets of this job are begun, {ids}: say which by --sheet.")
    return begun[0] if begun else None


def _over(jogger: Jogger, number: int, count: int) -> bool:
    """Let the operator lead the tool above a mark; False where it is left out."""
    while True:
        x, y = jogger.at or (0.0, 0.0)
        where = f"Mark {number} of {count}, the tool at ({x:.2f}, {y:.2f}) mm"
        text = str(typer.prompt(where, default="", show_default=False, err=True)).strip()
        if text in {"", "-"}:
            return text == ""
        try:
            jogger.by(*read_step(text))
        except FoldmillError as refusal:
            typer.echo(str(refusal), err=True)


def read_step(text: str) -> tuple[float, float]:
    """Read how far to go, mm: dx,dy, or a key a, d, w, s with how much, by default 1."""
    key, much = text[:1].lower(), text[1:].strip() or "1"
    try:
        if key in _KEYS:
            return _KEYS[key][0] * float(much), _KEYS[key][1] * float(much)
        dx, dy = (float(each) for each in text.split(","))
    except ValueError:
        raise FoldmillError(
            f"Write dx,dy in mm, or d 0.5 for half a mm right, not {text!r}."
        ) from None
    return dx, dy


@contextmanager
def _led(port: str, machine: Machine, command: str) -> Iterator[Jogger]:
    """Hold a machine's lock, open its port and lead it about; a signal stops it.

    Where something was broken off on it and half an instruction may be left, a person says first
    that it is gone, once: the first hop would end it, with the tool down.
    """
    from foldmill_fabricate import recovery
    from foldmill_fabricate.delivering import own_ledger
    from foldmill_fabricate.jogging import Jogger
    from foldmill_fabricate.plotter import link
    from foldmill_fabricate.plotter.ledger.alone import alone, by_hand
    from foldmill_fabricate.plotter.ledger.devices import EMPTIED

    ledger = own_ledger(port)
    with stopping_on_signals(), alone(port, by_hand(command), ledger) as device:
        left = ledger.broken_off(device)
        if left and (warning := recovery.half(machine)):
            _require_done(warning)
            ledger.on_device(left.sheet, left.number, EMPTIED, device)
        with link.open_port(port, machine) as opened:
            yield Jogger(opened, machine)


def _require_done(warning: str) -> None:
    """Ask whether what a warning demands is done; raises FoldmillError where it is not."""
    try:
        is_done = typer.confirm(f"{warning}\nIs that done?", err=True)
    except typer.Abort:
        is_done = False
    if not is_done:
        raise FoldmillError("Nothing was sent. Do that first, then ask again at a terminal.")
