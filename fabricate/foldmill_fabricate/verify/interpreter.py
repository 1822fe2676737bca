"""An HP-GL interpreter of our own, strict where a machine would guess.

It knows IN DF PA PR PU PD SP VS FS. Whatever else stands in a program is a finding, not skipped.
Grammar (HP 7475A manual, chapter 2): two letters of either case, numbers between commas or blanks,
ended by a semicolon or by the next letters; line ends mean nothing.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity

Floats = NDArray[np.float64]

_INSTRUCTION = re.compile(r"\s*([A-Za-z]{2})([^A-Za-z;]*)(;?)|\s*;")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)")
_PLAIN = re.compile(r"-?\d+(?:,-?\d+)*")
"""What nearly every instruction has; read at once."""
_SIGN = re.compile(r"(?<=[\d.])(?=[+-])")


@dataclass(frozen=True, eq=False)
class Run:
    """One motion with the pen down, from where it went down to where it was lifted."""

    points: Floats
    """(n, 2) steps, as commanded; n may be 1 where it went down and up without a motion."""
    tool: int | None
    """Number of the last SP; None before any."""
    speed: float | None
    """mm/s; None where no VS was given."""
    force: float | None
    """gf; None where no FS was given."""
    byte: int
    """Where in the program it begins."""
    choice: int = 0
    """How often SP had chosen a tool before it."""
    settings: tuple[tuple[str, float], ...] = ()
    """What else the program had set, by name, such as a depth; in the order of their names."""


@dataclass(frozen=True, eq=False)
class Trace:
    """What a program makes a plotter do."""

    runs: tuple[Run, ...]
    visited: Floats
    """(m, 2) steps: every point it was sent to, pen up or down."""
    bytes: tuple[int, ...]
    """(m,) where in the program each of them stands."""
    findings: tuple[Finding, ...]


def interpret(program: bytes, name: str = "program", selects: bool = True) -> Trace:
    """Run a program on paper; what is wrong in it becomes findings with the byte it stands at.

    selects : whether this machine must be told a tool with SP before the pen moves.
    """
    pen = _Pen(name, selects)
    text = program.decode("latin-1").rstrip()
    place = 0
    while place < len(text):
        match = _INSTRUCTION.match(text, place)
        if match is None:
            word = text[place : place + 12].split()
            pen.complain("syntax", place, f"{''.join(word[:1])!r} is no instruction.")
            place = _next_instruction(text, place)
            continue
        if match[1]:
            pen.execute(match[1].upper(), match[2], match.start(1))
        place = match.end()
    pen.finish(len(text))
    return Trace(tuple(pen.runs), _array(pen.visited), tuple(pen.bytes), tuple(pen.findings))


def _next_instruction(text: str, place: int) -> int:
    semicolon = text.find(";", place)
    return len(text) if semicolon < 0 else semicolon + 1


def _array(points: list[tuple[float, float]]) -> Floats:
    return np.array(points, float) if points else np.zeros((0, 2))


@dataclass
class _Pen:
    """The state of a plotter that reads a program."""

    name: str
    selects: bool
    runs: list[Run] = field(default_factory=list)
    visited: list[tuple[float, float]] = field(default_factory=list)
    bytes: list[int] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    at: tuple[float, float] | None = None
    """None until the program has said where to go: nobody knows where the pen stands then."""
    begun: bool = False
    relative: bool = False
    tool: int | None = None
    choices: int = 0
    speed: float | None = None
    force: float | None = None
    drawing: list[tuple[float, float]] | None = None
    """Points of the run under way; None with the pen up."""
    down_at: int = 0

    def complain(self, code: str, byte: int, message: str, remedy: str = "") -> None:
        where = f"{self.name}, byte {byte}"
        self.findings.append(Finding(code, Severity.ERROR, where, message, remedy))

    def execute(self, mnemonic: str, parameters: str, byte: int) -> None:
        action = _ACTIONS.get(mnemonic)
        if action is None:
            self.complain("unknown-instruction", byte, f"{mnemonic} is an unknown instruction.")
            return
        if not self.begun and mnemonic != "IN":
            self.complain("no-initialise", byte, f"{mnemonic} comes before IN.")
        action(self, mnemonic, self.numbers(mnemonic, parameters, byte), byte)
        self.begun = True

    def numbers(self, mnemonic: str, parameters: str, byte: int) -> list[float]:
        if _PLAIN.fullmatch(parameters):
            return [float(word) for word in parameters.split(",")]
        text = _SIGN.sub(",", parameters.strip())
        words = re.split(r"\s*,\s*|\s+", text) if text else []
        wrong = [word for word in words if not _NUMBER.fullmatch(word)]
        if wrong:
            self.complain("syntax", byte, f"{mnemonic} has {wrong[0]!r} where a number belongs.")
        return [float(word) for word in words if _NUMBER.fullmatch(word)]

    def initialise(self, mnemonic: str, values: list[float], byte: int) -> None:
        if self.begun:
            self.complain(
                "second-initialise", byte, "A second IN: on some machines it cancels the job."
            )
        self.lift()
        self.defaults(mnemonic, values, byte)
        self.tool = self.speed = self.force = None

    def defaults(self, mnemonic: str, values: list[float], byte: int) -> None:
        if values:
            self.complain("syntax", byte, f"{mnemonic} takes no numbers.")
        self.relative = False

    def select(self, _: str, values: list[float], byte: int) -> None:
        if self.drawing is not None:
            self.complain("tool-change-down", byte, "The tool is changed with the pen down.")
            self.lift()
        tool = self.one("SP", values or [0.0], byte)
        if not tool.is_integer() or tool < 0:
            self.complain("syntax", byte, f"There is no tool {tool:g}.")
        self.tool = int(tool)
        self.choices += 1

    def set_speed(self, _: str, values: list[float], byte: int) -> None:
        self.interrupt(byte)
        self.speed = 10 * self.one("VS", values, byte) if values else None

    def set_force(self, _: str, values: list[float], byte: int) -> None:
        self.interrupt(byte)
        self.force = self.one("FS", values, byte) if values else None

    def one(self, mnemonic: str, values: list[float], byte: int) -> float:
        if len(values) != 1:
            self.complain("syntax", byte, f"{mnemonic} takes one number, not {len(values)}.")
        return values[0] if values else 0.0

    def absolute_or_relative(self, mnemonic: str, values: list[float], byte: int) -> None:
        self.relative = mnemonic == "PR"
        self.move(mnemonic, values, byte)

    def up(self, mnemonic: str, values: list[float], byte: int) -> None:
        self.lift()
        self.move(mnemonic, values, byte)

    def down(self, mnemonic: str, values: list[float], byte: int) -> None:
        if self.selects and self.tool is None:
            self.complain("no-tool", byte, "The pen goes down before SP has chosen a tool.")
        if self.at is None:
            self.complain("no-position", byte, "The pen goes down before it was sent anywhere.")
        self.plunge(byte)
        self.move(mnemonic, values, byte)

    def plunge(self, byte: int) -> None:
        if self.drawing is None:
            self.drawing = [] if self.at is None else [self.at]
            self.down_at = byte

    def interrupt(self, byte: int) -> None:
        """Begin a new run where the pen is, so that every run has one speed and one force."""
        if self.drawing is not None:
            self.lift()
            self.plunge(byte)

    def lift(self) -> None:
        if self.drawing:
            points = _array(self.drawing)
            state = self.tool, self.speed, self.force, self.down_at, self.choices
            self.runs.append(Run(points, *state))
        self.drawing = None

    def move(self, mnemonic: str, values: list[float], byte: int) -> None:
        if len(values) % 2:
            message = f"{mnemonic} has {len(values)} coordinates; they come in pairs."
            self.complain("odd-coordinates", byte, message)
        if self.selects and values and self.tool is None and mnemonic != "PD":
            self.complain("no-tool", byte, "The pen is moved before SP has chosen a tool.")
        if any(not value.is_integer() for value in values):
            self.complain("not-whole", byte, f"{mnemonic} has coordinates that are no whole steps.")
        for x, y in zip(values[::2], values[1::2], strict=False):
            self.go_to(x, y, byte)

    def go_to(self, x: float, y: float, byte: int) -> None:
        if self.relative and self.at is None:
            self.complain("no-position", byte, "A relative motion from nobody knows where.")
        start = self.at if self.relative and self.at is not None else (0.0, 0.0)
        self.at = (start[0] + x, start[1] + y)
        self.visited.append(self.at)
        self.bytes.append(byte)
        if self.drawing is not None:
            self.drawing.append(self.at)

    def finish(self, byte: int) -> None:
        if self.drawing is not None:
            self.complain("pen-left-down", byte, "The program ends with the pen down.")
            self.lift()


_ACTIONS: dict[str, Callable[[_Pen, str, list[float], int], None]] = {
    "IN": _Pen.initialise,
    "DF": _Pen.defaults,
    "PA": _Pen.absolute_or_relative,
    "PR": _Pen.absolute_or_relative,
    "PU": _Pen.up,
    "PD": _Pen.down,
    "SP": _Pen.select,
    "VS": _Pen.set_speed,
    "FS": _Pen.set_force,
}
"""What each instruction does to the pen."""
