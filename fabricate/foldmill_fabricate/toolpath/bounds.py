"""What no order of strokes can go below: the bound of Held and Karp (1970, 1971).

A tour is a tree over all places but one, and two more ways to that one. Prices on the places, found
by subgradient steps, bring the least such tree close to a tour; it never exceeds it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

DENSE = 1200
"""Places up to which all distances are held at once; beyond, one tree without prices bounds."""
ROUNDS = 150
"""Steps of the prices: on 500 random lines within 1 % of what 1,500 reach."""
_ABOVE = 0.1
"""How far above the bound the tour is taken to be, as a share; it sets the length of the steps."""
_HASTE = 0.02
"""Share of the first step that the last one is long."""


def travel_bound(
    strokes: Sequence[Floats],
    start: Floats | None,
    returns: Sequence[bool] | bool = False,
    rounds: int = ROUNDS,
    dense: int = DENSE,
) -> float:
    """Return a length, mm, that the pen-up moves cannot go below in any order and direction.

    strokes : polylines (n, 2), each once along; start : (2,) where the tool is, None for anywhere;
    returns : of all or each, whether it leaves the tool where it began, at the end of one's choice.
    """
    if not strokes:
        return 0.0
    ends = np.array([[stroke[0], stroke[-1]] for stroke in strokes], float)
    back = np.broadcast_to(np.asarray(returns, bool), (len(ends),))
    if 2 * len(ends) > dense:
        return _tree(ends, start)
    places, mates = _places(ends, back, start)
    gaps = _gaps(places)
    return _held_karp(gaps, mates, start is None, rounds)


def _places(ends: Floats, back: NDArray[np.bool_], start: Floats | None) -> tuple[Floats, Indices]:
    """Return places (m, 2, 2), each at one or two points, and the mate (m,) it is joined to, or -1.

    A stroke that leaves the tool at its other end is two places joined for nothing.
    """
    one = ends[back]
    two = np.repeat(ends[~back].reshape(-1, 1, 2), 2, axis=1)
    mates = np.r_[np.full(len(one), -1), len(one) + (np.arange(len(two)) ^ 1)]
    if start is None:
        return np.concatenate([one, two]), mates.astype(np.intp)
    own = np.broadcast_to(start, (1, 2, 2))
    return np.concatenate([one, two, own]), np.append(mates, -1).astype(np.intp)


def _gaps(places: Floats) -> Floats:
    """Return the least distance (m, m) between the points of two places."""
    gaps = np.full((len(places),) * 2, np.inf)
    for a in (0, 1):
        for b in (0, 1):
            step = places[:, None, a] - places[None, :, b]
            gaps = np.minimum(gaps, np.hypot(step[..., 0], step[..., 1]))
    return gaps


def _held_karp(gaps: Floats, mates: Indices, loose: bool, rounds: int) -> float:
    """Return the bound; ``loose``: the tour may begin anywhere, else at the last place.

    The place left out of the tree is where the tour ends, at no distance from any.
    """
    prices = np.zeros(len(gaps))
    best, slope = -np.inf, np.zeros(len(gaps))
    for number in range(rounds):
        length, degree = _least_tree(gaps, mates, prices)
        near = np.argsort(prices, kind="stable")[:2]
        if not loose:
            last = len(gaps) - 1
            near = np.array([last, near[0] if near[0] != last else near[1]])
        off = degree - 2.0
        off[near] += 1
        value = length + float(prices[near].sum()) - 2 * float(prices.sum())
        best = max(best, value)
        if not off.any():
            break
        slope = 0.7 * off + 0.3 * slope
        # Polyak's step towards a tour that is taken to be a little longer than the bound.
        target = best + _ABOVE * abs(best)
        prices += _HASTE ** (number / rounds) * (target - value) / float(off @ off) * slope
    return max(best, 0.0)


def _least_tree(gaps: Floats, mates: Indices, prices: Floats) -> tuple[float, Indices]:
    """Return length and degrees of the least tree that joins all mates (Prim), under prices."""
    count = len(gaps)
    left = np.ones(count, bool)
    near, parent = np.full(count, np.inf), np.zeros(count, np.intp)
    degree, total, at = np.zeros(count, np.intp), 0.0, 0
    left[0] = False
    for _ in range(count - 1):
        ways = gaps[at] + (prices[at] + prices)
        closer = ways < near
        near = np.where(closer, ways, near)
        parent[closer] = at
        mate = int(mates[at])
        if mate >= 0 and left[mate]:
            total += float(prices[at] + prices[mate])
            parent[mate] = at
        else:
            mate = int(np.argmin(np.where(left, near, np.inf)))
            total += float(near[mate])
        degree[mate] += 1
        degree[parent[mate]] += 1
        left[mate] = False
        at = mate
    return total, degree


def _tree(ends: Floats, start: Floats | None) -> float:
    """Return the length of the least tree over strokes and start, each as one place."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import minimum_spanning_tree
    from scipy.spatial import Delaunay

    points = ends.reshape(-1, 2) if start is None else np.vstack([ends.reshape(-1, 2), start])
    places, same = np.unique(np.round(points, 9), axis=0, return_inverse=True)
    corners = Delaunay(places).simplices
    i, j = np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).T
    own = same[: 2 * len(ends)].reshape(-1, 2)
    gap = np.hypot(*(places[i] - places[j]).T)
    # The tree routine takes a zero for "no edge": a stroke gets a hair instead, taken off again.
    hair = 1e-9
    pairs = np.sort(np.stack([np.r_[i, own[:, 0]], np.r_[j, own[:, 1]]], axis=1), axis=1)
    cost = np.r_[gap, np.full(len(own), hair)]
    order = np.lexsort((cost, pairs[:, 1], pairs[:, 0]))
    pairs, cost = pairs[order], cost[order]
    first = np.r_[True, (np.diff(pairs, axis=0) != 0).any(axis=1)] & (pairs[:, 0] != pairs[:, 1])
    size = (len(places),) * 2
    tree = minimum_spanning_tree(coo_array((cost[first], pairs[first].T), shape=size).tocsr())
    return max(0.0, float(tree.sum()) - hair * len(ends))
