"""The moves with the tool up: matched at the least distance, exchanged where tours must meet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import matching

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

EXACT = 2000
"""Up to so many ends they are matched as one; beyond that in the clusters that neighbours make."""
_CLUSTER = 3
"""Neighbours that are candidates beyond EXACT, at first; ends left over get more."""


def match(places: Floats) -> tuple[Indices, float]:
    """Match ends in pairs at the least distance; return the pairs (n / 2, 2) and the distance, mm.

    places : (n, 2) mm, the last two the depot: where the tour ends, which is anywhere (nan), and
    where it begins, anywhere too or a place. The two are not matched with each other.
    """
    count = len(places) - 2
    if count > EXACT:
        return _match_clusters(places)
    near = matching.NEIGHBOURS
    while True:
        i, j, cost = matching.neighbours(places[:-2], near)
        anyone = np.arange(count)
        i = np.concatenate([i, anyone, anyone])
        j = np.concatenate([j, np.full(count, count), np.full(count, count + 1)])
        away = np.nan_to_num(np.hypot(*(places[:-2] - places[-1]).T))
        cost = np.concatenate([cost, np.zeros(count), away])
        pairs = matching.cheapest(count + 2, i, j, cost)
        if 2 * len(pairs) == count + 2:
            return pairs, float(np.nan_to_num(_apart(places, *pairs.T)).sum())
        near *= 2


def _match_clusters(places: Floats) -> tuple[Indices, float]:
    """Match many ends, cluster by cluster, then what is left; the depot takes the best link."""
    left, near, found = np.arange(len(places) - 2), _CLUSTER, []
    while len(left):
        pairs = _clusters(places[left], min(near, len(left) - 1))
        found.append(left[pairs])
        left = np.delete(left, pairs.ravel())
        near *= 2
    table = np.vstack(found)
    gap = _apart(places, *table.T)
    total = float(gap.sum())
    both = np.vstack([table, table[:, ::-1]])
    away = np.nan_to_num(np.hypot(*(places[both[:, 0]] - places[-1]).T))
    best = int(np.argmin(away - np.r_[gap, gap]))
    one, other = both[best]
    table = np.delete(table, best % len(table), axis=0)
    depot = len(places) - 2
    return np.vstack([table, [[one, depot + 1], [other, depot]]]), total


def _clusters(places: Floats, near: int) -> Indices:
    """Match points (n, 2) that are linked by being neighbours, each such cluster on its own."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    i, j, cost = matching.neighbours(places, near)
    size = (len(places),) * 2
    label = connected_components(coo_array((np.ones(len(i)), (i, j)), shape=size))[1]
    order = np.argsort(label[i], kind="stable")
    cuts = np.flatnonzero(np.diff(label[i][order])) + 1
    found = []
    for group in np.split(order, cuts):
        members, local = np.unique(np.r_[i[group], j[group]], return_inverse=True)
        one, other = local.reshape(2, -1)
        found.append(members[matching.cheapest(len(members), one, other, cost[group])])
    return np.vstack(found)


def _apart(places: Floats, one: Indices, other: Indices) -> Floats:
    apart: Floats = np.hypot(*(places[one] - places[other]).T)
    return apart


def exchanges(
    places: Floats, partner: Indices, tour: Indices, vertices: Indices, near: int
) -> tuple[Indices, Indices, Floats]:
    """Return pairs of ends of different tours that might be linked, and the distance that adds.

    Of a tour with hops only these are exchanged: it then needs no more strokes than before.
    """
    from scipy.spatial import cKDTree

    own = tour[np.arange(len(partner)) // 2]
    hop = vertices != vertices[partner]
    with_hop = np.zeros(int(tour.max()) + 1, bool)
    with_hop[own[hop]] = True
    ends = np.flatnonzero((hop | ~with_hop[own]) & np.isfinite(places[:, 0]))
    near = min(near, len(ends) - 1)
    found = ends[cKDTree(places[ends]).query(places[ends], k=near + 1)[1]]
    one, other = np.repeat(ends, near + 1), found.ravel()
    loose = np.flatnonzero(~np.isfinite(places[:, 0]))
    for end in loose:  # where the tour may begin or end anywhere, it may do so at any end
        one, other = np.r_[one, ends], np.r_[other, np.full(len(ends), end)]
    apart = own[one] != own[other]
    one, other = one[apart], other[apart]
    p, q = partner[one], partner[other]

    def gap(a: Indices, b: Indices) -> Floats:
        return np.asarray(np.nan_to_num(_apart(places, a, b)))

    return one, other, gap(one, other) + gap(p, q) - gap(one, p) - gap(other, q)
