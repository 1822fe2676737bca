"""The operator at a terminal: told what to do, asked what only a person can say."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from foldmill import FoldmillError
from foldmill_fabricate.operators import SimulatedOperator, said
from foldmill_fabricate.passes import Face, Gate, Plan, SetUp
from foldmill_fabricate.plotter.ledger import Record, Said, Word, account

if TYPE_CHECKING:
    from foldmill_fabricate.operators import Operator
    from foldmill_fabricate.plotter.resume import Start


def operator(url: str, yes: bool, word: Said | None = None) -> Operator:
    """Return who answers the prompts; word : what was said beforehand of a program in doubt."""
    if not yes:
        return Person(word)
    if not url.startswith("sim://"):
        raise FoldmillError(
            "--yes answers prompts on sim:// only: on a machine somebody has to load, change the "
            "tool and turn the sheet."
        )
    return SimulatedOperator(url)


def read_word(go_on: str, finished: bool, overlap: float) -> Said | None:
    """Read what was said of a program in doubt: STROKE or STROKE.VERTEX, strokes from 1 on."""
    if go_on and finished:
        raise FoldmillError("--go-on and --finished exclude each other.")
    if finished:
        return Said(Word.FINISHED)
    if overlap and not go_on:
        raise FoldmillError("--overlap says how much is cut again with --go-on; say where, too.")
    return _place(go_on, overlap) if go_on else None


def _place(text: str, overlap: float = 0.0) -> Said:
    stroke, _, vertex = text.strip().partition(".")
    if not stroke.isdecimal() or int(stroke) < 1 or not (vertex or "0").isdecimal():
        raise FoldmillError(f"{text!r} is no stroke: write 12, or 12.3 for its vertex 3.")
    return Said(Word.GO_ON, int(stroke) - 1, int(vertex or 0), overlap)


class Person:
    """The operator at a terminal: told what to do, asked to press Enter."""

    def __init__(self, word: Said | None = None) -> None:
        self._word = word

    def ready(self, gate: Gate, face: Face, setup: SetUp, plan: Plan) -> bool:
        """Print what the gate asks for, and wait."""
        typer.echo(instruction(gate, face, setup, plan), err=True)
        return not _ask("Enter to go on, q to stop").lower().startswith("q")

    def decide(self, record: Record, found: Start | None) -> Said | None:
        """Tell what is certain and ask how it goes on; what was said beforehand is not asked."""
        if self._word is not None:
            word, self._word = self._word, None
            return word
        typer.echo(f"{record.program.name} of sheet {record.sheet} ended early.", err=True)
        typer.echo(f"{record.note} {account(record)}".strip(), err=True)
        proved = said(record, found) if found else None
        if proved is not None:
            typer.echo(f"The machine stands where it can {proved}.", err=True)
        typer.echo(
            "Look at the sheet. Type the number of the first stroke that is not cut, f if all is "
            "cut, s to give the sheet up, or q to leave it as it is"
            + (", or Enter to go on from where the machine stands." if proved else "."),
            err=True,
        )
        return self._answer(proved)

    def _answer(self, proved: Said | None) -> Said | None:
        answer = _ask("How does it go on").lower()
        if not answer:
            return proved
        if answer.startswith("q"):
            return None
        known = {"f": Said(Word.FINISHED), "s": Said(Word.SPOILED)}
        return known.get(answer[0]) or _place(answer)

    def has_finished(self, record: Record) -> bool:
        """Ask: the machine cannot say."""
        typer.echo(
            f"All of {record.program.name} is sent, and this machine cannot say when it is done. "
            "Wait until it stands still and look at the sheet.",
            err=True,
        )
        return _ask("y if it is done, Enter if not").lower().startswith("y")


def _ask(question: str) -> str:
    try:
        return str(typer.prompt(question, default="", show_default=False, err=True)).strip()
    except typer.Abort:
        return "q"


def instruction(gate: Gate, face: Face, setup: SetUp, plan: Plan) -> str:
    """Return in words what the operator has to do before a set-up on that face."""
    if gate is Gate.LOAD:
        side = "front (outside)" if face is Face.FRONT else "reverse (inside)"
        return (
            f"Load a {plan.sheet.width:g} × {plan.sheet.height:g} mm sheet of "
            f"{plan.material.title} on the mat, its lower left corner at "
            f"({plan.sheet.dx:g}, {plan.sheet.dy:g}) mm, the {side} up.{_against(face, plan)}"
        )
    if gate is Gate.FLIP:
        side = "bottom" if plan.flip.kind == "left-right" else "left"
        return (
            f"Turn the sheet over {plan.flip.kind}: the {side} edge stays where it is. The F in "
            f"the waste must now be on the underside.{_against(face, plan)}"
        )
    return (
        f"Set the tool for {setup.name}: exposure {setup.exposure:g} mm, force {setup.force:g} gf, "
        f"speed {setup.speed / 10:g} cm/s."
    )


def _against(face: Face, plan: Plan) -> str:
    """Return what to do about registration when the sheet is laid, after a blank; or nothing."""
    made = plan.registration
    if made.kind == "edge":
        spots = ", ".join(
            f"{stop.edge} ({stop.x:g}, {stop.y:g})" for stop in made.stops if stop.face is face
        )
        return f" Push its edges against the stops, mm on the mat: {spots}."
    if face is Face.FRONT:
        return ""
    if made.kind == "pins":
        spots = " and ".join(f"({x:g}, {y:g})" for x, y in made.pins)
        return f" Press it down over the pins at {spots} mm."
    if made.kind == "l-marks":
        return " Put dark tape under the cut marks first, and let the machine search them now."
    return ""
