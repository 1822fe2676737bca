"""The mechanics: position, tool and pen of a machine, what they leave on a sheet, and when.

Languages differ in how they say a motion; what happens then is the same, and stands here.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator.drawing import DrawnSheet, Step
from foldmill_fabricate.toolpath.motion import Pace, hop_seconds


@dataclass
class Tally:
    """What the mechanics did, counted."""

    units: int = 0
    """coordinate pairs and other instructions executed"""
    strokes: int = 0
    """strokes ended: the tool was lifted, or another took its place"""
    errors: int = 0
    """errors in the program, whether asked for or not"""
    second_in: int = 0
    """IN in the middle of a job: some machines cancel it"""
    without_tool: int = 0
    """moves with the pen down and no tool in the holder"""
    moving: float = 0.0
    """s"""


@dataclass(frozen=True)
class Line:
    """The straight line that was begun last."""

    start: Step
    end: Step
    lead: float
    """s of lowering or lifting before it"""
    seconds: float
    """s without that"""


class Carriage:
    """Pen, tool, position and error register of a machine, drawing on a sheet."""

    def __init__(self, machine: Machine, sheet: DrawnSheet) -> None:
        self.machine, self.sheet, self.tally = machine, sheet, Tally()
        self.at: Step = (0, 0)
        self.tool = 0
        self.force: float | None = None
        """gf; None where the program sets none"""
        self.setting = ""
        """What else a stroke is made with, in words."""
        self.speed = machine.motion.travel_speed
        """mm/s with the tool down"""
        self.down = False
        self.drawn_since_in = False
        self.error = 0
        """Error register."""
        self.line: Line | None = None
        self._pace = Pace(machine.motion)
        self._needs_tool = machine.tools.change == "select" and machine.language == "hpgl"

    def wrong(self, error: int) -> None:
        """Note an error in the program."""
        self.error = error
        self.tally.errors += 1

    def begin(self) -> None:
        """Forget the line before: something else is done now."""
        self.line = None

    def select(self, tool: int) -> float:
        """Take another tool, or 0 for none; return the time, s."""
        if tool == self.tool:
            return 0.0
        self._end_stroke()
        self.tool = tool
        return self.machine.motion.tool_time

    def set_pen(self, down: bool) -> float:
        """Lower or lift the tool; return the time, s."""
        if down == self.down:
            return 0.0
        self.down = down
        self._pace.stop()
        if down:
            self.mark(self.at)
        else:
            self._end_stroke()
        return self.machine.motion.lift_time

    def move(self, to: Step, lead: float = 0.0, travel: float | None = None) -> float:
        """Go there; return the time, s, without ``lead``, which was spent on the tool before.

        travel : mm/s with the tool up, where it is not the machine's fastest.
        """
        units, motion = self.machine.axes.units_per_mm, self.machine.motion
        dx, dy = (to[0] - self.at[0]) / units, (to[1] - self.at[1]) / units
        before, self.at = self.at, to
        if self.down:
            self.mark(before)
            self.sheet.move(to)
            seconds = self._pace.go_on(dx, dy, self.speed)
        else:
            speed = travel or motion.travel_speed
            seconds = hop_seconds(hypot(dx, dy), speed, motion.acceleration)
        self.line = Line(before, to, lead, seconds)
        return seconds

    def mark(self, at: Step) -> None:
        """The tool is in the sheet there, if there is a tool."""
        self.drawn_since_in = True
        if self.tool or not self._needs_tool:
            self.sheet.lower(at, self.tool, self.speed, self.force, self.setting)
        else:
            self.tally.without_tool += 1

    def halt(self, spent: float) -> None:
        """Stand where the line is after ``spent`` seconds of what was begun last."""
        if self.line:
            part = (spent - self.line.lead) / self.line.seconds if self.line.seconds else 1.0
            self._stand(self._between(min(1.0, max(0.0, part))))

    def go_on(self) -> None:
        """Draw the rest of a line that was halted."""
        if self.line:
            self._stand(self.line.end)

    def fail(self) -> None:
        """Lose the mains: the spring lifts the tool, and nobody knows any more where it is."""
        self._end_stroke()
        self.down = False
        self._pace.stop()

    def home(self) -> None:
        """Begin anew at the origin with nothing set, as after switching on."""
        self.at, self.tool, self.force, self.setting, self.error = (0, 0), 0, None, "", 0
        self.speed, self.drawn_since_in, self.line = self.machine.motion.travel_speed, False, None

    def place(self, spent: float) -> tuple[float, float]:
        """Return where it is after ``spent`` seconds of what was begun last, steps."""
        if not self.line or not self.line.seconds:
            return self.at
        part = min(1.0, max(0.0, (spent - self.line.lead) / self.line.seconds))
        (x, y), (u, v) = self.line.start, self.line.end
        return x + part * (u - x), y + part * (v - y)

    def _between(self, part: float) -> Step:
        assert self.line is not None
        (x, y), (u, v) = self.line.start, self.line.end
        return round(x + part * (u - x)), round(y + part * (v - y))

    def _stand(self, at: Step) -> None:
        self.at = at
        if self.down:
            self.sheet.shift(at)

    def _end_stroke(self) -> None:
        self.tally.strokes += self.sheet.under_way
        self.sheet.lift()
