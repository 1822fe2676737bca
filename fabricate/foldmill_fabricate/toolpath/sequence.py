"""The order of separate strokes, and from which end each is drawn, for the least travel."""

from __future__ import annotations

from itertools import permutations, product
from math import sqrt

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Way = list[tuple[int, bool]]

_FEW = 4
"""Strokes of which every order is tried: 384 at most."""
NEAR = 8
"""Ends that are tried beside each end."""
KICKS = 18
"""Kicks per stroke at the most: 500 and 1,000 random lines end about 0.5 % above the best order
known, in less time than others take."""
SMALL = 384
"""Strokes below which there are fewer per stroke, in proportion: few strokes are soon in order; and
up to which the way is rebuilt too, for which all their distances are held."""
ROUNDS = 150
"""Rounds of rebuilding per stroke: with 70, some of twelve turned copies of 72 strokes that return
ended above the least there is; with these none."""
FEW_KICKS = 6
"""Kicks per stroke of the smallest sheets: ten times as many take three times as long without numba
and end at the same way on the stool, 0.7 % shorter at the most on 50 to 200 random lines."""
MANY = 1000
"""Strokes beyond which there are fewer per stroke, by the root of their number: with the same time
per kick, all kicks together grow more slowly than the sheet."""
LEAST_KICKS = 200
"""Kicks at the least: with these every trial of five strokes was ordered as well as can be."""
FEW_AT_MOST = 400
"""Kicks up to which small sheets have FEW_KICKS per stroke."""


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
    repeats); kicks : how often the order is disturbed and mended again, by default up to KICKS per
    stroke. The same strokes give the same way, in whatever order and direction they are given.
    """
    listed, turned = _listed(ends)
    placed = np.where(turned[:, None, None], ends[listed, ::-1], ends[listed])
    way = _order(placed, start, returns, kicks)
    return [(int(listed[k]), backwards != bool(turned[k])) for k, backwards in way]


def _listed(ends: Floats) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return strokes by their places, from left to right, and which of these are turned for it."""
    one, other = ends[:, 0], ends[:, 1]
    turned = (one[:, 0] > other[:, 0]) | ((one[:, 0] == other[:, 0]) & (one[:, 1] > other[:, 1]))
    flat = np.where(turned[:, None, None], ends[:, ::-1], ends).reshape(-1, 4)
    listed = np.lexsort(flat.T[::-1])
    return listed, turned[listed]


def _order(
    ends: Floats, start: Floats | None, returns: bool, kicks: int | None
) -> list[tuple[int, bool]]:
    """Return the order of strokes that are listed by their places."""
    count = len(ends)
    if count <= _FEW:
        return _best_of_all(ends, start, returns)
    nowhere = np.full(2, np.nan)
    depot = [nowhere, nowhere if start is None else start]
    flat = np.ascontiguousarray(np.concatenate([ends.reshape(-1, 2), depot]))
    most = _kicks(count) if kicks is None else kicks
    way = _kicked(flat, None, returns, most)
    if count > SMALL:
        return way
    return min(
        [way, *_rebuilt(flat, way, returns, most, ROUNDS * count if kicks is None else kicks)],
        key=lambda way: round(travelled(ends, start, way, returns), 9),
    )


def _kicked(flat: Floats, way: Way | None, returns: bool, kicks: int) -> Way:
    """Return a way that is mended and kicked, from this one on or from the shortest hops.

    flat : (2n + 2, 2) ends, mm, the last two where the way may end and where it begins.
    """
    from foldmill_fabricate.toolpath.greedy import first_tour
    from foldmill_fabricate.toolpath.loops import improve

    tour, at = first_tour(flat, returns) if way is None else _tour(way, returns)
    improve(flat, at, _near(flat), tour, returns, kicks)
    return _from_depot(tour, at)


def _rebuilt(flat: Floats, way: Way, returns: bool, kicks: int, rounds: int) -> list[Way]:
    """Return two more ways over few strokes: of this one rebuilt, and of one rebuilt, then kicked.

    Begun at different ends, the two seldom stop at the same way that is not the best.
    """
    from foldmill_fabricate.toolpath.rebuilt import rebuilt

    plain = rebuilt(flat, _kicked(flat, None, returns, 0), returns, rounds)
    return [rebuilt(flat, way, returns, rounds), _kicked(flat, plain, returns, kicks // 2)]


def _kicks(count: int) -> int:
    """Return how often strokes are kicked: alike with and without a compiler."""
    each = KICKS * min(1.0, count / SMALL, sqrt(MANY / count))
    few = min(FEW_KICKS * count, FEW_AT_MOST)
    return max(int(each * count), few, LEAST_KICKS)


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


def _near(ends: Floats) -> NDArray[np.int32]:
    """Return the ends to try beside each, -1 for none; beside a stroke's the open end first.

    ends : (n, 2) mm, the last two where the tour may end and where it begins.
    """
    from scipy.spatial import cKDTree

    somewhere = np.flatnonzero(np.isfinite(ends[:, 0]))
    count, near = len(ends) - 2, min(NEAR + 2, len(somewhere))
    found = somewhere[cKDTree(ends[somewhere]).query(ends[somewhere], k=near)[1]]
    found[found // 2 == somewhere[:, None] // 2] = -1
    found = np.take_along_axis(found, np.argsort(found < 0, axis=1, kind="stable"), axis=1)
    table = np.full((len(ends), 1 + near), -1, np.int32)
    table[:count, 0] = count
    table[:count, 1:] = found[:count]
    table[somewhere[count:], :-1] = found[count:]
    return table


def _from_depot(tour: NDArray[np.int32], at: NDArray[np.int32]) -> list[tuple[int, bool]]:
    """Cut the closed tour at the depot, and read it from where the tool comes."""
    depot = len(tour) - 1
    place = int(np.flatnonzero(tour == depot)[0])
    way = np.roll(tour, -place) if place % 2 == 0 else np.roll(tour[::-1], place + 1)
    entered = way[1:-1:2]
    return list(zip((entered // 2).tolist(), (at[entered] % 2 == 1).tolist(), strict=True))


def _tour(way: Way, returns: bool) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return the closed tour of a way, and the end at which each node lies, as ``first_tour``."""
    entered = np.array([2 * stroke + backwards for stroke, backwards in way], np.int32)
    inner = np.stack([entered, entered ^ 1], axis=1).ravel()
    last = len(inner)
    at = np.arange(last + 2, dtype=np.int32)
    if returns:
        at[entered] = at[entered ^ 1] = entered
    return np.r_[last + 1, inner, last].astype(np.int32), at
