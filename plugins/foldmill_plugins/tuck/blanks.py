"""Blanks: the surplus paper beside points inside their wedge, between A and B on the symmetry line.

A blank holds k ≥ 1 consecutive points p_i, p_{i+2} … off one line (thesis 4.1.1, Figs. 4.5, 4.7).
It is folded along AB and at corners t_i, t_{i+2} … on AB, one for each point. An *open* blank ends
at the boundary of the sheet: it has no B.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric.strip import Strip
from foldmill.tolerances import COINCIDENT_MM
from foldmill.vectors import cross

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Blank:
    """One blank of the half wedge, flat and in space."""

    points: tuple[int, ...]
    """The points off the line, k ≥ 1 of one parity."""
    is_open: bool
    azimuth: float
    """Azimuth of the plane, rad; also that of the line in the pattern."""
    feet: Floats
    """(k + 2,) distance from the centre of A, of the points' feet on the line, and of B, mm. For an
    open blank the last is where the corner lies if nobody says otherwise."""
    beside: Floats
    """(k + 2,) distance from the line of the same, mm; 0 for the ends."""
    spatial: Floats
    """(k + 2, 3) P_A, P_i … P_B, mm; without P_B for an open blank."""
    above: Floats
    """(k + 1, 3) the point P_{i-1} beyond each seam A-p_i, p_i-p_{i+2} …, mm; k for an open one."""

    @property
    def first(self) -> int:
        """A's number."""
        return self.points[0] - 2

    @property
    def chain(self) -> tuple[int, ...]:
        """The numbers of A, the points, and B where there is one."""
        return (self.first, *self.points, *(() if self.is_open else (self.points[-1] + 2,)))

    @property
    def along(self) -> Floats:
        """(2,) unit vector of the symmetry line."""
        return np.array([np.cos(self.azimuth), np.sin(self.azimuth)])

    @property
    def across(self) -> Floats:
        """(3,) unit normal of the symmetry plane, counter-clockwise seen from above."""
        return np.array([-np.sin(self.azimuth), np.cos(self.azimuth), 0.0])

    @property
    def start(self) -> float:
        """Distance of A from the centre, mm."""
        return float(self.feet[0])

    @property
    def end(self) -> float:
        """Distance of B from the centre, mm; for an open blank, where its last corner lies."""
        return float(self.feet[-1])

    @property
    def name(self) -> str:
        """ "point 4" or "points 5 and 7"."""
        numbers = [str(i) for i in self.points]
        if len(numbers) == 1:
            return f"point {numbers[0]}"
        return f"points {', '.join(numbers[:-1])} and {numbers[-1]}"


def find(strip: Strip) -> list[Blank]:
    """Return the blanks of a strip, innermost first; raises ImpossibleGeometry."""
    off = set(strip.off_line)
    found = []
    for i in sorted(off):
        if i - 2 not in off:
            run = [i]
            while run[-1] + 2 in off:
                run.append(run[-1] + 2)
            found.append(_measure(strip, tuple(run)))
    for blank in found:
        if not blank.is_open:
            _check(blank)
    return found


def _measure(strip: Strip, points: tuple[int, ...]) -> Blank:
    is_open = points[-1] + 2 >= len(strip.flat)
    chain = [points[0] - 2, *points, *([] if is_open else [points[-1] + 2])]
    azimuth = strip.theta if points[0] % 2 == 0 else 0.0
    along = np.array([np.cos(azimuth), np.sin(azimuth)])
    flat = strip.flat[chain]
    feet = flat @ along
    beside = np.abs(flat @ np.array([-along[1], along[0]]))
    beside[0] = 0.0
    if is_open:
        feet, beside = np.append(feet, _rim(feet, beside)), np.append(beside, 0.0)
    else:
        beside[-1] = 0.0
    between = [i - 1 for i in chain[1:]]
    spatial = strip.spatial
    return Blank(points, is_open, azimuth, feet, beside, spatial[chain], spatial[between])


def _rim(feet: Floats, beside: Floats) -> float:
    """Return where the last corner of an open blank makes a straight rim, or else one of use."""
    return max(float(feet[-1]), float(feet[0] + beside[-1]))


def _check(blank: Blank) -> None:
    a, b = blank.chain[0], blank.chain[-1]
    gap = float(np.linalg.norm(blank.spatial[-1] - blank.spatial[0]))
    length = blank.end - blank.start
    if gap > length:
        raise ImpossibleGeometry(
            f"The gap beside {blank.name} is too short: points {a} and {b} are {gap:.6g} mm apart "
            f"in space, but only {length:.6g} mm in the pattern ({gap - length:.3g} mm too few)."
        )
    one, two = blank.spatial[1] - blank.spatial[0], blank.spatial[2] - blank.spatial[0]
    if np.linalg.norm(cross(one, two)) < COINCIDENT_MM * float(np.abs(blank.feet).max()):
        x, y, z = blank.chain[:3]
        raise ImpossibleGeometry(
            f"Points {x}, {y} and {z} are in one line in space, so that the blank beside "
            f"{blank.name} has no determined tuck; move point {y} a little."
        )
