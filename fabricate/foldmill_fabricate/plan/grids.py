"""Copies of a part in a grid, all turned alike: which grid and which turn leave the most room.

A *block* is the box round all copies, without the clearance around it. The search for the turn is
coarse first, then refined; where that finds no room, every turn is tried that lays a side of the
part along the sheet, because the smallest boxes round a polygon are among those (Freeman and
Shapira 1975).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.sheet import turned

Floats = NDArray[np.float64]

_STEP = 0.5
"""deg between the rotations tried first; the best of them is then refined."""
ROOMY = 30.0
"""mm beside the part on every side that leave room for holes and hands: then it is not turned."""
TOUCH = 2e-6
"""mm that may be missing: what a neat angle costs, and rounding."""


class Grid(NamedTuple):
    """Copies side by side and above each other."""

    columns: int
    rows: int


class Turn(NamedTuple):
    """A grid, how its copies are turned (deg), and what is missing of the room it takes, mm."""

    grid: Grid
    angle: float
    missing: float

    @property
    def fits(self) -> bool:
        """Whether nothing is missing."""
        return self.missing <= TOUCH


@dataclass(frozen=True, eq=False)
class Block:
    """So many copies of a part, ``clearance`` mm apart and from the edge."""

    hull: Floats
    """(n, 2) mm: the corners of the part's convex hull."""
    clearance: float
    count: int = 1
    shape: Grid | None = None
    """The grid wanted; None leaves it to the sheet."""

    @classmethod
    def of(
        cls, points: Floats, clearance: float, count: int = 1, shape: Grid | None = None
    ) -> Block:
        """Return the block of copies of a part, its vertices (n, 2) in mm."""
        from scipy.spatial import ConvexHull

        wanted = count if shape is None else shape.columns * shape.rows
        return cls(points[ConvexHull(points).vertices], clearance, wanted, shape)

    @property
    def grids(self) -> list[Grid]:
        """The grids that hold all copies, without an empty row or column."""
        if self.shape is not None:
            return [self.shape]
        columns = {-(-self.count // -(-self.count // c)) for c in range(1, self.count + 1)}
        return [Grid(c, -(-self.count // c)) for c in sorted(columns)]

    def size(self, grid: Grid, degrees: float) -> tuple[float, float]:
        """Return width and height of the block, mm."""
        return self._grown(grid, np.ptp(turned(self.hull, degrees), axis=0))

    def needs(self, grid: Grid, degrees: float) -> tuple[float, float]:
        """Return width and height of the blank that just holds the block, mm."""
        width, height = self.size(grid, degrees)
        return width + 2 * self.clearance, height + 2 * self.clearance

    def best(self, width: float, height: float) -> Turn:
        """Return grid and turn for a blank of that size: the most room, or the least missing.

        More room than ``ROOMY`` on every side counts for nothing: then full rows come first.
        """
        order = sorted(self.grids, key=lambda grid: self._rank(grid, width, height))
        missed = []
        for grid in order:
            found = self._turn(grid, width, height)
            if found.fits:
                return found
            missed.append(found)
        return min(missed, key=lambda turn: round(turn.missing, 6))

    def most(self, width: float, height: float) -> int:
        """Return how many copies fit on a blank of that size, in any grid; fewer than wanted."""
        low, high = 0, self.count
        while high - low > 1:
            middle = (low + high) // 2
            fits = replace(self, count=middle, shape=None).best(width, height).fits
            low, high = (middle, high) if fits else (low, middle)
        return low

    @cached_property
    def aligned(self) -> Floats:
        """(k,) deg in [0, 180): the turns that lay a side of the hull along the sheet's."""
        x, y = (np.roll(self.hull, -1, axis=0) - self.hull).T
        flat = np.round(np.degrees(np.arctan2(-y, x)) % 90, 9)
        turns: Floats = np.unique(np.concatenate([flat, flat + 90, [0.0, 90.0]]) % 180)
        return turns

    @cached_property
    def _tried(self) -> tuple[Floats, Floats]:
        """The turns tried first (k,), and width and height (2, k) of one copy."""
        angles = np.arange(0.0, 180.0, _STEP)
        return angles, np.array([np.ptp(turned(self.hull, a), axis=0) for a in angles]).T

    def _grown(self, grid: Grid, sides: Floats) -> tuple[float, float]:
        width = grid.columns * sides[0] + (grid.columns - 1) * self.clearance
        height = grid.rows * sides[1] + (grid.rows - 1) * self.clearance
        return width, height

    def _rank(self, grid: Grid, width: float, height: float) -> tuple[float, int, float, int]:
        _, sides = self._tried
        across, along = self._grown(grid, sides)
        excess = round(float(np.maximum(across - width, along - height).min()), 6)
        empty = grid.columns * grid.rows - self.count
        return max(excess, -2 * ROOMY), empty, excess, grid.columns

    def _turn(self, grid: Grid, width: float, height: float) -> Turn:
        def excess(degrees: float) -> float:
            across, along = self.size(grid, degrees)
            return float(max(across - width, along - height))

        angle = 0.0 if excess(0.0) <= -2 * ROOMY else self._best_angle(excess)
        missing = excess(angle) + 2 * self.clearance
        if missing > TOUCH:
            angle = min([angle, *self.aligned.tolist()], key=lambda a: round(excess(a), 9))
            missing = excess(angle) + 2 * self.clearance
        return Turn(grid, angle, missing)

    def _best_angle(self, excess: Callable[[float], float]) -> float:
        from scipy.optimize import minimize_scalar

        tried, _ = self._tried
        values = np.array([excess(angle) for angle in tried])
        best = float(tried[int(np.argmin(np.round(values, 6)))])
        found = minimize_scalar(
            excess, bounds=(best - _STEP, best + _STEP), method="bounded", options={"xatol": 1e-9}
        )
        fine = float(found.x) if found.fun < excess(best) - 1e-6 else best
        # A round number reads better on the job sheet; take it where it costs nothing.
        neat = round(fine, 3)
        return neat if excess(neat) <= excess(fine) + 1e-6 else fine
