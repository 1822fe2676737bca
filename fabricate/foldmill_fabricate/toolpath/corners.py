"""What it costs to go round a corner, and which edges go on into which at a vertex."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Motion

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

TURN_DEG = 30.0
"""deg. A trailing blade or wheel that turns by more than this tears the material."""
_SMALL = 8
"""Up to so many edges at a vertex every way of pairing them is tried: 105 ways at most."""
_SLAB = 4096
"""Vertices looked at together, so that memory stays with the number of edges."""


@dataclass(frozen=True)
class Corners:
    """What turning and lifting cost a tool, in one unit."""

    turn: Callable[[Floats], Floats]
    """Cost of going on with the tool down, of the angle (n,) deg by which the way bends."""
    lift: float
    """Cost of lifting and setting down again at the same place."""
    forced: bool = False
    """Whether as few strokes as possible are made even where lifting would cost less."""

    def best(self, angles: Floats) -> Floats:
        """Return the cost (n,) of joining two edges, lifted where that costs less."""
        cost: Floats = np.minimum(self.turn(angles), self.lift)
        return cost


def free_turning() -> Corners:
    """Return the corners of a pen or laser: it turns for nothing; straight on where it may."""
    return Corners(turn=lambda angles: 1e-6 * angles / 180, lift=1.0)


def fewest_turns() -> Corners:
    """Return the corners of a trailing tool that is not lifted: as few sharp turns as can be."""
    return Corners(
        turn=lambda angles: (angles > TURN_DEG) + 1e-6 * angles / 180, lift=0.5, forced=True
    )


def by_time(motion: Motion) -> Corners:
    """Return the corners of a trailing tool by the machine's own figures, s."""
    return Corners(
        turn=lambda angles: (
            motion.swivel_time * (angles > motion.swivel_from) + angles / motion.swivel_speed
        ),
        lift=2 * motion.lift_time,
    )


def bends(one: Floats, other: Floats) -> Floats:
    """Return by how much a way bends that comes in along one spoke and leaves along the other.

    one, other : directions (n,) of the spokes seen from the vertex, deg.
    """
    gap = np.abs(one - other) % 360
    # Rounded, so that equal corners compare equal whatever way they lie.
    bend: Floats = np.round(180 - np.minimum(gap, 360 - gap), 7)
    return bend


def pair(vertices: Indices, spokes: Floats, corners: Corners) -> Indices:
    """Return, for each edge end, the end that it goes on into at its vertex, or -1.

    vertices : (n,) the vertex each edge end lies at; spokes : (n,) deg direction of its edge seen
    from there. At each vertex as many pairs are made as can be, at the least cost in all; at an odd
    vertex the one left over is chosen with them.
    """
    partner = np.full(len(vertices), -1, np.intp)
    order = np.argsort(vertices, kind="stable")
    first = np.flatnonzero(np.r_[True, np.diff(vertices[order]) > 0])
    counts = np.diff(np.r_[first, len(order)])
    cost = corners.turn if corners.forced else corners.best
    for degree in np.unique(counts).tolist():
        at = first[counts == degree]
        for low in range(0, len(at), _SLAB):
            ends = order[at[low : low + _SLAB, None] + np.arange(degree)]
            for one, other in _pairs_of(ends, spokes, cost):
                partner[one], partner[other] = other, one
    return partner


def _pairs_of(
    ends: Indices, spokes: Floats, cost: Callable[[Floats], Floats]
) -> list[tuple[Indices, Indices]]:
    """Return the cheapest pairs of ends (v, d) of vertices that all have d edges."""
    degree = ends.shape[1]
    if degree < 2:
        return []
    if degree > _SMALL:
        return [pair for own in ends for pair in _pairs_at_large(own, spokes, cost)]
    ways = _ways(degree)
    angles = bends(spokes[ends][:, ways[..., 0]], spokes[ends][:, ways[..., 1]])
    total = np.round(cost(angles).sum(axis=2), 12)
    best = ways[np.argmin(total, axis=1)]
    rows = np.arange(len(ends))[:, None]
    return [(ends[rows, best[..., 0]].ravel(), ends[rows, best[..., 1]].ravel())]


@cache
def _ways(degree: int) -> Indices:
    """Return all ways (w, degree // 2, 2) of pairing so many edges, one left over where odd."""

    def rest(left: tuple[int, ...]) -> list[list[tuple[int, int]]]:
        if len(left) < 2:
            return [[]]
        head, *tail = left
        found = [
            [(head, other), *more]
            for other in tail
            for more in rest(tuple(k for k in tail if k != other))
        ]
        return found + (rest(tuple(tail)) if len(left) % 2 else [])

    return np.array(rest(tuple(range(degree))), np.intp)


def _pairs_at_large(
    ends: Indices, spokes: Floats, cost: Callable[[Floats], Floats]
) -> list[tuple[Indices, Indices]]:
    """Return the cheapest pairs at one vertex of many edges, by matching."""
    from foldmill_fabricate.toolpath.matching import cheapest

    i, j = np.triu_indices(len(ends), 1)
    found = cheapest(len(ends), i, j, cost(bends(spokes[ends[i]], spokes[ends[j]])))
    return [(ends[found[:, 0]], ends[found[:, 1]])]
