"""Join the edges of a planar graph to strokes, and order them: one tour with the shortest hops.

At every vertex edges are paired by what the corner costs; the ends left over at odd vertices are
matched at the least total distance (the Chinese postman's way: Edmonds and Johnson 1973); the
closed tours that this makes are joined into one by the cheapest exchanges. The tour is cut where
the tool is up. For a tool that turns for nothing and a drawing in one piece this is exact: as few
strokes as can be, and no shorter travel with so few.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import corners as corner
from foldmill_fabricate.toolpath import hops, proven, sequence, tours
from foldmill_fabricate.toolpath.corners import Corners

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ROUNDS = 60
"""Each round at least halves the tours that can be joined at a vertex."""


@dataclass(frozen=True, eq=False)
class Route:
    """Strokes in order of work, and what no order can go below."""

    trails: tuple[tuple[int, ...], ...]
    """Vertices along each stroke; a closed one repeats its first."""
    bound: float
    """mm of travel that no order of as few strokes goes below."""
    gap: float = 0.0
    """mm by which the hops between strokes may be longer than the least there are, before strokes
    are joined; 0 where their matching is proved to be the best of all."""


def route(points: Floats, edges: Indices, start: Floats | None, corners: Corners) -> Route:
    """Return strokes over all edges, in order, the tool coming from ``start``.

    points : (V, 2) mm; edges : (E, 2), each to be drawn once, none without length; start : (2,) mm,
    or None where the way to the first stroke does not count.
    """
    if not len(edges):
        return Route((), 0.0)
    links = _Links(points, edges, start, corners)
    hopped = links.match_hops()
    links.join_at_vertices()
    links.join_by_hops()
    found = links.trails()
    order = found if _is_in_one_piece(edges) else _sorted(points, found, start)
    return Route(tuple(order), hopped.bound, hopped.length - hopped.bound)


def _is_in_one_piece(edges: Indices) -> bool:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    names, at = np.unique(edges, return_inverse=True)
    links = coo_array((np.ones(len(edges)), at.reshape(-1, 2).T), shape=(len(names),) * 2)
    return bool(connected_components(links, directed=False)[0] == 1)


def _sorted(
    points: Floats, trails: list[tuple[int, ...]], start: Floats | None
) -> list[tuple[int, ...]]:
    """Order strokes of a drawing in several pieces as separate ones, where that is shorter."""
    ends = np.array([points[[trail[0], trail[-1]]] for trail in trails])
    found = min(
        sequence.order(ends, start),
        [(k, False) for k in range(len(trails))],
        key=lambda way: sequence.travelled(ends, start, way, returns=False),
    )
    return [trails[k][::-1] if backwards else trails[k] for k, backwards in found]


class _Links:
    """The links between edge ends; the last edge is the depot, from where the tool comes."""

    def __init__(
        self, points: Floats, edges: Indices, start: Floats | None, corners: Corners
    ) -> None:
        self.corners = corners
        self.edges = edges
        at = edges.ravel()
        step = points[edges[:, 1]] - points[edges[:, 0]]
        angle = np.degrees(np.arctan2(step[:, 1], step[:, 0]))
        self.spokes = np.stack([angle, angle + 180], axis=1).ravel()
        self.depot = len(at)
        """The end at which the tour ends, anywhere; the next one is where the tool comes from."""
        self.vertices = np.r_[at, -1, -2]
        nowhere = np.full(2, np.nan)
        self.places = np.vstack([points[at], nowhere, nowhere if start is None else start])
        self.partner = np.r_[corner.pair(at, self.spokes, corners), -1, -1]
        self.down = np.zeros(len(self.partner), bool)
        paired = np.flatnonzero(self.partner[:-2] >= 0)
        self._set_down(paired, self.partner[paired], corners.forced)

    def _turns(self, one: Indices, other: Indices) -> Floats:
        return corner.bends(self.spokes[one], self.spokes[other])

    def _set_down(self, one: Indices, other: Indices, forced: bool) -> None:
        """Decide for linked ends whether the tool stays down between them."""
        here = self.vertices[one] == self.vertices[other]
        stays = here.copy()
        if not forced:
            turn = self.corners.turn(self._turns(one[here], other[here]))
            stays[here] = turn <= self.corners.lift
        self.down[one] = self.down[other] = stays

    def match_hops(self) -> proven.Matched:
        """Link what is left over at odd vertices and the depot."""
        left = np.flatnonzero(self.partner[:-2] < 0)
        if not len(left):
            self.partner[-2:] = self.depot + 1, self.depot
            return proven.Matched(np.zeros((0, 2), np.intp), 0.0, 0.0)
        ends = np.r_[left, self.depot, self.depot + 1]
        found = _matched(self.places[ends])
        one, other = ends[found.pairs].T
        self.partner[one], self.partner[other] = other, one
        return found

    def join_at_vertices(self) -> None:
        """Join tours that pass the same vertex, where exchanging their links costs least."""
        for _ in range(_ROUNDS):
            tour = tours.labels(self.partner)
            if not tour.max():
                return
            one, other = _meeting(self.vertices[:-2], tour)
            gain = self._gain(one, other)
            changed = tours.exchange(self.partner, tour, one, other, gain)
            if not len(changed[0]):
                return
            self._set_down(*changed, forced=False)

    def _gain(self, one: Indices, other: Indices) -> Floats:
        """Return what it costs to link these ends, and their partners, instead."""
        p, q = self.partner[one], self.partner[other]
        new = self._cost(one, other) + self._cost(p, q)
        return new - self._cost(one, p) - self._cost(other, q)

    def _cost(self, one: Indices, other: Indices) -> Floats:
        """Return the cost of links as far as vertices are concerned: hops stay as they are."""
        cost = np.zeros(len(one))
        here = self.vertices[one] == self.vertices[other]
        cost[here] = self.corners.best(self._turns(one[here], other[here]))
        return cost

    def join_by_hops(self) -> None:
        """Join what is left: drawings in several pieces."""
        near = 8
        while True:
            tour = tours.labels(self.partner)
            if not tour.max():
                return
            one, other, gain = hops.exchanges(self.places, self.partner, tour, self.vertices, near)
            changed = tours.exchange(self.partner, tour, one, other, gain)
            self.down[np.concatenate(changed)] = False
            near = near if len(changed[0]) else 4 * near

    def trails(self) -> list[tuple[int, ...]]:
        """Walk the tour from the depot, and cut it where the tool is up."""
        at = self.vertices.tolist()
        found: list[tuple[int, ...]] = []
        trail: list[int] = []
        for end in tours.walk(self.partner, self.depot + 1):
            if trail and not self.down[end]:
                found.append(tuple(trail))
                trail = []
            trail = trail or [at[end]]
            trail.append(at[end ^ 1])
        return [*found, tuple(trail)]


def _matched(places: Floats) -> proven.Matched:
    if len(places) - 2 <= proven.MOST:
        return proven.match(places)
    pairs, length = hops.match(places)
    return proven.Matched(pairs, length, proven.least(places))


def _meeting(vertices: Indices, tour: Indices) -> tuple[Indices, Indices]:
    """Return pairs of edge ends that lie at one vertex and belong to different tours."""
    order = np.argsort(vertices, kind="stable")
    sorted_, own = vertices[order], np.repeat(tour, 2)[: len(vertices)]
    found = [(order[:0], order[:0])]
    for gap in range(1, int(np.bincount(vertices).max())):
        same = np.flatnonzero(sorted_[gap:] == sorted_[:-gap])
        one, other = order[same], order[same + gap]
        apart = own[one] != own[other]
        found.append((one[apart], other[apart]))
    one, other = (np.concatenate(side) for side in zip(*found, strict=True))
    return one, other
