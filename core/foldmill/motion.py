"""A motion: how a form moves, every crease a hinge, over one and the same pattern."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidParameters

Floats = NDArray[np.float64]


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

    def at(self, t: float) -> Floats:
        """Return the vertices (V, 3) mm at t; raises InvalidParameters beyond its reach."""
        if not 0 <= t <= self.reach:
            why = f" {self.reason}" if t > self.reach and self.reason else ""
            raise InvalidParameters(
                f"The motion {self.name!r} goes from t = 0 to {self.reach:g}, not to {t:g}.{why}"
            )
        return self.path(t)

    def frames(self, steps: int) -> list[Floats]:
        """Return the vertices at ``steps`` + 1 even places from the start to its reach."""
        return [self.at(self.reach * k / steps) for k in range(steps + 1)]
