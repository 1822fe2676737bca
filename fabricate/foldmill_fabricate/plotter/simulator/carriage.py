"""The mechanics: what each HP-GL unit does, how long it takes, and what it answers.

Instructions and replies: HP 7470A and 7475A manuals; FS as on cutters. Anything else is error 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator.drawing import DrawnSheet, Step
from foldmill_fabricate.plotter.simulator.parser import (
    MOVES,
    NO_ERROR,
    OUT_OF_RANGE,
    UNKNOWN,
    WRONG_COUNT,
    Unit,
)
from foldmill_fabricate.toolpath.motion import Pace, move_seconds

_P1_P2 = "250,279,10250,7479"
_MOST_TOOLS = 99
_FASTEST = 127.9999
"""cm/s: the largest VS of HP-GL."""


@dataclass(frozen=True)
class Outcome:
    """How long a unit keeps the machine busy, and what it answers."""

    seconds: float = 0.0
    reply: str | None = None


@dataclass
class Tally:
    """What the mechanics did, counted."""

    units: int = 0
    """coordinate pairs and other instructions executed"""
    errors: int = 0
    """HP-GL errors, whether asked for by OE or not"""
    second_in: int = 0
    """IN in the middle of a job: some machines cancel it"""
    without_tool: int = 0
    """moves with the pen down and no tool in the holder"""
    moving: float = 0.0
    """s"""


class Carriage:
    """Pen, tool, position and error state of a machine, drawing on a sheet."""

    def __init__(self, machine: Machine, sheet: DrawnSheet) -> None:
        self.machine, self.sheet, self.tally = machine, sheet, Tally()
        self.at: Step = (0, 0)
        self.tool = 0
        self.force: float | None = None
        self.down = False
        self._pace = Pace(machine.motion)
        self._initialised = 8  # in the status byte until OS has told it
        self._drawn_since_in = False
        self._defaults()
        self.error = NO_ERROR
        self._doings: dict[str, Callable[[tuple[float, ...]], Outcome]] = {
            "IN": self._initialise,
            "DF": self._default,
            "SP": self._select,
            "PG": self._page,
            "LB": lambda _: Outcome(),
        }
        if machine.dialect.speed:
            self._doings["VS"] = self._set_speed
        if machine.dialect.force:
            self._doings["FS"] = self._set_force
        self._answers: dict[str, Callable[[], str]] = {
            "OA": lambda: f"{self.at[0]},{self.at[1]},{int(self.down)}",
            "OC": lambda: f"{self.at[0]},{self.at[1]},{int(self.down)}",
            "OE": self._tell_error,
            "OF": lambda: "{0},{0}".format(round(machine.axes.units_per_mm)),
            "OH": self._limits,
            "OI": lambda: machine.slug,
            "OO": lambda: "0,1,0,0,1,0,0,0",
            "OP": lambda: _P1_P2,
            "OS": self._tell_status,
            "OW": self._limits,
        }

    def execute(self, unit: Unit) -> Outcome:
        """Do it; wrong units set the error and do nothing."""
        self.tally.units += 1
        if unit.error:
            return self._wrong(unit.error)
        if unit.name in MOVES:
            outcome = self._move(unit.name, unit.numbers)
        elif unit.name in self._answers:
            outcome = self._answer(unit)
        elif unit.name in self._doings:
            outcome = self._doings[unit.name](unit.numbers)
        else:
            return self._wrong(UNKNOWN)
        self.tally.moving += outcome.seconds
        return outcome

    def _wrong(self, error: int) -> Outcome:
        self.error = error
        self.tally.errors += 1
        return Outcome()

    def _defaults(self) -> None:
        self.relative = False
        self.speed = self.machine.motion.travel_speed

    def _initialise(self, numbers: tuple[float, ...]) -> Outcome:
        if numbers:
            return self._wrong(WRONG_COUNT)
        self.tally.second_in += self._drawn_since_in and self.tool != 0
        seconds = self._set_pen(False)
        self._defaults()
        self.force, self.error, self._initialised, self._drawn_since_in = None, NO_ERROR, 8, False
        return Outcome(seconds)

    def _default(self, numbers: tuple[float, ...]) -> Outcome:
        if numbers:
            return self._wrong(WRONG_COUNT)
        self._defaults()
        return Outcome()

    def _select(self, numbers: tuple[float, ...]) -> Outcome:
        if len(numbers) > 1:
            return self._wrong(WRONG_COUNT)
        tool = int(numbers[0]) if numbers else 0
        if not 0 <= tool <= _MOST_TOOLS:
            return self._wrong(OUT_OF_RANGE)
        if tool == self.tool:
            return Outcome()
        self.sheet.lift()
        self.tool = tool
        return Outcome(self.machine.motion.tool_time)

    def _page(self, numbers: tuple[float, ...]) -> Outcome:
        return self._wrong(WRONG_COUNT) if len(numbers) > 1 else Outcome(self._set_pen(False))

    def _set_speed(self, numbers: tuple[float, ...]) -> Outcome:
        if len(numbers) > 2:
            return self._wrong(WRONG_COUNT)
        if numbers and not 0 < numbers[0] <= _FASTEST:
            return self._wrong(OUT_OF_RANGE)
        self.speed = numbers[0] * 10 if numbers else self.machine.motion.travel_speed
        return Outcome()

    def _set_force(self, numbers: tuple[float, ...]) -> Outcome:
        if len(numbers) > 2:
            return self._wrong(WRONG_COUNT)
        if numbers and numbers[0] < 0:
            return self._wrong(OUT_OF_RANGE)
        self.force = numbers[0] if numbers else None
        return Outcome()

    def _move(self, name: str, numbers: tuple[float, ...]) -> Outcome:
        seconds = 0.0
        if name in ("PA", "PR"):
            self.relative = name == "PR"
        else:
            seconds = self._set_pen(name == "PD")
        return Outcome(seconds + self._go(numbers)) if numbers else Outcome(seconds)

    def _go(self, numbers: tuple[float, ...]) -> float:
        x, y = (int(each) for each in numbers)
        to = (self.at[0] + x, self.at[1] + y) if self.relative else (x, y)
        axes, motion = self.machine.axes, self.machine.motion
        if not all(axes.lowest <= each <= axes.highest for each in to):
            self._wrong(OUT_OF_RANGE)
            return 0.0
        dx, dy = ((new - old) / axes.units_per_mm for new, old in zip(to, self.at, strict=True))
        self.at, before = to, self.at
        if not self.down:
            length = hypot(dx, dy)
            return float(move_seconds(length, motion.travel_speed, motion.acceleration))
        self._mark(before)
        self.sheet.move(to)
        return self._pace.go_on(dx, dy, self.speed)

    def _set_pen(self, down: bool) -> float:
        if down == self.down:
            return 0.0
        self.down = down
        self._pace.stop()
        if down:
            self._mark(self.at)
        else:
            self.sheet.lift()
        return self.machine.motion.lift_time

    def _mark(self, at: Step) -> None:
        """The tool is in the sheet there, if there is a tool."""
        self._drawn_since_in = True
        if self.tool or self.machine.tools.change == "operator":
            self.sheet.lower(at, self.tool, self.speed, self.force)
        else:
            self.tally.without_tool += 1

    def _answer(self, unit: Unit) -> Outcome:
        if unit.numbers:
            return self._wrong(WRONG_COUNT)
        return Outcome(reply=self._answers[unit.name]())

    def _tell_error(self) -> str:
        error, self.error = self.error, NO_ERROR
        return str(error)

    def _tell_status(self) -> str:
        status = int(self.down) + self._initialised + 16 + 32 * bool(self.error)
        self._initialised = 0
        return str(status)

    def _limits(self) -> str:
        bed, axes = self.machine.bed, self.machine.axes
        sides = (bed.length, bed.width) if axes.swap else (bed.width, bed.length)
        low = max(axes.lowest, 0)
        x, y = (min(axes.highest, round(side * axes.units_per_mm)) for side in sides)
        return f"{low},{low},{x},{y}"
