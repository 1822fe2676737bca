"""Hops matched at the least distance of all, and the proof that there is no less.

The hops are matched among near ends first. Prices then bound what any matching costs; a pair that
would cost more beyond its prices than the matching found is above the bound is in no better one.
The few pairs that are left are matched exactly: that is the best matching of all pairs there are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import matching, prices

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST = 2000
"""Ends up to which hops are matched with proof; beyond, matching and prices take too long."""
_ALL = 100
"""Up to so many ends all pairs are matched at once."""
_PRICED = 6
"""Neighbours of each end for which prices are sought first; pairs that break them are added."""
_SURE = 1e-6
"""mm more than asked for, because matching counts in whole millionths."""
_LIMIT = 60
"""Pairs per end beyond which matching them all takes too long, and the gap is told instead."""


@dataclass(frozen=True, eq=False)
class Matched:
    """Hops, and how sure it is that none are shorter in all."""

    pairs: Indices
    """(n / 2, 2) ends."""
    length: float
    """mm in all."""
    bound: float
    """mm that no matching goes below; ``length`` where it is proved to be the least."""


def match(places: Floats, rounds: int = prices.ROUNDS) -> Matched:
    """Match ends in pairs at the least distance.

    places : (n, 2) mm, n even and at least 4; the last two are the depot: where the tour ends,
    which is anywhere (nan), and where it begins, anywhere too or a place. The two are not matched
    with each other.
    """
    cost = _costs(places)
    near = matching.NEIGHBOURS if len(cost) > _ALL else len(cost)
    while True:
        pairs = _cheapest(cost, *_near(places, near))
        if 2 * len(pairs) == len(cost):
            break
        near *= 2
    length = _length(cost, pairs)
    if near >= len(cost) - 3:  # every pair was a candidate
        return Matched(pairs, length, length)
    first = np.stack(matching.nearest(places[:-2], _PRICED)[:2], axis=1)
    i, j = np.unique(np.vstack([first, pairs]), axis=0).T
    found = prices.bound(cost, i, j, length, rounds)
    return _rematched(cost, pairs, length, found)


def _rematched(cost: Floats, pairs: Indices, length: float, found: prices.Bound) -> Matched:
    """Match the pairs that may be part of a better matching, unless they are too many."""
    i, j = np.nonzero(np.triu(found.spare <= length - found.least + _SURE, 1))
    if len(i) > _LIMIT * len(cost):
        return Matched(pairs, length, found.least)
    both = np.unique(np.vstack([np.stack([i, j], axis=1), pairs]), axis=0)
    best = _cheapest(cost, *both.T)
    return Matched(best, _length(cost, best), _length(cost, best))


def _costs(places: Floats) -> Floats:
    """Return the distance (n, n) of every pair that may be made, else inf."""
    step = places[:, None] - places[None, :]
    cost: Floats = np.nan_to_num(np.hypot(step[..., 0], step[..., 1]), nan=0.0)
    np.fill_diagonal(cost, np.inf)
    cost[-1, -2] = cost[-2, -1] = np.inf
    return cost


def _near(places: Floats, count: int) -> tuple[Indices, Indices]:
    """Return pairs i < j of near ends, and of every end and the depot."""
    i, j, _ = matching.nearest(places[:-2], count)
    ends = np.arange(len(places) - 2)
    depot = np.repeat([len(ends), len(ends) + 1], len(ends))
    return np.r_[i, ends, ends], np.r_[j, depot]


def _cheapest(cost: Floats, i: Indices, j: Indices) -> Indices:
    return matching.cheapest(len(cost), i, j, cost[i, j])


def _length(cost: Floats, pairs: Indices) -> float:
    return float(cost[pairs[:, 0], pairs[:, 1]].sum())


def least(places: Floats) -> float:
    """Return what hops between ends cannot go below without more ado: to the nearest, by halves.

    places : (n, 2) mm, the last two the depot. Every end but two is hopped to or from.
    """
    from scipy.spatial import cKDTree

    ends = places[:-2]
    if len(ends) < 4:
        return 0.0
    near = np.sort(cKDTree(ends).query(ends, k=2)[0][:, 1])
    return float(near[:-2].sum()) / 2
