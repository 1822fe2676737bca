"""What the tip draws where a program steers the holder of a drag knife.

At the start of each set-up nobody knows how the blade points, so blades that point twelve ways are
dragged along: after the lead-in they must all go the same way, and that is what is compared with
the plan. Where the plan says that the blade is turned with a light force, those motions draw
nothing, and the blade is not turned otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Fit, Plan, ProgramFile, SetUp
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.blade import STARTS, dragged
from foldmill_fabricate.verify.interpreter import Run, Trace
from foldmill_fabricate.verify.settings import as_near, force_unit
from foldmill_fabricate.verify.virtual_sheet import (
    Line,
    modelled_offset,
    on_carrier,
    on_sheet,
    to_carrier,
)

Floats = NDArray[np.float64]

_RESTS = 0.5
"""Offsets. A tip that has gone on by more has turned along a way, not at a corner."""


@dataclass(frozen=True, eq=False)
class Steered:
    """What a program draws, lead-ins and light swivels left out, and what is wrong with those."""

    lines: tuple[Line, ...]
    findings: tuple[Finding, ...]


def steered(trace: Trace, plan: Plan, file: ProgramFile, fit: Fit | None) -> Steered:
    """Return what a program draws on the sheet, in order of work."""
    offset = modelled_offset(plan.machine)
    drag = _Drag(plan, file, fit, offset)
    if not offset:
        drag.draw_all(trace.runs)
        return Steered(tuple(drag.lines), ())
    setups = [s for side in plan.passes for s in side.setups if s.number in file.setups]
    groups = [list(runs) for _, runs in groupby(trace.runs, key=lambda run: run.choice)]
    for k, runs in enumerate(groups):
        drag.follow(runs, setups[min(k, len(setups) - 1)] if setups else None)
    return Steered(tuple(drag.lines), tuple(drag.findings))


@dataclass
class _Drag:
    """Blades that are dragged through one program."""

    plan: Plan
    file: ProgramFile
    fit: Fit | None
    offset: float
    lines: list[Line] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def follow(self, runs: Sequence[Run], setup: SetUp | None) -> None:
        """Drag blades through the runs of one set-up."""
        holders = [on_carrier(run.points, self.plan.machine.axes) for run in runs]
        led = setup is not None and self._leads_in(holders[0], setup)
        if not led and setup is not None and setup.lead_in:
            text = f"Set-up {setup.number} does not begin with its lead-in: "
            text += "nobody knows how the blade points."
            self._complain("lead-in-missing", runs[0], text)
        apart, farthest = 0.0, runs[0]
        ways = dragged(holders, self.offset, STARTS)
        for k, (run, (tips, headings)) in enumerate(zip(runs, ways, strict=True)):
            if led and k == 0:
                continue
            spread = float(np.hypot(*(tips - tips[:1]).transpose(2, 0, 1)).max())
            apart, farthest = max((apart, farthest), (spread, run), key=lambda pair: pair[0])
            self._judge(run, tips[0], headings[0], setup)
        if led and apart > tolerances.SETTLED_MM:
            text = f"The tip's way still depends on how it pointed at first, by {apart:.3f} mm."
            self._complain("blade-unsettled", farthest, text)

    def draw_all(self, runs: Sequence[Run]) -> None:
        """Take the ways of a tip without offset as drawn: all at once, for there are many."""
        told = np.concatenate([np.zeros((0, 2)), *(run.points for run in runs)])
        tips = on_carrier(told, self.plan.machine.axes)
        points = on_sheet(tips, self.plan, self.file.face, self.fit)
        first = 0
        for run in runs:
            last = first + len(run.points)
            self.lines.append(Line(points[first:last], self.file.face, self.file.name, run))
            first = last

    def draw(self, tip: Floats, run: Run) -> None:
        """Take a tip's way (n, 2) on the carrier as drawn."""
        points = on_sheet(tip, self.plan, self.file.face, self.fit)
        self.lines.append(Line(points, self.file.face, self.file.name, run))

    def _judge(self, run: Run, tip: Floats, headings: Floats, setup: SetUp | None) -> None:
        force = setup.swivel_force if setup is not None else 0.0
        if not force:
            self.draw(tip, run)
        elif as_near(run.force, force, force_unit(self.plan.machine)):
            self._light(run, tip)
        else:
            self.draw(tip, run)
            self._turned(run, tip, headings)

    def _light(self, run: Run, tip: Floats) -> None:
        """Check that a tip that rests on the sheet stays where it is."""
        strays = float(np.hypot(*(tip - tip[0]).T).max())
        if strays > tolerances.BLADE_MM + 1 / self.plan.machine.axes.units_per_mm:
            text = f"The blade is set down lightly to be turned, and strays by {strays:.2f} mm."
            self._complain("swivel-astray", run, text)

    def _turned(self, run: Run, tip: Floats, headings: Floats) -> None:
        """Check that the blade is not turned sharply in the material."""
        gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(tip, axis=0).T))])
        before = np.searchsorted(gone, gone - _RESTS * self.offset, "left")
        headings = np.unwrap(headings)
        turn = np.degrees(np.abs(headings - headings[before]))
        k = int(np.argmax(turn))
        if turn[k] > tolerances.SHARP_DEG + 5:
            x, y = on_sheet(tip[k : k + 1], self.plan, self.file.face, self.fit)[0]
            text = f"The blade is turned by {turn[k]:.0f}° in the material at ({x:.2f}, {y:.2f}) mm"
            self._complain("swivel-missing", run, f"{text}; it is to be lifted out for that.")

    def _leads_in(self, holder: Floats, setup: SetUp) -> bool:
        planned = np.asarray(setup.lead_in, float).reshape(-1, 2)
        wanted = to_carrier(planned, self.plan, self.file.face, self.fit)
        step = 1 / self.plan.machine.axes.units_per_mm
        return holder.shape == wanted.shape and float(np.abs(holder - wanted).max()) <= step

    def _complain(self, code: str, run: Run, text: str) -> None:
        where = f"{self.file.name}, byte {run.byte}"
        self.findings.append(Finding(code, Severity.ERROR, where, text))
