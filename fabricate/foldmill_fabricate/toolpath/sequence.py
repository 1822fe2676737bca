"""The order of separate strokes, and from which end each is drawn, for the least travel."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_FEW = 4
"""Strokes of which every order is tried: 384 at most."""
NEAR = 8
"""Ends that are tried beside each end."""
KICKS = 30
"""Kicks per stroke: 500 random lines end 2.4 % above the bound of Held and Karp, 1,000 3.6 %."""
SMALL = 200
"""Strokes up to which a sheet is small: a tenth of the kicks leaves the order of a stool as it is,
and where nothing is compiled each kick takes milliseconds."""
LEAST_KICKS = 200
"""Kicks at the least: with these every trial of five strokes was ordered as well as can be."""
MOST_KICKS = 100_000
"""Kicks at the most, so that a large sheet does not take minutes."""


def order(
    ends: Floats,
    start: Floats | None,
    *,
    returns: bool = False,
    kicks: int | None = None,
) -> list[tuple[int, bool]]:
    """Return strokes in order of work, each with whether it is drawn backwards.

    ends : (n, 2, 2) first and last point of each stroke, mm; start : (2,) where the tool is, None
    for anywhere; returns : whether a stroke leaves the tool where it began (an even number of
    repeats); kicks : how often the order is disturbed and mended again, by default KICKS per
    stroke, fewer on a small sheet. The same input gives the same order.
    """
    count = len(ends)
    if count <= _FEW:
        return _best_of_all(ends, start, returns)
    from foldmill_fabricate.toolpath.loops import improve

    nowhere = np.full(2, np.nan)
    depot = [[nowhere, nowhere if start is None else start]]
    xy = np.concatenate([ends, depot]).reshape(-1, 2)
    near = _near(xy, ends)
    sequence, side = _nearest_first(ends, start, returns)
    seq = np.append(sequence, count).astype(np.int64)
    sides = np.append(side, 0).astype(np.int64)
    improve(xy, near, seq, sides, returns, _kicks(count) if kicks is None else kicks)
    return _from_depot(seq, sides, returns)


def _kicks(count: int) -> int:
    each = KICKS // 10 if count <= SMALL else KICKS
    return min(max(each * count, LEAST_KICKS), MOST_KICKS)


def _best_of_all(ends: Floats, start: Floats | None, returns: bool) -> list[tuple[int, bool]]:
    """Try every order and direction of a few strokes."""
    ways = (
        list(zip(sequence, sides, strict=True))
        for sequence in permutations(range(len(ends)))
        for sides in product((False, True), repeat=len(ends))
    )
    return min(ways, key=lambda way: round(travelled(ends, start, way, returns), 9))


def travelled(
    ends: Floats, start: Floats | None, way: list[tuple[int, bool]], returns: bool
) -> float:
    """Return the travel between strokes in this order, mm."""
    at, total = start, 0.0
    for stroke, backwards in way:
        entry = ends[stroke, int(backwards)]
        total += 0.0 if at is None else float(np.hypot(*(entry - at)))
        at = ends[stroke, int(backwards) if returns else 1 - int(backwards)]
    return total


def _near(xy: Floats, ends: Floats) -> NDArray[np.int64]:
    """Return the nodes to try beside each: the open end first, then the nearest ends."""
    from scipy.spatial import cKDTree

    count, near = 2 * len(ends), min(NEAR + 2, 2 * len(ends))
    places = np.nan_to_num(xy)
    found = cKDTree(xy[:count]).query(places, k=near)[1].reshape(len(xy), near)
    own = found // 2 == (np.arange(len(xy)) // 2)[:, None]
    found = np.where(own, -1, found)
    table = np.concatenate([np.full((len(xy), 1), count), found], axis=1)
    loose = ~np.isfinite(xy[:, 0])
    table[count:, 0] = -1
    table[loose] = -1
    return np.ascontiguousarray(table, np.int64)


def _nearest_first(ends: Floats, start: Floats | None, returns: bool) -> tuple[Indices, Indices]:
    """Go to the nearest end that is left, again and again."""
    from scipy.spatial import cKDTree

    flat = ends.reshape(-1, 2)
    tree = cKDTree(flat)
    left = np.ones(len(ends), bool)
    at = flat[0] if start is None else start
    sequence: list[int] = []
    side: list[int] = []
    while len(sequence) < len(ends):
        node = _nearest(tree, flat, left, at)
        stroke, end = divmod(node, 2)
        left[stroke] = False
        sequence.append(stroke)
        side.append(end)
        at = ends[stroke, end if returns else 1 - end]
    return np.array(sequence, np.intp), np.array(side, np.intp)


def _nearest(tree: object, flat: Floats, left: NDArray[np.bool_], at: Floats) -> int:
    near = 8
    while near < len(flat):
        found = tree.query(at, k=near)[1]  # type: ignore[attr-defined]
        free = found[left[found // 2]]
        if len(free):
            return int(free[0])
        near *= 4
    nodes = np.flatnonzero(np.repeat(left, 2))
    return int(nodes[np.argmin(np.hypot(*(flat[nodes] - at).T))])


def _from_depot(
    seq: NDArray[np.int64], side: NDArray[np.int64], returns: bool
) -> list[tuple[int, bool]]:
    """Cut the closed tour at the depot; turn it round where the depot was."""
    depot = len(seq) - 1
    at = int(np.flatnonzero(seq == depot)[0])
    way = np.r_[seq[at + 1 :], seq[:at]]
    ends = side[way]
    if side[depot] == 1:  # left at the node where the tour may end: it was turned round
        way, ends = way[::-1], (ends if returns else 1 - ends)[::-1]
    return [(int(s), bool(e)) for s, e in zip(way, ends, strict=True)]
