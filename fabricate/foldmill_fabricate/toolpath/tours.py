"""Closed tours over edges: how links make them, and how links are exchanged to make one of many.

Terminology: edge e has two *ends*, 2e and 2e + 1. A *link* joins two ends: the tool leaves one edge
and goes on along the other. Every end has exactly one link, so links and edges together are closed
tours. Exchanging one link of a tour with one of another, either way round, makes one tour of both.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Partners = Indices
"""(2E,) for each end the end it is linked with."""


def labels(partner: Partners) -> Indices:
    """Return which tour (E,) each edge is part of."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = len(partner) // 2
    i, j = np.arange(2 * count) // 2, partner // 2
    links = coo_array((np.ones(2 * count), (i, j)), shape=(count, count))
    label: Indices = connected_components(links, directed=False)[1].astype(np.intp)
    return label


def exchange(
    partner: Partners,
    tour: Indices,
    one: Indices,
    other: Indices,
    gain: Floats,
    once: NDArray[np.bool_] | None = None,
) -> tuple[Indices, Indices]:
    """Join tours, in place, by the exchanges that cost least; return the ends that were linked.

    one, other : (n,) ends that may be linked with each other, their old partners likewise;
    gain : (n,) what that costs more than before; once : of each tour, whether no more than one of
    its links is exchanged. Each link is exchanged at most once.
    """
    group = list(range(int(tour.max()) + 1))
    done: list[tuple[int, int]] = []
    used: set[int] = set()
    opened: set[int] = set()
    only = set() if once is None else set(np.flatnonzero(once).tolist())
    for k in np.argsort(gain, kind="stable").tolist():
        a, b = int(one[k]), int(other[k])
        here, there = int(tour[a // 2]), int(tour[b // 2])
        p, q = _root(group, here), _root(group, there)
        if p == q or a in used or b in used or {here, there} & opened:
            continue
        opened |= {here, there} & only
        c, d = int(partner[a]), int(partner[b])
        group[p] = q
        used |= {a, b, c, d}
        partner[a], partner[b], partner[c], partner[d] = b, a, d, c
        done += [(a, b), (c, d)]
    table = np.array(done, np.intp).reshape(-1, 2)
    return table[:, 0], table[:, 1]


def _root(group: list[int], k: int) -> int:
    while group[k] != k:
        group[k] = group[group[k]]
        k = group[k]
    return k


def walk(links: list[int], start: int) -> list[int]:
    """Return the ends at which edges are entered, along the tour that leaves by ``start``.

    links : the partner of each end. The edge of ``start`` itself is not among the ends.
    """
    found, end = [], links[start]
    while end // 2 != start // 2:
        found.append(end)
        end = links[end ^ 1]
    return found
