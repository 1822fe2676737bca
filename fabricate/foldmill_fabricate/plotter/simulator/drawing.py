"""What the simulated tool leaves on a sheet, in machine steps, per face."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Axes
from foldmill_fabricate.passes import Face

Step = tuple[int, int]


@dataclass(frozen=True)
class Drawn:
    """One stroke as the machine made it."""

    tool: int
    """Number after SP."""
    speed: float
    """mm/s"""
    force: float | None
    """gf; None where the program sets none"""
    points: tuple[Step, ...]
    """Steps, machine axes; a single point where the tool went down and up in one place."""

    def millimetres(self, axes: Axes) -> NDArray[np.float64]:
        """Return carrier coordinates (n, 2), mm, as the machine sees the face: reverse mirrored."""
        xy = np.array(self.points, float) / axes.units_per_mm
        return xy[:, ::-1] if axes.swap else xy


@dataclass
class DrawnSheet:
    """A sheet on the machine: the face that is up, and the strokes on both."""

    up: Face = Face.FRONT
    strokes: dict[Face, list[Drawn]] = field(default_factory=lambda: {face: [] for face in Face})
    _begun: tuple[int, float, float | None] | None = None
    _points: list[Step] = field(default_factory=list)

    def lower(self, at: Step, tool: int, speed: float, force: float | None) -> None:
        """Begin a stroke; one that is under way with other settings ends first."""
        if self._begun == (tool, speed, force):
            return
        self.lift()
        self._begun, self._points = (tool, speed, force), [at]

    def move(self, to: Step) -> None:
        """Go on with the stroke that is under way, if any."""
        if self._begun:
            self._points.append(to)

    def lift(self) -> None:
        """End the stroke that is under way, if any."""
        if self._begun:
            self.strokes[self.up].append(Drawn(*self._begun, tuple(self._points)))
        self._begun, self._points = None, []

    def flip(self) -> None:
        """Turn the sheet over."""
        self.lift()
        self.up = Face.REVERSE if self.up is Face.FRONT else Face.FRONT
