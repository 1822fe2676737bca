"""Where lines meet: ends upon others and crossings, found in bounded memory and counted early."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidPattern

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Split = tuple[Indices, Floats, Indices]
"""Edge, place along it in (0, 1), and vertex: all (n,)."""

_AT_ONCE = 1_000_000
"""Pairs of lines that are looked at together: some 100 MB."""
_MOST_PAIRS = 20_000_000
"""Pairs of lines with boxes that touch, up to which a bounded search goes on: some seconds."""


_SLACK = 1.01
"""Times ``touch`` for what is looked at more closely, so that rounding loses nothing."""


@dataclass
class _Found:
    """What was found so far: each list in the order of the edges."""

    ends: tuple[list[Split], list[Split]] = field(default_factory=lambda: ([], []))
    """By the end of the other edge that lies on an edge."""
    crossings: tuple[list[Split], list[Split]] = field(default_factory=lambda: ([], []))
    """By the edge of a pair; their vertices are numbered from 0."""
    spots: list[Floats] = field(default_factory=list)
    crossed: int = 0
    ended: int = 0


def meetings(
    points: Floats, edges: Indices, touch: float, most: int | None = None
) -> tuple[Indices, Floats, Indices, Floats]:
    """Return edge, place along it in (0, 1) and vertex of every split, and all points.

    points : (V, 2) mm; edges : (E, 2); touch : mm within which an end lies on a line; most : pieces
    that may come of the edges. Raises InvalidPattern where more would, before they do, with their
    number.
    """
    found, pairs = _Found(), 0
    start, across = _frames(points, edges)
    for i, j in _near(points, edges, touch):
        pairs += len(i)
        able = _reaches(points, edges[j], start[i], across[i], touch)
        _add(found, points, edges, i[able], j[able], touch, most)
        if most is not None and pairs > _MOST_PAIRS:
            raise _refused(found, len(edges), most, is_whole=False)
    if most is not None and _pieces(found, len(edges)) > most:
        raise _refused(found, len(edges), most, is_whole=True)
    made = [(e, t, v + len(points)) for side in found.crossings for e, t, v in side]
    parts = [*found.ends[0], *found.ends[1], *made]
    edge, place, vertex = (
        np.concatenate([np.zeros(0, kind), *(part[k] for part in parts)])
        for k, kind in enumerate((np.intp, np.float64, np.intp))
    )
    return edge, place, vertex, np.vstack([points, *found.spots])


def _add(
    found: _Found,
    points: Floats,
    edges: Indices,
    i: Indices,
    j: Indices,
    touch: float,
    most: int | None,
) -> None:
    """Count what pairs of edges do to each other; keep it while it is not too much."""
    ends = [_ends_on(points, edges, i, edges[j, side], touch) for side in (0, 1)]
    once = i < j
    one, two, spots = _crossings(points, edges, i[once], j[once], touch)
    both = np.concatenate([np.stack([e, v], axis=1) for e, _, v in ends])
    found.ended += len(np.unique(both, axis=0))
    first, found.crossed = found.crossed, found.crossed + len(spots)
    if most is not None and _pieces(found, len(edges)) > most:
        return
    numbers = first + np.arange(len(spots))
    for side, (edge, place) in enumerate((one, two)):
        found.ends[side].append(ends[side])
        found.crossings[side].append((edge, place, numbers))
    found.spots.append(spots)


def _pieces(found: _Found, edges: int) -> int:
    return edges + found.ended + 2 * found.crossed


def _refused(found: _Found, edges: int, most: int, *, is_whole: bool) -> InvalidPattern:
    """Say how often the lines meet, and what to do about it."""
    pieces = _pieces(found, edges)
    remedy = "Leave out what is no crease, such as a hatch, or divide the pattern."
    if pieces <= most:
        return InvalidPattern(
            f"More than {_MOST_PAIRS:,} pairs of the {edges:,} lines lie so close together that "
            f"it would take too long to see where they meet. {remedy}"
        )
    more = "" if is_whole else "more than "
    return InvalidPattern(
        f"The {edges:,} lines cross or meet each other at {more}{found.crossed + found.ended:,} "
        f"places between their ends, which divides them into {more}{pieces:,}; the most that is "
        f"read is {most:,}. {remedy}"
    )


def _near(points: Floats, edges: Indices, touch: float) -> Iterator[tuple[Indices, Indices]]:
    """Yield all ordered pairs of edges whose boxes come within ``touch``, not too many at once."""
    import shapely

    if not len(edges):
        return
    ends = points[edges]
    low, high = ends.min(axis=1), ends.max(axis=1)
    tree = shapely.STRtree(shapely.box(*low.T, *high.T))
    low, high = low - touch, high + touch
    boxes = shapely.box(*low.T, *high.T)
    start = 0
    for stop in _stops(_most_near(low, high)):
        i, j = tree.query(boxes[start:stop]).astype(np.intp)
        i += start
        yield i[i != j], j[i != j]
        start = stop


def _most_near(low: Floats, high: Floats) -> Indices:
    """Return for each box (n,) how many others it may touch, by either axis alone."""
    counts = []
    for axis in (0, 1):
        begun = np.searchsorted(np.sort(low[:, axis]), high[:, axis], side="right")
        over = np.searchsorted(np.sort(high[:, axis]), low[:, axis], side="left")
        counts.append(begun - over)
    least: Indices = np.minimum(*counts)
    return least


def _stops(counts: Indices) -> Iterator[int]:
    """Yield where to stop so that counts add up to no more than _AT_ONCE, or are of one alone."""
    total = np.cumsum(counts)
    start = 0
    while start < len(counts):
        done = int(total[start - 1]) if start else 0
        start = max(start + 1, int(np.searchsorted(total, done + _AT_ONCE, side="right")))
        yield start


def _frames(points: Floats, edges: Indices) -> tuple[Floats, Floats]:
    """Return where each edge begins (E, 2), and the direction (E, 2) across it, of length 1."""
    start = points[edges[:, 0]]
    along = points[edges[:, 1]] - start
    return start, along[:, ::-1] * [-1.0, 1.0] / np.hypot(*along.T)[:, None]


def _reaches(
    points: Floats, others: Indices, start: Floats, across: Floats, touch: float
) -> NDArray[np.bool_]:
    """Tell which edges (n, 2) do not lie wholly on one side of their line (n, 2).

    Cheap, and most pairs end here.
    """
    one, two = (((points[others[:, k]] - start) * across).sum(axis=1) for k in (0, 1))
    reach = _SLACK * touch
    able: NDArray[np.bool_] = (np.minimum(one, two) <= reach) & (np.maximum(one, two) >= -reach)
    return able


def _ends_on(points: Floats, edges: Indices, i: Indices, vertex: Indices, touch: float) -> Split:
    """Keep the pairs whose vertex lies on the edge, between its ends."""
    a, b = points[edges[i, 0]], points[edges[i, 1]]
    along = b - a
    length = np.hypot(*along.T)
    step = points[vertex] - a
    place = (step * along).sum(axis=1) / length**2
    beside = np.abs(along[:, 0] * step[:, 1] - along[:, 1] * step[:, 0]) / length
    other = (vertex != edges[i, 0]) & (vertex != edges[i, 1])
    on = other & (beside <= touch) & (place > 0) & (place < 1)
    return i[on], place[on], vertex[on]


def _crossings(
    points: Floats, edges: Indices, i: Indices, j: Indices, touch: float
) -> tuple[tuple[Indices, Floats], tuple[Indices, Floats], Floats]:
    """Return (edge, place) of both edges of each pair that cross inside, and where."""
    a, c = points[edges[i, 0]], points[edges[j, 0]]
    u, v = points[edges[i, 1]] - a, points[edges[j, 1]] - c
    w = c - a
    across = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    lengths = np.hypot(*u.T), np.hypot(*v.T)
    open_ = np.abs(across) > 1e-12 * lengths[0] * lengths[1]
    safe = np.where(open_, across, 1.0)
    s = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / safe
    t = (w[:, 0] * u[:, 1] - w[:, 1] * u[:, 0]) / safe
    inside = open_ & _within(points, edges[i], a + s[:, None] * u, s, touch)
    inside &= _within(points, edges[j], a + s[:, None] * u, t, touch)
    where = (a + s[:, None] * u)[inside]
    return (i[inside], s[inside]), (j[inside], t[inside]), where


def _within(
    points: Floats, edges: Indices, where: Floats, place: Floats, touch: float
) -> NDArray[np.bool_]:
    """Tell which places lie on their edge, farther than ``touch`` from both its ends."""
    clear = np.ones(len(edges), bool)
    for side in (0, 1):
        clear &= np.hypot(*(where - points[edges[:, side]]).T) > touch
    inside: NDArray[np.bool_] = clear & (place > 0) & (place < 1)
    return inside
