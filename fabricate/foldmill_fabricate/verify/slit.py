"""Which boundary edges are the two banks of a slit: found from where they lie, for verification.

Two boundary edges are banks where their middles coincide, they run along each other, and the paper
beside them is on either side. They are one line to cut, once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill_fabricate.verify import tolerances

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Slits:
    """The slits of a pattern."""

    first: Flags
    """(E,) the banks that stand for their slits."""
    second: Flags
    """(E,) the banks that lie upon those."""
    node: Indices
    """(V,) the place of each vertex: alike for two that a slit divides."""


def slits(pattern: CreasePattern) -> Slits:
    """Find the slits of a pattern."""
    first = np.zeros(len(pattern.edges), bool)
    second, node = first.copy(), np.arange(len(pattern.vertices))
    border = np.flatnonzero(pattern.assignments == Assignment.B)
    for one, two in _upon_each_other(pattern, border):
        first[one] = second[two] = True
        for vertex in pattern.edges[two]:
            gaps = np.hypot(*(pattern.vertices[pattern.edges[one]] - pattern.vertices[vertex]).T)
            low, high = sorted((int(vertex), int(pattern.edges[one][gaps.argmin()])))
            node[high] = min(node[high], node[low])
    return Slits(first, second, node)


def _upon_each_other(pattern: CreasePattern, border: Indices) -> list[tuple[int, int]]:
    import shapely

    ends = pattern.vertices[pattern.edges[border]]
    lines, middles = shapely.linestrings(ends), shapely.points(ends.mean(axis=1))
    reach = tolerances.PLAN_MM
    i, j = shapely.STRtree(middles).query(middles, predicate="dwithin", distance=reach)
    i, j = i[i < j], j[i < j]
    alike = shapely.hausdorff_distance(lines[i], lines[j]) <= reach
    paper = _paper(pattern, border)
    along = ends[i, 1] - ends[i, 0]
    sides = [_left(along, paper[k] - ends[i, 0]) for k in (i, j)]
    kept = alike & (sides[0] != sides[1])
    return list(zip(border[i[kept]].tolist(), border[j[kept]].tolist(), strict=True))


def _paper(pattern: CreasePattern, border: Indices) -> Floats:
    """Return the middle (k, 2) of the one face beside each boundary edge."""
    beside = pattern.edge_faces[border].max(axis=1)
    middles: Floats = pattern.vertices[pattern.faces[beside]].mean(axis=1)
    return middles


def _left(along: Floats, step: Floats) -> Flags:
    left: Flags = along[:, 0] * step[:, 1] > along[:, 1] * step[:, 0]
    return left
