"""What each HP-GL unit does, how long it takes, and what it answers.

Instructions and replies: HP 7470A and 7475A manuals; FS as on cutters. Anything else is error 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator.carriage import Carriage
from foldmill_fabricate.plotter.simulator.parser import (
    MOVES,
    NO_ERROR,
    OUT_OF_RANGE,
    UNKNOWN,
    WRONG_COUNT,
    Unit,
)
from foldmill_fabricate.plotter.simulator.quirks import Quirk, wrapped

_P1_P2 = "250,279,10250,7479"
_MOST_TOOLS = 99
_FASTEST = 127.9999
"""cm/s: the largest VS of HP-GL."""

LEVER_UP = 8
"""Error of OE: pinch wheels up."""


@dataclass(frozen=True)
class Outcome:
    """How long a unit keeps the machine busy, and what it answers."""

    seconds: float = 0.0
    reply: str | None = None


class Hpgl:
    """Executes units on a carriage."""

    def __init__(self, machine: Machine, carriage: Carriage, quirks: frozenset[Quirk]) -> None:
        self.machine, self.carriage, self.quirks = machine, carriage, quirks
        self._initialised = 8  # in the status byte until OS has told it
        self._deaf = Quirk.NEEDS_IN in quirks
        self._defaults()
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
            "OA": self._place,
            "OC": self._place,
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
        carriage = self.carriage
        carriage.tally.units += 1
        carriage.begin()
        if unit.error:
            return self._misread(unit.error)
        if unit.name in self._answers:
            outcome = self._answer(unit)
        elif self._deaf and unit.name != "IN":
            return Outcome()
        elif unit.name in MOVES:
            outcome = self._move(unit.name, unit.numbers)
        elif unit.name in self._doings:
            outcome = self._doings[unit.name](unit.numbers)
        else:
            return self._wrong(UNKNOWN)
        carriage.tally.moving += outcome.seconds
        return outcome

    def _misread(self, error: int) -> Outcome:
        if error == WRONG_COUNT and Quirk.ODD_DROPPED in self.quirks:
            return Outcome()
        return self._wrong(error)

    def _wrong(self, error: int) -> Outcome:
        self.carriage.wrong(error)
        return Outcome()

    def _defaults(self) -> None:
        self.relative = False
        self.carriage.speed = self.machine.motion.travel_speed

    def _initialise(self, numbers: tuple[float, ...]) -> Outcome:
        if numbers:
            return self._wrong(WRONG_COUNT)
        carriage = self.carriage
        carriage.tally.second_in += carriage.drawn_since_in and carriage.tool != 0
        seconds = carriage.set_pen(False)
        self._defaults()
        carriage.force, carriage.error, carriage.drawn_since_in = None, NO_ERROR, False
        self._initialised, self._deaf = 8, False
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
        return Outcome(self.carriage.select(tool))

    def _page(self, numbers: tuple[float, ...]) -> Outcome:
        if len(numbers) > 1:
            return self._wrong(WRONG_COUNT)
        return Outcome(self.carriage.set_pen(False))

    def _set_speed(self, numbers: tuple[float, ...]) -> Outcome:
        if len(numbers) > 2:
            return self._wrong(WRONG_COUNT)
        if numbers and not 0 < numbers[0] <= _FASTEST:
            return self._wrong(OUT_OF_RANGE)
        fastest = self.machine.motion.travel_speed
        self.carriage.speed = numbers[0] * 10 if numbers else fastest
        return Outcome()

    def _set_force(self, numbers: tuple[float, ...]) -> Outcome:
        if len(numbers) > 2:
            return self._wrong(WRONG_COUNT)
        if numbers and numbers[0] < 0:
            return self._wrong(OUT_OF_RANGE)
        self.carriage.force = numbers[0] if numbers else None
        return Outcome()

    def _move(self, name: str, numbers: tuple[float, ...]) -> Outcome:
        seconds = 0.0
        if name in ("PA", "PR"):
            self.relative = name == "PR"
        else:
            seconds = self.carriage.set_pen(name == "PD")
        return Outcome(seconds + self._go(numbers, seconds)) if numbers else Outcome(seconds)

    def _go(self, numbers: tuple[float, ...], lead: float) -> float:
        x, y = (self._number(each) for each in numbers)
        at, axes = self.carriage.at, self.machine.axes
        to = (at[0] + x, at[1] + y) if self.relative else (x, y)
        if Quirk.NEGATIVES_CLAMPED in self.quirks:
            to = (max(axes.lowest, to[0]), max(axes.lowest, to[1]))
        if not all(axes.lowest <= each <= axes.highest for each in to):
            self._wrong(OUT_OF_RANGE)
            return 0.0
        return self.carriage.move(to, lead)

    def _number(self, value: float) -> int:
        return wrapped(int(value)) if Quirk.WRAPS in self.quirks else int(value)

    def _answer(self, unit: Unit) -> Outcome:
        if unit.numbers:
            return self._wrong(WRONG_COUNT)
        return Outcome(reply=self._answers[unit.name]())

    def _place(self) -> str:
        x, y = self.carriage.at
        return f"{x},{y},{int(self.carriage.down)}"

    def _tell_error(self) -> str:
        error, self.carriage.error = self.carriage.error, NO_ERROR
        return str(error)

    def _tell_status(self) -> str:
        carriage = self.carriage
        status = int(carriage.down) + self._initialised + 16 + 32 * bool(carriage.error)
        self._initialised = 0
        return str(status)

    def _limits(self) -> str:
        bed, axes = self.machine.bed, self.machine.axes
        sides = (bed.length, bed.width) if axes.swap else (bed.width, bed.length)
        low = max(axes.lowest, 0)
        x, y = (min(axes.highest, round(side * axes.units_per_mm)) for side in sides)
        return f"{low},{low},{x},{y}"
