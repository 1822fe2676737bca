"""Blanks: the surplus paper beside a point inside its wedge, and the corner T that folds it away.

A blank with one inner point p_i lies between A = p_{i-2} and B = p_{i+2} on the symmetry line. The
corner t on AB is creased to A, B, p_i and the mirror image of p_i. T is where three spheres about
P_A, P_i and P_B meet (thesis 4.1.1): with τ = |A t|, c the foot of p_i on AB, L = |AB|,

    (T − P_A)·(P_B − P_A) = (2 L τ − L² + |P_A P_B|²) / 2      (T − P_A)·(P_i − P_A) = τ c

so T's foot in the plane is linear in τ, and the square of its height above it is quadratic.

Where |P_A P_B| < L there is always a t with a T: fold the blank along the bisector of its angle at
p_i, and its ends come as near as ||A p_i| − |B p_i||, which is nearer than P_A and P_B ever are.
The flap's triangles (A, p_i, t) and (t, p_i, B) cannot turn over in the pattern either: p_i lies
strictly beside the line, and t strictly between A and B.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric.strip import Strip
from foldmill.tolerances import COINCIDENT_MM

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Blank:
    """One blank of the half wedge: where T's foot and height are, as functions of τ."""

    point: int
    start: float
    """Distance of A from the centre, mm; t = start + τ."""
    length: float
    """L = |AB| in the pattern, mm."""
    along: Floats
    """(2,) unit vector of the symmetry line."""
    azimuth: float
    """Azimuth of the plane, rad."""
    foot: Floats
    """(2, 2): T's foot in the plane is foot[0] + τ·foot[1], as (r, z), mm."""
    base: Floats
    """(2,) P_A as (r, z)."""

    @property
    def ends(self) -> tuple[int, int]:
        """The points A and B."""
        return self.point - 2, self.point + 2

    def squared_height(self, tau: float) -> float:
        """Return the square of T's distance from the plane, mm²; negative where there is no T."""
        return tau**2 - float(np.sum((self.foot[0] + tau * self.foot[1] - self.base) ** 2))

    def reach(self) -> tuple[float, float]:
        """Return the open interval of t in which T exists; raises ImpossibleGeometry for none."""
        offset, slope = self.foot[0] - self.base, self.foot[1]
        a, b, c = 1 - slope @ slope, -2 * (offset @ slope), -(offset @ offset)
        roots = np.roots([a, b, c])
        real = np.sort(roots[np.isreal(roots)].real)
        cuts = np.unique(np.clip(np.concatenate([[0.0, self.length], real]), 0.0, self.length))
        runs = [
            (low, high)
            for low, high in pairwise(cuts)
            if high - low > COINCIDENT_MM and self.squared_height((low + high) / 2) > 0
        ]
        if not runs:
            raise ImpossibleGeometry(
                f"The blank beside point {self.point} cannot be tucked: no place of its corner "
                f"between points {self.ends[0]} and {self.ends[1]} reaches all three points in "
                f"space. Move point {self.point}, or points {self.ends[1]} and beyond."
            )
        low, high = max(runs, key=lambda run: run[1] - run[0])
        return self.start + float(low), self.start + float(high)

    def corner(self, t: float, side: int) -> tuple[Floats, Floats]:
        """Return t in the pattern (2,) and T in space (3,); raises ImpossibleGeometry."""
        low, high = self.reach()
        if not self.start < t < self.start + self.length:
            raise ImpossibleGeometry(
                f"The tuck beside point {self.point} has t = {t:g} mm, off its segment: give it a "
                f"value between {self.start:.6g} and {self.start + self.length:.6g} mm."
            )
        if not low < t < high:
            raise ImpossibleGeometry(
                f"The tuck beside point {self.point} has no place in space at t = {t:g} mm: give "
                f"it a value between {low:.6g} and {high:.6g} mm."
            )
        tau = t - self.start
        r, z = self.foot[0] + tau * self.foot[1]
        h = side * np.sqrt(self.squared_height(tau))
        cos, sin = np.cos(self.azimuth), np.sin(self.azimuth)
        return t * self.along, np.array([r * cos - h * sin, r * sin + h * cos, z])


def find(strip: Strip) -> list[Blank]:
    """Return the blanks of a strip, innermost first; raises ImpossibleGeometry."""
    return [_measure(strip, i) for i in strip.off_line]


def _measure(strip: Strip, i: int) -> Blank:
    a, b = i - 2, i + 2
    if b >= len(strip.flat):
        raise ImpossibleGeometry(
            f"The blank beside point {i} is open: add points up to {b}, on its line, to close it."
        )
    for neighbour in (a, b):
        if neighbour in strip.off_line:
            raise ImpossibleGeometry(
                f"Points {min(i, neighbour)} and {max(i, neighbour)} share one blank; a tuck needs "
                f"a blank with one free point. Put point {neighbour} on its line by an a."
            )
    azimuth = strip.theta if i % 2 == 0 else 0.0
    along = np.array([np.cos(azimuth), np.sin(azimuth)])
    start, end = float(strip.flat[a] @ along), float(strip.flat[b] @ along)
    pa, pi, pb = strip.meridian[a], strip.meridian[i], strip.meridian[b]
    length, gap = end - start, float(np.hypot(*(pb - pa)))
    if gap > length:
        raise ImpossibleGeometry(
            f"The gap beside point {i} is too short: points {a} and {b} are {gap:.6g} mm apart in "
            f"space, but only {length:.6g} mm in the pattern ({gap - length:.3g} mm too few)."
        )
    inner = float(strip.flat[i] @ along) - start
    matrix = np.array([pb - pa, pi - pa])
    if abs(np.linalg.det(matrix)) < COINCIDENT_MM * strip.flat.max():
        raise ImpossibleGeometry(
            f"Points {a}, {i} and {b} are in one line in space, so that the blank beside point {i} "
            f"has no determined tuck; move point {i} a little."
        )
    constant = np.linalg.solve(matrix, [(gap**2 - length**2) / 2, 0.0])
    linear = np.linalg.solve(matrix, [length, inner])
    foot = np.array([pa + constant, linear])
    return Blank(i, start, length, along, azimuth, foot, pa)
