"""For which opening angles does an axisymmetric form pass through nothing?

By the wedge theorem: where all radii have one sign, the triangles of one half wedge decide for the
whole form; where signs are mixed, facets cross at the axis.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from foldmill import planar
from foldmill.axisymmetric import strip
from foldmill.axisymmetric.points import LinePoint
from foldmill.axisymmetric.rosette import HalfWedge
from foldmill.check.intersection import penetrations
from foldmill.errors import FoldmillError

STEP_DEG = 1.0
"""deg between the angles looked at; a shorter interval can be missed."""
FINENESS_DEG = 0.01
"""deg to which the ends of an interval are narrowed down."""


def is_free(order: int, phi: float, points: Mapping[int, LinePoint]) -> bool:
    """Tell whether the form exists at φ (deg) and no facet passes through another."""
    try:
        solved = strip.solve(order, phi, points)
    except FoldmillError:
        return False
    if not solved.one_sided:
        return False
    half = HalfWedge.of(solved)
    sides, _ = planar.face_sides(half.faces)
    edges = np.unique(np.sort(sides, axis=1), axis=0)
    return not len(penetrations(half.spatial, edges, half.faces))


def free_intervals(order: int, points: Mapping[int, LinePoint]) -> list[tuple[float, float]]:
    """Return the intervals of φ in [0, 180] deg that are free of penetration, ascending.

    Looked at every degree, their ends narrowed down to 0.01 degrees, on the free side.
    """
    angles = np.arange(0.0, 180.0 + STEP_DEG, STEP_DEG)
    free = [is_free(order, float(phi), points) for phi in angles]
    found: list[list[float]] = [[0.0]] if free[0] else []
    for (low, high), (was, now) in zip(pairwise(angles), pairwise(free), strict=True):
        if now and not was:
            found.append([_edge(order, points, float(high), float(low))])
        if was and not now:
            found[-1].append(_edge(order, points, float(low), float(high)))
    if free[-1]:
        found[-1].append(180.0)
    return [(low, high) for low, high in found]


def _edge(order: int, points: Mapping[int, LinePoint], free: float, hit: float) -> float:
    while abs(hit - free) > FINENESS_DEG:
        middle = (free + hit) / 2
        if is_free(order, middle, points):
            free = middle
        else:
            hit = middle
    return free
