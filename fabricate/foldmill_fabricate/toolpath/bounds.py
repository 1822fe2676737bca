"""What no order of strokes can go below: the bound of Held and Karp (1970, 1971).

A tour is a tree over all places but one, and two more ways to that one. Prices on the places bring
the least such tree close to a tour (``priced_trees``); it never exceeds it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import priced_trees

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

DENSE = 2400
"""Places up to which prices are sought; beyond, where the time for all pairs would be felt, one
tree without prices bounds."""
ROUNDS = 400
"""Steps of the prices: on 500 and 1,000 random lines within 0.2 % of what 2,000 reach."""
SOON = 160
"""Steps for two or three places; others get four more each, up to ROUNDS."""


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
    spots, mates = _places(ends, back, start)
    if len(mates) < 2:  # one stroke that returns
        return 0.0
    places = priced_trees.Places(spots, mates, start is None)
    return priced_trees.bound(places, min(rounds, SOON + 4 * len(mates)))


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


def _tree(ends: Floats, start: Floats | None) -> float:
    """Return the length of the least tree over strokes and start, each as one place."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import minimum_spanning_tree

    points = ends.reshape(-1, 2) if start is None else np.vstack([ends.reshape(-1, 2), start])
    places, same = np.unique(np.round(points, 9), axis=0, return_inverse=True)
    i, j = _beside(places).T
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


def _beside(places: Floats) -> Indices:
    """Return pairs (n, 2) of places among which those of the least tree are."""
    from scipy.spatial import Delaunay, QhullError

    try:
        corners = Delaunay(places).simplices
    except QhullError:  # all on one line, or too few: from each to the next
        row = np.lexsort(places.T)
        return np.stack([row[:-1], row[1:]], axis=1)
    found: Indices = np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    return found
