"""G-code for GRBL, whose units are lines.

Only what a plotter needs is let through: G0 G1 G4 G17 G20 G21 G90 G91 G94, M2 M3 M4 M5 M30, and
F N P S X Y Z. Characters that GRBL obeys at once (``? ! ~``) and its ``$`` settings are refused.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from math import dist

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.plotter.languages import strokes
from foldmill_fabricate.plotter.program import Instruction, Job
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.toolpath.motion import Pace, move_seconds

_PLAIN = re.compile(rb"[\x20-\x7e\r\n\t]*")
_COMMENT = re.compile(rb"\([^)\n]*\)|;[^\n]*|\s+")
_WORD = re.compile(rb"([A-Z])([+-]?(?:\d+\.?\d*|\.\d+))")
_CODES = frozenset(b"G0 G1 G4 G17 G20 G21 G90 G91 G94 M2 M3 M4 M5 M30".decode().split())
_VALUES = frozenset("FNPSXYZ")
_LONGEST = 80
"""Characters that GRBL takes in one line."""
_INCH = 25.4


class Gcode:
    """Lines, strokes by Z and by the spindle."""

    def as_sent(self, program: bytes, machine: Machine, limit: int) -> bytes:  # noqa: ARG002
        """Return the lines without comments and spaces; raises ProgramRefused."""
        if not _PLAIN.fullmatch(program):
            raise ProgramRefused("G-code from a file must be plain text. Write the program again.")
        lines = []
        for number, line in enumerate(program.upper().splitlines(), 1):
            bare = _COMMENT.sub(b"", line)
            if bare:
                _check(bare, number, min(limit, _LONGEST))
                lines.append(bare + b"\n")
        if not lines:
            raise ProgramRefused("The program is empty; write it again.")
        return b"".join(lines)

    def ready(self, program: bytes, machine: Machine) -> Job:
        """Follow the lines to learn their times and strokes."""
        reader = _Reader(machine)
        parts = [reader.read(line) for line in program.splitlines(keepends=True)]
        end = reader.at[:2] if reader.moved else None
        return Job(tuple(parts), end, reader.strokes, reader.lift)

    def rest(self, job: Job, machine: Machine, limit: int, start: Start) -> Job:  # noqa: ARG002
        """Return what is left from a stroke on."""
        before = [_words(part.data) for part in job.parts if part.stroke < start.stroke]
        codes = [each for words in before for each in words]
        if ("G", 91.0) in codes:
            raise ProgramRefused("A program of relative moves cannot be taken up again.")
        return strokes.rest(job, start, _settings(codes))

    def lead_in(self, job: Job, stroke: int) -> tuple[int, ...]:  # noqa: ARG002
        """Return the first stroke."""
        return strokes.lead_in(stroke)


def _words(line: bytes) -> list[tuple[str, float]]:
    return [(letter.decode(), float(value)) for letter, value in _WORD.findall(line)]


def _check(line: bytes, number: int, limit: int) -> None:
    shown = line.decode()[:24]
    if len(line) >= limit:
        raise ProgramRefused(
            f"Line {number} ({shown}…) has {len(line)} bytes; this machine takes {limit - 1}. "
            "Write the program with shorter lines."
        )
    if _WORD.sub(b"", line):
        raise ProgramRefused(f"Line {number} ({shown}) is no G-code. Write the program again.")
    for letter, value in _words(line):
        if letter not in _VALUES and f"{letter}{value:g}" not in _CODES:
            raise ProgramRefused(
                f"Line {number} ({shown}) holds {letter}{value:g}, which no plotter needs. Take it "
                "out."
            )


def _settings(codes: list[tuple[str, float]]) -> list[bytes]:
    """Return what holds after these words: units, absolute places, feed and spindle."""
    inch = next((v for letter, v in reversed(codes) if letter == "G" and v in (20, 21)), 21)
    said = [b"G%dG90\n" % inch]
    for letter in "FS":
        value = next((v for each, v in reversed(codes) if each == letter), None)
        if value is not None:
            said.append(f"{letter}{value:g}\n".encode())
    spindle = next((v for letter, v in reversed(codes) if letter == "M" and v in (3, 4, 5)), None)
    return [*said, *([b"M%d\n" % spindle] if spindle else [])]


@dataclass
class _Reader:
    """Follows a program. Unit: mm; a tool starts at the origin, Z at 0."""

    machine: Machine
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    moved: bool = False
    down: bool = False
    stroke: int = 0
    strokes: int = 0
    highest: float = 0.0
    scale: float = 1.0
    relative: bool = False
    motion: float = 0
    spindle: float = 5
    feed: float = 0.0
    power: float = 0.0
    pace: Pace = field(init=False)

    def __post_init__(self) -> None:
        self.pace = Pace(self.machine.motion)

    @property
    def lift(self) -> bytes:
        """What takes the tool out of the sheet: Z at its highest, or the spindle off."""
        return f"G21G90G0Z{self.highest:g}\n".encode() if self.highest > 0 else b"M5\n"

    def read(self, line: bytes) -> Instruction:
        seconds, values = 0.0, dict[str, float]()
        for letter, value in _words(line):
            if letter not in "GM":
                values[letter] = value
            elif letter == "M" and value in (3, 4, 5):
                self.spindle = value
            elif letter == "G":
                self._set(value)
        self.feed = values.get("F", self.feed / self.scale) * self.scale
        self.power = values.get("S", self.power)
        if "P" in values:
            seconds = values["P"]
        elif values.keys() & {"X", "Y", "Z"}:
            seconds = self._move(values)
        self._lower(self.at[2])
        return Instruction(line, seconds, self.stroke, self.at[:2], down=self.down)

    def _set(self, code: float) -> None:
        if code in (0, 1):
            self.motion = code
        elif code in (20, 21):
            self.scale = _INCH if code == 20 else 1.0
        elif code in (90, 91):
            self.relative = code == 91

    def _move(self, values: dict[str, float]) -> float:
        origin = self.at if self.relative else (0.0, 0.0, 0.0)
        x, y, z = (
            base + values[axis] * self.scale if axis in values else here
            for axis, here, base in zip("XYZ", self.at, origin, strict=True)
        )
        limits = self.machine.motion
        fast = self.motion == 0
        speed = limits.travel_speed if fast else min(self.feed / 60, limits.travel_speed)
        self._lower(min(self.at[2], z))
        length, way = dist(self.at, (x, y, z)), (x - self.at[0], y - self.at[1])
        self.at, self.moved = (x, y, z), True
        self.highest = max(self.highest, z)
        if self.down and any(way):
            return float(self.pace.go_on(*way, max(speed, 1 / 60)))
        self.pace.stop()
        return float(move_seconds(length, max(speed, 1 / 60), limits.acceleration))

    def _lower(self, depth: float) -> None:
        """Note where the tool enters the sheet, and where it leaves it."""
        on, beam = self.spindle != 5, self.machine.tools.max_force is None
        cuts = on and self.power > 0 and self.motion == 1 if beam else on or depth < 0
        if cuts != self.down:
            self.down = cuts
            self.pace.stop()
            self.stroke += not cuts
            self.strokes = self.stroke + cuts
