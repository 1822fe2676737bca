"""Join the edges of a planar graph to strokes, and order them: one tour with the shortest hops.

At every vertex edges are paired by what the corner costs; the ends left over at odd vertices are
matched at the least total distance (the Chinese postman's way: Edmonds and Johnson 1973); the
closed tours that this makes are joined into one by the cheapest exchanges. The tour is cut where
the tool is up. For a tool that turns for nothing and a drawing in one piece this is exact: as few
strokes as can be, and no shorter travel with so few.

Of a drawing in several pieces the strokes are ordered as separate ones (``sequence``), so that
hops matter only inside large pieces: where a piece has few odd vertices, the ends of each way are
linked with each other, and nothing is matched.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import corners as corner
from foldmill_fabricate.toolpath import hops, pieces, proven, sequence, tours
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
    """mm by which the hops may be longer than the least there are: in one piece, before strokes are
    joined, and 0 where their matching is proved to be the best of all; in several, as ordered."""


def route(points: Floats, edges: Indices, start: Floats | None, corners: Corners) -> Route:
    """Return strokes over all edges, in order, the tool coming from ``start``.

    points : (V, 2) mm; edges : (E, 2), each to be drawn once, none without length; start : (2,) mm,
    or None where the way to the first stroke does not count. The same drawing gives the same
    strokes, in whatever order and direction its edges are given and its vertices are numbered.
    """
    if not len(edges):
        return Route((), 0.0)
    listed = np.lexsort((points[:, 1], points[:, 0]))
    number = np.argsort(listed)
    sides = np.sort(number[edges], axis=1)
    found = _route(points[listed], sides[np.lexsort(sides.T[::-1])], start, corners)
    vertex = listed.tolist()
    trails = tuple(tuple(vertex[place] for place in trail) for trail in found.trails)
    return replace(found, trails=trails)


def _route(points: Floats, edges: Indices, start: Floats | None, corners: Corners) -> Route:
    """Return the strokes over edges that are listed by their places."""
    links = _Links(points, edges, start, corners)
    own = pieces.labels(edges)
    if own.max():
        return _in_pieces(links, own, points, start)
    hopped = links.match_hops()
    links.join_at_vertices()
    links.join_by_hops()
    return Route(tuple(links.trails()), hopped.bound, hopped.length - hopped.bound)


def _in_pieces(links: _Links, own: Indices, points: Floats, start: Floats | None) -> Route:
    """Return the route over a drawing in several pieces; own : (E,) the piece of each edge."""
    left = links.left()
    bound = proven.least(links.places[np.r_[left, links.depot, links.depot + 1]])
    few = pieces.with_few_ends(left, own)
    links.link_own_ends(few)
    links.match_hops()
    links.join_at_vertices(loops_only=len(few) == len(left))
    if len(few) < len(left) or links.loops().any():
        links.join_by_hops()
    order = _sorted(points, _by_place(points, links.trails()), start)
    ways = np.array([points[[trail[0], trail[-1]]] for trail in order])
    plain = [(k, False) for k in range(len(order))]
    return Route(tuple(order), bound, sequence.travelled(ways, start, plain, returns=False) - bound)


def _by_place(points: Floats, trails: list[tuple[int, ...]]) -> list[tuple[int, ...]]:
    """Return strokes by where they lie, whatever order and direction they were drawn in.

    Of hops that are equally short the first is taken: then those side by side follow each other.
    """
    place = points.tolist()
    turned = [min(trail, trail[::-1], key=lambda way: place[way[0]]) for trail in trails]
    return sorted(turned, key=lambda way: (place[way[0]], place[way[-1]]))


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

    def left(self) -> Indices:
        """Return the ends that are linked with none yet, but for the depot's."""
        return np.flatnonzero(self.partner[:-2] < 0)

    def loops(self) -> NDArray[np.bool_]:
        """Return of each tour whether the tool never hops in it."""
        return pieces.loops(self.partner, self.vertices)

    def link_own_ends(self, left: Indices) -> None:
        """Link both ends of each way that begins at these."""
        self.partner[left] = pieces.other_ends(left, self.partner)

    def match_hops(self) -> proven.Matched:
        """Link what is left over at odd vertices and the depot."""
        left = self.left()
        if not len(left):
            self.partner[-2:] = self.depot + 1, self.depot
            return proven.Matched(np.zeros((0, 2), np.intp), 0.0, 0.0)
        ends = np.r_[left, self.depot, self.depot + 1]
        found = _matched(self.places[ends])
        one, other = ends[found.pairs].T
        self.partner[one], self.partner[other] = other, one
        return found

    def join_at_vertices(self, *, loops_only: bool = False) -> None:
        """Join tours that pass the same vertex, where exchanging their links costs least.

        loops_only : whether two that both have hops are left apart.
        """
        for _ in range(_ROUNDS):
            tour = tours.labels(self.partner)
            if not tour.max():
                return
            one, other = _meeting(self.vertices[:-2], tour)
            if loops_only:
                loop = self.loops()
                kept = loop[tour[one // 2]] | loop[tour[other // 2]]
                one, other = one[kept], other[kept]
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
        """Join what is left: drawings in several pieces. A loop is opened at one place only."""
        near = 8
        while True:
            tour = tours.labels(self.partner)
            if not tour.max():
                return
            one, other, gain = hops.exchanges(self.places, self.partner, tour, self.vertices, near)
            changed = tours.exchange(self.partner, tour, one, other, gain, once=self.loops())
            self.down[np.concatenate(changed)] = False
            near = near if len(changed[0]) else 4 * near

    def trails(self) -> list[tuple[int, ...]]:
        """Walk the tours, that of the depot first, and cut them where the tool is up."""
        tour = tours.labels(self.partner)
        hopped = np.flatnonzero(self.vertices != self.vertices[self.partner])
        first = hopped[np.unique(tour[hopped // 2], return_index=True)[1]]
        own = int(tour[self.depot // 2])
        starts = [end for end in first.tolist() if tour[end // 2] != own]
        links, at = self.partner.tolist(), self.vertices.tolist()
        found = self._cut(tours.walk(links, self.depot + 1), at)
        for end in starts:
            found += self._cut([end, *tours.walk(links, end ^ 1)], at)
        return found

    def _cut(self, entered: list[int], at: list[int]) -> list[tuple[int, ...]]:
        """Return the vertices along each stroke of a tour; entered : ends, from a hop on."""
        found: list[tuple[int, ...]] = []
        trail: list[int] = []
        for end in entered:
            if trail and not self.down[end]:
                found.append(tuple(trail))
                trail = []
            trail = trail or [at[end]]
            trail.append(at[end ^ 1])
        return [*found, tuple(trail)] if trail else found


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
