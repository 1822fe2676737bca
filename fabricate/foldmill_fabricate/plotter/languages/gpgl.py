"""GP-GL, whose units are commands that end with ETX.

Let through: M and D (absolute), O and E (by differences), H, J, !, FX, FC and FE … FF, which set.
Questions and ESC are refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import dist

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.plotter.languages import strokes
from foldmill_fabricate.plotter.program import XY, Instruction, Job
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.toolpath.motion import Pace, move_seconds

ETX = b"\x03"
_COMMAND = re.compile(rb"(M|D|O|E|H|J|!|FX|FC|FE|FF|TT|L)([\d,.+\- ]*)")
_PLACES = (b"M", b"D", b"O", b"E")


class GpGl:
    """Commands; a stroke is what D and E draw without a move between."""

    def as_sent(self, program: bytes, machine: Machine, limit: int) -> bytes:  # noqa: ARG002
        """Return the commands, long ones divided at whole pairs; raises ProgramRefused."""
        if program.strip() and not program.rstrip(b"\r\n ").endswith(ETX):
            raise ProgramRefused("The last GP-GL command lacks its ETX. Write the program again.")
        pieces = [
            each
            for number, text in enumerate(program.split(ETX)[:-1], 1)
            if text.strip()
            for each in _divided(text.strip(), limit, number)
        ]
        if not pieces:
            raise ProgramRefused("The program is empty; write it again.")
        return b"".join(piece + ETX for piece in pieces)

    def ready(self, program: bytes, machine: Machine) -> Job:
        """Follow the commands to learn their times and strokes."""
        reader = _Reader(machine)
        parts = [reader.read(text) for text in program.split(ETX)[:-1]]
        return Job(tuple(parts), reader.at if reader.moved else None, reader.strokes, b"")

    def rest(self, job: Job, machine: Machine, limit: int, start: Start) -> Job:  # noqa: ARG002
        """Return what is left from a stroke on."""
        settings: dict[bytes, bytes] = {}
        for part in job.parts:
            name = _parsed(part.data)[0]
            if name in (b"O", b"E"):
                raise ProgramRefused("A program of relative moves cannot be taken up again.")
            if part.stroke < start.stroke and name not in (b"M", b"D", b"H"):
                settings[name] = part.data
        return strokes.rest(job, start, settings.values())

    def lead_in(self, job: Job, stroke: int) -> tuple[int, ...]:  # noqa: ARG002
        """Return the first stroke."""
        return strokes.lead_in(stroke)


def _parsed(command: bytes) -> tuple[bytes, list[float]]:
    found = _COMMAND.fullmatch(command.strip(b"\r\n \x03"))
    if not found:
        raise ValueError(command)
    text = found[2].replace(b" ", b"")
    return found[1], [float(each) for each in text.split(b",")] if text else []


def _divided(text: bytes, limit: int, number: int) -> Iterator[bytes]:
    try:
        name, values = _parsed(text)
    except ValueError:
        shown = text[:24].decode("ascii", "replace")
        raise ProgramRefused(
            f"Command {number} ({shown}) is no GP-GL that moves or sets. Take it out."
        ) from None
    if name in _PLACES and (not values or len(values) % 2):
        raise ProgramRefused(f"Command {number} holds half a pair. Write the program again.")
    if len(text) < limit or name not in _PLACES:
        yield text
        return
    line = b""
    for x, y in zip(values[::2], values[1::2], strict=True):
        pair = f"{x:g},{y:g}".encode()
        longer = line + b"," + pair if line else name + pair
        if line and len(longer) >= limit:
            yield line
            longer = name + pair
        line = longer
    yield line


@dataclass
class _Reader:
    """Follows a program. Unit: steps; a tool starts at the origin."""

    machine: Machine
    at: XY = (0.0, 0.0)
    moved: bool = False
    down: bool = False
    stroke: int = 0
    strokes: int = 0
    speed: float = field(init=False)
    pace: Pace = field(init=False)

    def __post_init__(self) -> None:
        self.speed, self.pace = self.machine.motion.travel_speed, Pace(self.machine.motion)

    def read(self, text: bytes) -> Instruction:
        name, values = _parsed(text)
        seconds = 0.0
        if name == b"!" and values:
            self.speed = max(1.0, values[0]) * self.machine.tools.speed_unit
        elif name == b"J":
            seconds = self.machine.motion.tool_time
        elif name in (b"H", b"TT"):
            seconds = self._go((0.0, 0.0), False)
        elif name in _PLACES:
            for pair in zip(values[::2], values[1::2], strict=True):
                base = self.at if name in (b"O", b"E") else (0.0, 0.0)
                to = (base[0] + pair[0], base[1] + pair[1])
                seconds += self._go(to, name in (b"D", b"E"))
        return Instruction(text + ETX, seconds, self.stroke, self.at, down=self.down)

    def _go(self, to: XY, draws: bool) -> float:
        motion, scale = self.machine.motion, self.machine.axes.units_per_mm
        seconds = 0.0
        if draws != self.down:
            self.down, seconds = draws, motion.lift_time
            self.pace.stop()
            self.stroke += not draws
            self.strokes = self.stroke + draws
        way = ((to[0] - self.at[0]) / scale, (to[1] - self.at[1]) / scale)
        self.at, self.moved = to, True
        if draws:
            return seconds + float(self.pace.go_on(*way, self.speed))
        return seconds + float(
            move_seconds(dist((0, 0), way), motion.travel_speed, motion.acceleration)
        )
