"""How much of a sheet a pattern takes when it is turned as well as it can be.

The planner's own placement searches the rotation in the same steps and then to the last micrometre;
here it is done for thousands of patterns, all angles at once. What is found goes through the
planner's placement in the end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from foldmill_fabricate.passes import Sheet
from foldmill_fabricate.plan.placement import place

Floats = NDArray[np.float64]

STEP = 0.5
"""deg between the rotations tried first."""
FINER = 200
"""Into how many parts the two steps about the best of them are divided: a sheet of 500 mm turned by
half of one part takes 0.02 mm more."""


@dataclass(frozen=True)
class Room:
    """The sheet there is, and what the planner keeps clear beside the part, mm."""

    width: float
    height: float
    clearance: float = 0.0

    @property
    def diagonal(self) -> float:
        """No straight line on the sheet is longer, mm."""
        return float(np.hypot(self.width, self.height))


class Taken(NamedTuple):
    """What a part needs with its clearance, mm, and by how much that is more than there is."""

    width: float
    height: float
    over: float


def room(points: Floats, sheet: Room) -> Taken:
    """Return what the points (n, 2) mm need at the angle that suits the sheet best."""
    hull = points[ConvexHull(points).vertices]
    coarse = np.arange(0.0, 180.0, STEP)
    best = coarse[int(np.argmin(np.round(_over(hull, coarse, sheet), 6)))]
    fine = best + np.linspace(-STEP, STEP, FINER + 1)
    angle = fine[int(np.argmin(_over(hull, fine, sheet)))]
    width, height = _sides(hull, np.array([angle]), sheet)[:, 0]
    over = max(width - sheet.width, height - sheet.height)
    return Taken(float(width), float(height), max(0.0, float(over)))


def require_place(points: Floats, sheet: Room) -> None:
    """Raise DoesNotFit where the planner's placement finds no room."""
    blank = Sheet(
        width=sheet.width,
        height=sheet.height,
        carrier_width=sheet.width,
        carrier_height=sheet.height,
        dx=0,
        dy=0,
    )
    place(points, blank, sheet.clearance)


def _over(hull: Floats, degrees: Floats, sheet: Room) -> Floats:
    width, height = _sides(hull, degrees, sheet)
    over: Floats = np.maximum(width - sheet.width, height - sheet.height)
    return over


def _sides(hull: Floats, degrees: Floats, sheet: Room) -> Floats:
    """Return width and height (2, k) of the hull at each angle, clearance included."""
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    x, y = hull[:, :1], hull[:, 1:]
    sides: Floats = np.array([np.ptp(cos * x - sin * y, axis=0), np.ptp(sin * x + cos * y, axis=0)])
    return sides + 2 * sheet.clearance
