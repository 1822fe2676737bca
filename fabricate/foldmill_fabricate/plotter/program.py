"""A program as the sender sees it: whole instructions, how long each takes, where the tool ends.

It reads HP-GL on its own account, like neither the writer nor the simulator: what one of them gets
wrong the other two do not repeat.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import hypot

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.toolpath.motion import Pace, hop_seconds

XY = tuple[float, float]

_INSTRUCTION = re.compile(rb"\s*[Ll][Bb][^\x03]*\x03;?\s*|[^;]*;\s*|[^;]+\Z", re.DOTALL)
_FOREIGN = re.compile(rb"[^\x20-\x7e\r\n\t\x03]")
_OUTPUT = re.compile(rb"\s*O[A-Z]", re.IGNORECASE)
PART = re.compile(rb"([A-Za-z])\s*([A-Za-z])([^A-Za-z;]*)")
"""One instruction inside a piece: its two letters and its parameters."""
_COORDINATES = re.compile(rb"(\s*)(P[UDAR])([\d,+\-.\s]*);(\s*)\Z", re.IGNORECASE)
_MOVES = (b"PU", b"PD", b"PA", b"PR")


def instructions(program: bytes) -> list[bytes]:
    r"""Cut a program into whole instructions, each with the line end behind it.

    A label stays whole up to its ETX; nothing is lost: joined again they are the program.

    >>> instructions(b"IN;DF;\nPD1,2,3,4;\n")
    [b'IN;', b'DF;\n', b'PD1,2,3,4;\n']
    """
    return _INSTRUCTION.findall(program)


def rechunk(program: bytes, limit: int) -> bytes:
    r"""Divide coordinate lists so that no instruction is longer than ``limit`` bytes.

    They are divided at whole pairs and the path stays the same; a line end stays behind each part.
    Raises ProgramRefused for an instruction that is longer and cannot be divided.

    >>> rechunk(b"PD10,20,30,40,50,60;\n", 14)
    b'PD10,20;\nPD30,40;\nPD50,60;\n'
    """
    pieces = []
    for number, piece in enumerate(instructions(program), 1):
        pieces += [piece] if len(piece) <= limit else list(_divided(piece, limit, number))
    return b"".join(pieces)


def checked(program: bytes, machine: Machine) -> bytes:
    """Return the program, or raise ProgramRefused where it holds what must not reach a machine.

    That is: nothing at all, control characters, questions to the machine (their answers would be
    taken for the sender's own), and an IN more than the machine's profile wants (on some machines
    it cancels the job).
    """
    if not program.strip():
        raise ProgramRefused("The program is empty; write it again.")
    foreign = _FOREIGN.search(program)
    if foreign:
        at, byte = foreign.start(), foreign.group()[0]
        raise ProgramRefused(
            f"Byte {at} of the program is 0x{byte:02X}, a control character; HP-GL from a file "
            "must be plain text. Write the program again."
        )
    for number, piece in enumerate(instructions(program), 1):
        if _OUTPUT.match(piece):
            raise ProgramRefused(
                f"Instruction {number} ({_shown(piece)}) asks the machine something; a program may "
                "only move and set. Take it out."
            )
    wanted = max(
        1, _initialisations(f"{machine.dialect.preamble};{machine.dialect.trailer}".encode())
    )
    found = _initialisations(program)
    if found > wanted:
        raise ProgramRefused(
            f"The program holds IN {found} times; {machine.slug} takes {wanted}, because a second "
            "one can cancel the job. Send the parts one by one."
        )
    return program


@dataclass(frozen=True)
class Instruction:
    """One whole instruction and what it asks of the machine."""

    data: bytes
    seconds: float
    """of motion, by the machine's own figures"""
    stroke: int
    """0, 1, 2 …; a stroke begins where the tool is lifted or moved up"""
    at: XY | None
    """Where it leaves the tool, steps; None before the first motion."""
    asks: bool = False
    """Whether it is a question of the sender's own, answered when all before it is executed."""
    down: bool = False
    """Whether the tool is in the sheet after it."""


@dataclass(frozen=True)
class Job:
    """A program made ready to be sent."""

    parts: tuple[Instruction, ...]
    end: XY | None
    """Where the tool stands at the end, steps; None where it never moves."""
    strokes: int
    """How many there are, up to the last that draws."""
    lift: bytes = b"PU;"
    """What lifts the tool and does nothing else."""

    @property
    def data(self) -> bytes:
        """All bytes of the program, in order."""
        return b"".join(part.data for part in self.parts if not part.asks)

    @property
    def seconds(self) -> float:
        """Motion of the whole program, s."""
        return sum(part.seconds for part in self.parts)


def ready(program: bytes, machine: Machine) -> Job:
    """Find how long each instruction takes; raises ProgramRefused for what is no number."""
    timer = _Timer(machine)
    parts = [timer.timed(piece, number) for number, piece in enumerate(instructions(program), 1)]
    return Job(tuple(parts), timer.at if timer.moved else None, timer.strokes)


class _Timer:
    """Follows a program to learn its times. Unit: steps; a tool starts at the origin."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.at: XY = (0.0, 0.0)
        self.moved = self.down = self.relative = False
        self.stroke = self.strokes = 0
        self.speed = machine.motion.travel_speed
        self.pace = Pace(machine.motion)

    def timed(self, piece: bytes, number: int) -> Instruction:
        seconds = 0.0
        if piece.lstrip()[:2].upper() != b"LB":
            try:
                for first, second, rest in PART.findall(piece):
                    seconds += self._follow((first + second).upper(), numbers(rest))
            except ValueError:
                raise ProgramRefused(
                    f"Instruction {number} ({_shown(piece)}) holds something that is no number, or "
                    "half a pair of coordinates. Write the program again."
                ) from None
        at = self.at if self.moved else None
        return Instruction(piece, seconds, self.stroke, at, down=self.down)

    def _follow(self, name: bytes, given: list[float]) -> float:
        if name in _MOVES:
            return self._move(name, given)
        if name == b"VS" and given:
            self.speed = max(given[0] * 10, 1e-3)
        if name == b"IN":
            self.relative, self.speed = False, self.machine.motion.travel_speed
        return self.machine.motion.tool_time if name == b"SP" else 0.0

    def _move(self, name: bytes, given: list[float]) -> float:
        seconds = 0.0
        if name in (b"PA", b"PR"):
            self.relative = name == b"PR"
        elif self.down != (name == b"PD"):
            self.down = not self.down
            self.pace.stop()
            self.stroke += not self.down
            self.strokes = self.stroke + self.down
            seconds = self.machine.motion.lift_time
        if not given:
            return seconds
        for x, y in zip(given[::2], given[1::2], strict=True):  # ValueError for half a pair
            seconds += self._go((self.at[0] + x, self.at[1] + y) if self.relative else (x, y))
        return seconds

    def _go(self, to: XY) -> float:
        units, motion = self.machine.axes.units_per_mm, self.machine.motion
        dx, dy = (to[0] - self.at[0]) / units, (to[1] - self.at[1]) / units
        self.at, self.moved = to, True
        if self.down:
            return self.pace.go_on(dx, dy, self.speed)
        return hop_seconds(hypot(dx, dy), motion.travel_speed, motion.acceleration)


def _divided(piece: bytes, limit: int, number: int) -> Iterator[bytes]:
    found = _COORDINATES.fullmatch(piece)
    if not found:
        raise ProgramRefused(_too_long(piece, limit, number))
    lead, name, rest, tail = found.groups()
    flat = rest.replace(b" ", b"").split(b",")
    if len(flat) % 2:
        raise ProgramRefused(
            f"Instruction {number} ({_shown(piece)}) holds half a pair of coordinates. "
            "Write the program again."
        )
    yield from _packed(zip(flat[::2], flat[1::2], strict=True), lead, name, tail, limit, number)


def _packed(
    pairs: Iterable[tuple[bytes, bytes]],
    lead: bytes,
    name: bytes,
    tail: bytes,
    limit: int,
    number: int,
) -> Iterator[bytes]:
    line = b""
    for pair in map(b",".join, pairs):
        longer = line + b"," + pair if line else lead + name + pair
        if len(longer) + 1 + len(tail) > limit and line:
            yield line + b";" + tail
            longer, lead = name + pair, b""
        if len(longer) + 1 + len(tail) > limit:
            raise ProgramRefused(_too_long(longer, limit, number))
        line = longer
    yield line + b";" + tail


def numbers(text: bytes) -> list[float]:
    """Return the parameters of an instruction; raises ValueError for what is no number."""
    stripped = text.strip()
    return [float(each) for each in stripped.split(b",")] if stripped else []


def _initialisations(program: bytes) -> int:
    return sum(bool(re.match(rb"\s*IN", piece, re.IGNORECASE)) for piece in instructions(program))


def _shown(piece: bytes) -> str:
    text = piece.decode("ascii", "replace").strip()
    return text if len(text) <= 24 else text[:24] + "…"


def _too_long(piece: bytes, limit: int, number: int) -> str:
    return (
        f"Instruction {number} ({_shown(piece)}) has {len(piece)} bytes and cannot be divided; "
        f"this machine's buffer takes {limit} at once. Write the program with shorter instructions."
    )
