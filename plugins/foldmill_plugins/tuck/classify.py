"""Valid, invalid, blank: what the angles at each point say (thesis 4.1.1).

A point beside a blank is two copies in the pattern and one point in space. So its angles sum twice:
round one copy in the pattern, where 360° less the sum is the blank's own angle, and round the one
point in space, where both copies meet: that may well be more than 360°. Between the ends of a
blank, on the symmetry line, both sums are alike.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import InvalidInput
from foldmill.axisymmetric import strip
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.axisymmetric.rosette import HalfWedge
from foldmill.axisymmetric.strip import Strip
from foldmill.check.developability import angle_sums

Floats = NDArray[np.float64]


class Kind(StrEnum):
    """What a point is."""

    ON_LINE = "on its line"
    """valid, no paper is left over beside it"""
    BLANK = "blank"
    """valid, strictly inside its wedge: a blank lies beside it"""
    INVALID = "invalid"
    """beyond its line: paper would have to lie upon paper"""


@dataclass(frozen=True)
class State:
    """One point and the angles of the surface, without flaps, about it."""

    point: int
    kind: Kind
    beside_mm: float
    """How far it lies inside its line in the pattern; negative beyond it."""
    pattern_deg: float
    """Sum of the angles round one copy of it in the pattern."""
    folded_deg: float
    """Sum of the angles round it in space."""
    is_rim: bool
    """Whether it lies on the boundary of the sheet, where no sum is asked for."""


def states(
    order: int, phi: float, points: Mapping[int, LinePoint | FreePoint]
) -> tuple[list[State], str]:
    """Classify the points as far as they can be solved, and say why they cannot be beyond.

    Points crossing their line are classified too, as ``Kind.INVALID``, with the angle sums about
    them and about the point before them, which then exceed 360°. Raises InvalidInput only where not
    even points 1 and 2 are solved.
    """
    reason, count = "", len(points)
    while True:
        some = {i: points[i] for i in range(1, count + 1)}
        try:
            return of_strip(strip.solve(order, phi, some, refuse_crossing=False)), reason
        except InvalidInput as error:
            if count <= 2:
                raise
            reason, count = str(error), count - 1


def figures(solved: Strip) -> list[dict[str, Any]]:
    """Return the states of all points of a strip as plain values, angles to 1e-9 deg."""
    return [
        {key: round(value, 9) if isinstance(value, float) else value for key, value in row.items()}
        for row in ({**vars(state), "kind": str(state.kind)} for state in of_strip(solved))
    ]


def of_strip(solved: Strip) -> list[State]:
    """Classify every point of a strip but the centre."""
    count = len(solved.flat)
    sums = np.degrees(angle_sums(solved.flat, HalfWedge.of(solved).faces)).tolist()
    x, y = solved.flat.T
    across = x * np.sin(solved.theta) - y * np.cos(solved.theta)
    beside = np.where(np.arange(count) % 2 == 0, across, y).tolist()
    return [_state(solved, i, sums[i], beside[i], i >= count - 2) for i in range(1, count)]


def _state(solved: Strip, i: int, half_sum: float, beside: float, is_rim: bool) -> State:
    on_line = i not in solved.off_line and i not in solved.crossing
    kind = Kind.ON_LINE if on_line else Kind.BLANK if i in solved.off_line else Kind.INVALID
    in_pattern = 2 * half_sum if on_line else half_sum
    return State(i, kind, 0.0 if on_line else beside, in_pattern, 2 * half_sum, is_rim)
