"""A motion: how a form moves, every crease a hinge, over one and the same pattern."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidParameters

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Measure:
    """What people read the progress of a motion by, where that is not t: it grows evenly with t."""

    name: str
    """For people: "folding rate"."""
    unit: str
    """Such as "%" or "°"."""
    start: float
    """Its value at t = 0."""
    end: float
    """Its value at t = 1."""

    def at(self, t: float) -> float:
        """Return its value at t."""
        return self.start + (self.end - self.start) * t


PLAIN = Measure("t", "", 0.0, 1.0)
"""t itself."""


@dataclass(frozen=True, eq=False)
class Motion:
    """A named path of the vertices in space; t = 0 is the fold as it is.

    Mountains and valleys are those of t = 0; fold angles change on the way.
    """

    name: str
    title: str
    path: Callable[[float], Floats]
    """t in [0, reach] → (V, 3) mm, over the fold's own vertices."""
    reach: float = 1.0
    """How far it goes: 1 where nothing stops it."""
    reason: str = ""
    """Why it stops early, a sentence; empty where it does not."""
    measure: Measure = PLAIN
    """What its progress is read by."""

    def at(self, t: float) -> Floats:
        """Return the vertices (V, 3) mm at t; raises InvalidParameters beyond its reach."""
        is_number = isinstance(t, int | float | np.number)
        if not is_number or not 0 <= t <= self.reach:
            why = f" {self.reason}" if is_number and t > self.reach and self.reason else ""
            raise InvalidParameters(
                f"The motion {self.name!r} goes from t = 0 to {self.reach:g}, not to {t}.{why}"
            )
        return self.path(t)

    def frames(self, steps: int) -> list[Floats]:
        """Return the vertices at ``steps`` + 1 even places from the start to its reach.

        Raises InvalidParameters for less than one step.
        """
        if steps < 1:
            raise InvalidParameters(f"A motion takes one step at least, not {steps}.")
        return [self.at(self.reach * k / steps) for k in range(steps + 1)]
