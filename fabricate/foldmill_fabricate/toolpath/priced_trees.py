"""Least trees over places, some of them joined for nothing, under prices on the places.

A tour is a tree over all places but one, and two more ways to that one. Where every place has a
price, paid twice by a tour and as often as it has ways by a tree, the least tree bounds the tour
(Held and Karp 1970, 1971). Prices are sought over near pairs only, by subgradient steps; what they
prove is then worked out over all pairs, and pairs of that tree that were left out are put in.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

STAGES = 8
"""Times that the prices are tried over all pairs."""
_NEAR = 8
"""Places beside each that are candidates at first."""
_ABOVE = 0.05
"""How far above the bound the tour is taken to be, as a share; it sets the length of the steps."""
_HASTE = 0.005
"""Share of the first step that the last one is long."""
_KEPT = 0.7
"""Share of its last direction that a step keeps."""


@dataclass(frozen=True, eq=False)
class Places:
    """Where a tour must pass."""

    spots: Floats
    """(m, 2, 2) mm: each at one of two points, which may be the same."""
    mates: Indices
    """(m,) the place each is joined to for nothing, or −1."""
    loose: bool
    """Whether the tour may begin anywhere, else at the last place."""

    def gaps(self, one: Indices, other: Indices) -> Floats:
        """Return the least distance (n,) between places, mm; 0 between mates."""
        found = np.full(len(other), np.inf)
        for x, y in self._ways:
            for u, v in self._ways:
                across, up = x[one] - u[other], y[one] - v[other]
                found = np.minimum(found, across * across + up * up)
        found[self.mates[one] == other] = 0.0
        away: Floats = np.sqrt(found)
        return away

    def gaps_from(self, one: int) -> Floats:
        """Return the least distance (m,) of one place from each, mm; mates are not looked for."""
        found = np.full(len(self.mates), np.inf)
        for x, y in self._ways:
            for u, v in self._ways:
                across, up = u - x[one], v - y[one]
                across *= across
                up *= up
                found = np.minimum(found, across + up)
        away: Floats = np.sqrt(found)
        return away

    @cached_property
    def _ways(self) -> list[tuple[Floats, Floats]]:
        """x and y of the first points, and of the others where any place has two."""
        sides = (self.spots[:, 0], self.spots[:, 1])
        return [
            (side[:, 0].copy(), side[:, 1].copy())
            for k, side in enumerate(sides)
            if k == 0 or (side != sides[0]).any()
        ]

    def ends(self, prices: Floats) -> Indices:
        """Return the two places at which the tour ends most cheaply."""
        near = np.argsort(prices, kind="stable")[:2]
        if self.loose:
            return near
        last = len(self.mates) - 1
        return np.array([last, near[0] if near[0] != last else near[1]])

    def value(self, length: float, prices: Floats) -> float:
        """Return what a least tree of this length under prices proves, mm."""
        return length + float(prices[self.ends(prices)].sum()) - 2 * float(prices.sum())


def bound(places: Places, rounds: int) -> float:
    """Return a length, mm, that no way through all places goes below; rounds : of seeking prices.

    At least two places.
    """
    prices, slope = np.zeros(len(places.mates)), np.zeros(len(places.mates))
    pairs, best = _near(places), 0.0
    cuts = np.linspace(0, rounds, STAGES + 1).astype(int).tolist()
    for low, high in pairwise(cuts):
        prices = _sought(places, pairs, prices, slope, (low, high, rounds))
        length, tree = least_tree(places, prices)
        best = max(best, places.value(length, prices))
        pairs = np.unique(np.vstack([pairs, np.sort(tree, axis=1)]), axis=0)
    return best


def _near(places: Places) -> Indices:
    """Return pairs of near places (n, 2), and enough to join all."""
    from scipy.spatial import cKDTree

    count = len(places.mates)
    points = places.spots.reshape(-1, 2)
    near = cKDTree(points).query(points, k=min(2 * _NEAR, len(points)))[1]
    own = np.repeat(np.arange(len(points)), near.shape[1])
    row = np.lexsort(places.spots[:, 0].T)
    mated = np.flatnonzero(places.mates >= 0)
    one = np.r_[own // 2, row[:-1], mated]
    other = np.r_[near.ravel() // 2, row[1:], places.mates[mated]]
    pairs = np.sort(np.stack([one, other], axis=1), axis=1)
    pairs = pairs[(pairs[:, 0] != pairs[:, 1]) & (pairs < count).all(axis=1)]
    found: Indices = np.unique(pairs, axis=0)
    return found


def _sought(
    places: Places, pairs: Indices, prices: Floats, slope: Floats, span: tuple[int, int, int]
) -> Floats:
    """Return the best prices found over these pairs; slope : of the last step, changed in place.

    span : first round, round after the last, and how many there are in all.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import minimum_spanning_tree

    i, j = pairs.T
    gaps, free = places.gaps(i, j), places.mates[i] == j
    starts = np.searchsorted(i, np.arange(len(prices) + 1))
    best, found = -np.inf, prices
    for number in range(*span[:2]):
        ways = gaps + prices[i] + prices[j]
        # The tree routine takes a zero for "no way": all are made longer, those for nothing least.
        shift = float(ways.min()) - 1.0
        cost = np.where(free, 0.5, ways - shift)
        tree = minimum_spanning_tree(csr_array((cost, j, starts), shape=(len(prices),) * 2)).tocoo()
        degree = np.bincount(np.r_[tree.row, tree.col], minlength=len(prices))
        paid = float(tree.data.sum()) + shift * (len(tree.data) - free.sum()) - 0.5 * free.sum()
        paid += float((prices[i] + prices[j])[free].sum())
        off = degree - 2.0
        off[places.ends(prices)] += 1
        value = places.value(paid, prices)
        if value > best:
            best, found = value, prices
        if not off.any():
            break
        slope[:] = (1 - _KEPT) * off + _KEPT * slope
        # Polyak's step towards a tour that is taken to be a little longer than the bound.
        step = _HASTE ** (number / span[2]) * (best + _ABOVE * abs(best) - value)
        prices = prices + step / float(off @ off) * slope
    return found


def least_tree(places: Places, prices: Floats) -> tuple[float, Indices]:
    """Return length and pairs (m − 1, 2) of the least tree that joins all mates (Prim 1957)."""
    count, mates = len(prices), places.mates.tolist()
    near, parent = np.full(count, np.inf), np.zeros(count, np.intp)
    at, left = 0, np.zeros(count)
    left[0] = np.inf
    pairs = np.zeros((count - 1, 2), np.intp)
    total = 0.0
    for k in range(count - 1):
        ways = places.gaps_from(at)
        ways += prices
        ways += prices[at]
        closer = ways < near
        near[closer] = ways[closer]
        parent[closer] = at
        mate = mates[at]
        if mate >= 0 and not left[mate]:
            total += float(prices[at] + prices[mate])
            parent[mate] = at
        else:
            mate = int(np.argmin(near + left))
            total += float(near[mate])
        pairs[k] = parent[mate], mate
        left[mate] = np.inf
        at = mate
    return total, pairs
