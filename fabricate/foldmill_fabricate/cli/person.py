"""The operator at a terminal: told what to do, asked what only a person can say."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from math import isnan
from typing import TYPE_CHECKING, TypeVar

import typer

from foldmill import FoldmillError
from foldmill_fabricate import gates, instructions
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.gates import Answer, Request
from foldmill_fabricate.operators import SimulatedOperator, Verdict, said
from foldmill_fabricate.passes import Gate
from foldmill_fabricate.plotter.ledger import Record, Said, Word, account
from foldmill_fabricate.plotter.ledger.words import refuse

if TYPE_CHECKING:
    from foldmill_fabricate.operators import Operator
    from foldmill_fabricate.plotter.resume import Start

T = TypeVar("T")
_STOP = "q"


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
    if isnan(overlap):
        raise FoldmillError("--overlap says how many mm are cut again, from 0 to 20.")
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
    """The operator at a terminal; every prompt takes q to stop."""

    who = ""

    def __init__(self, word: Said | None = None) -> None:
        self._word = word

    def ready(self, request: Request) -> Answer | None:
        """Print what the gate asks for, and ask until the answer can be.

        Raises CannotSend where a word was given for a program in doubt, and work begins with none.
        """
        if self._word is not None:
            raise CannotSend(
                f"Nothing was sent. Of sheet {request.sheet} nothing is in doubt before "
                f"{request.setup.name}, so that {self._word} cannot be taken for it: all of that "
                "would be cut from its beginning. Name the sheet that lies on the machine by "
                "--sheet, and its face by --pass; or leave the word out."
            )
        _tell("\n" + instructions.instruction(request))
        question, read = _QUESTIONS[request.gate]

        def judged(text: str) -> Answer:
            answer = read(text, request)
            gates.check(request, answer)
            return answer

        return _asked(question, judged)

    def wants_test_cut(self, request: Request) -> bool:
        """Offer one; raises CannotSend where the person stops: without it the part comes next."""
        _tell(f"\nThe preset {request.plan.material.title} is untested.")
        wanted = _asked(
            f"y for a test cut of 20 mm in the waste for {request.setup.name} (Enter: none; "
            "q: stop)",
            partial(_one_of, {"": False, "n": False, "no": False, "y": True, "yes": True}),
        )
        if wanted is None:
            raise CannotSend(
                f"Stopped before {request.setup.name}, as the operator said. Send again to go on."
            )
        return wanted

    def judge(self, request: Request) -> Verdict:
        """Ask what it looks like."""
        what = "bends without tearing" if request.setup.process == "score" else "is cut through"
        _tell(f"Wait until the machine stands still, and look whether the sheet {what} there.")
        answer = _ask(
            "Enter if it is good, a once the tool is set anew, to cut another (q: stop)"
        ).lower()
        return {"": Verdict.GOOD, "a": Verdict.AGAIN}.get(answer, Verdict.STOP)

    def decide(self, record: Record, found: Start | None, told: str) -> Said | None:
        """Tell what is certain and ask how it goes on; what was said beforehand is not asked."""
        _tell(f"{record.program.name} of sheet {record.sheet} ended early.")
        for sentence in (record.note, account(record), told):
            _tell(sentence) if sentence else None
        if self._word is not None:
            word, self._word = self._word, None
            return word
        proved = said(record, found) if found else None
        if proved is not None:
            _tell(f"The machine stands where it can {proved}.")
        _tell(
            "Look at the sheet. Type the number of the first stroke that is not cut, f if all is "
            "cut, s to give the sheet up, or q to leave it as it is"
            + (", or Enter to go on from where the machine stands." if proved else ".")
        )
        return _asked("How does it go on", lambda text: _word(text, proved, record))

    def has_finished(self, record: Record) -> bool:
        """Ask: the machine cannot say."""
        _tell(
            f"All of {record.program.name} is sent, and this machine cannot say when it is done. "
            "Wait until it stands still and look at the sheet."
        )
        return _ask("y if it is done, Enter if not").lower().startswith("y")


def _word(text: str, proved: Said | None, record: Record) -> Said | None:
    if not text and proved is None:
        raise FoldmillError("Nothing proves where the machine stands; a person must say it.")
    known = {"": proved, "f": Said(Word.FINISHED), "s": Said(Word.SPOILED)}
    key = text.lower()  # no more than the letter: an id, or "stop", must not give a sheet up
    word = known[key] if key in known else _place(text)
    if word is not None:
        refuse(record, word)
    return word


def _one_of(words: Mapping[str, T], text: str) -> T:
    if text.lower() not in words:
        raise FoldmillError("Type one of the letters that are named, or Enter.")
    return words[text.lower()]


def _pressed(text: str, request: Request) -> Answer:
    if text:
        raise FoldmillError("Press Enter, or q.")
    return Answer(sheet=request.sheet)


def _loaded(text: str, request: Request) -> Answer:
    thickness, temperature = _numbers(text, "thickness and temperature, such as 0.76 22", 2)
    return Answer(sheet=request.sheet, thickness=thickness, temperature=temperature)


def _tooled(text: str, request: Request) -> Answer:
    (exposure,) = _numbers(text, "another exposure in mm, such as 0.45", 1)
    return Answer(sheet=request.sheet, exposure=exposure)


def _turned(text: str, request: Request) -> Answer:  # noqa: ARG001
    name, _, rest = text.partition(" ")
    (temperature,) = _numbers(rest, "the id and the temperature, such as K7QF 22", 1)
    return Answer(sheet=name, temperature=temperature)


def _back(text: str, request: Request) -> Answer:
    name, _, rest = text.partition(" ")
    touched = rest.strip().lower()
    if touched not in {"", "touched"}:
        raise FoldmillError("Write the id, and touched after it if the sheet was moved.")
    answer = Answer(sheet=name, touched=bool(touched))
    at_marks = request.plan.registration.kind in {"holes", "pins"}
    if not touched or request.fitted or request.face == "front" or not at_marks:
        return answer
    from foldmill_fabricate.cli.marks import read_marks

    _tell("Measure where its registration marks are seen now, mm on the mat, at least two.")
    marks = tuple(read_marks(_ask("x1,y1;x2,y2;…")))
    return Answer(sheet=name, touched=True, marks=marks)


_QUESTIONS: dict[Gate, tuple[str, Callable[[str, Request], Answer]]] = {
    Gate.LOAD: (
        "Measured thickness in mm and temperature in °C, such as 0.76 22 (Enter: none; q: stop)",
        _loaded,
    ),
    Gate.TOOL: ("Enter when it is set so, or the exposure in mm that is set (q: stop)", _tooled),
    Gate.FLIP: (
        "The id that is written on the sheet, and its temperature in °C if measured (q: stop)",
        _turned,
    ),
    Gate.RE_REGISTER: (
        "The id that is written on it, and the word touched if it was moved (q: stop)",
        _back,
    ),
    Gate.REMOVE: ("Enter when it is off", _pressed),
}


def _numbers(text: str, what: str, most: int) -> list[float | None]:
    """Read up to so many numbers; None for each that is not given."""
    words = text.replace(",", " ").split()
    try:
        found: list[float | None] = [float(word) for word in words]
    except ValueError:
        found = [None] * (most + 1)
    if len(found) > most:
        raise FoldmillError(f"Write {what}, not {text!r}.")
    return found + [None] * (most - len(found))


def _asked(question: str, read: Callable[[str], T]) -> T | None:
    """Ask until the answer can be read and is allowed; None where the person stops."""
    while True:
        text = _ask(question)
        if text.lower() == _STOP:
            return None
        try:
            return read(text)
        except (FoldmillError, CannotSend) as refusal:
            _tell(str(refusal))


def _tell(words: str) -> None:
    typer.echo(words, err=True)


def _ask(question: str) -> str:
    try:
        return str(typer.prompt(question, default="", show_default=False, err=True)).strip()
    except typer.Abort:
        _tell("")  # what comes next stands on a line of its own
        return _STOP
