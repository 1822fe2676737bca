"""A pattern folded flat: where each facet comes to lie, and which facets lie upon each other.

Facets are the parts of the sheet between its mountains and valleys; flat lines divide nothing.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from foldmill.pattern import Assignment, CreasePattern, Floats, Indices

_ROUNDING = 1e-6
"""Share of the size by which folded facets may miss each other by rounding alone."""
_SLACK = 10.0
"""Times the error of closing: facets that overlap by less only touch."""


@dataclass(frozen=True)
class Crease:
    """A mountain or valley between two facets, in the flat state."""

    edge: int
    left: int
    right: int
    """Facets left and right of it in the sheet."""
    is_valley: bool


@dataclass(frozen=True, eq=False)
class FlatState:
    """The sheet folded flat, without an order of layers."""

    facets: list[Any]
    """A polygon for each facet, folded, drawn in by ``touch``."""
    is_turned: list[bool]
    """Whether each facet shows its back."""
    creases: list[Crease]
    segments: Floats
    """(c, 2, 2) where each crease lies."""
    error: float
    """mm: by how much the folded sheet fails to close."""
    touch: float
    """mm within which things only touch."""


def flat_state(pattern: CreasePattern) -> FlatState:
    """Return a pattern folded flat along all its mountains and valleys."""
    import shapely

    facet = _facets(pattern)
    creases = _creases(pattern, facet)
    maps, turned = _maps(pattern, creases, int(facet.max()) + 1)
    error = _error(pattern, creases, maps)
    touch = max(_ROUNDING * pattern.size, _SLACK * error)
    parts: list[list[Any]] = [[] for _ in maps]
    for corners, owner in zip(pattern.vertices[pattern.faces], facet.tolist(), strict=True):
        parts[owner].append(shapely.Polygon(_moved(maps[owner], corners)))
    whole = [shapely.union_all(own).buffer(-touch, join_style="mitre") for own in parts]
    ends = [_moved(maps[each.left], pattern.vertices[pattern.edges[each.edge]]) for each in creases]
    return FlatState(whole, turned, creases, np.array(ends, float).reshape(-1, 2, 2), error, touch)


def _facets(pattern: CreasePattern) -> Indices:
    """Return the facet (F,) of each triangle."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    flat = pattern.assignments == Assignment.F
    pairs = pattern.edge_faces[flat & (pattern.edge_faces >= 0).all(axis=1)]
    links = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(pattern.faces),) * 2)
    found: Indices = connected_components(links, directed=False)[1].astype(np.intp)
    return found


def _creases(pattern: CreasePattern, facet: Indices) -> list[Crease]:
    found = []
    for edge in np.flatnonzero(np.isin(pattern.assignments, [Assignment.M, Assignment.V])):
        left, right = facet[pattern.edge_faces[edge]].tolist()
        if left != right:
            is_valley = bool(pattern.assignments[edge] == Assignment.V)
            found.append(Crease(int(edge), left, right, is_valley))
    return found


def _maps(
    pattern: CreasePattern, creases: list[Crease], count: int
) -> tuple[list[Floats], list[bool]]:
    """Return how each facet is moved, (3, 2) on rows (x, y, 1), and whether it is turned over."""
    around: list[list[Crease]] = [[] for _ in range(count)]
    for crease in creases:
        around[crease.left].append(crease)
        around[crease.right].append(crease)
    still = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    maps: list[Floats] = [still for _ in range(count)]
    turned, known, waiting = [False] * count, {0}, deque([0])
    while waiting:
        facet = waiting.popleft()
        for crease in around[facet]:
            other = crease.left + crease.right - facet
            if other not in known:
                known.add(other)
                waiting.append(other)
                maps[other] = _reflected(maps[facet], pattern.vertices[pattern.edges[crease.edge]])
                turned[other] = not turned[facet]
    return maps, turned


def _reflected(there: Floats, line: Floats) -> Floats:
    """Return the map that reflects about a line of the sheet first."""
    (x, y), (u, v) = line[0], (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    mirror = np.array([[u * u - v * v, 2 * u * v], [2 * u * v, v * v - u * u]])
    shift = np.array([x, y]) - np.array([x, y]) @ mirror
    both: Floats = np.vstack([mirror @ there[:2], shift @ there[:2] + there[2]])
    return both


def _moved(there: Floats, points: Floats) -> Floats:
    moved: Floats = points @ there[:2] + there[2]
    return moved


def _error(pattern: CreasePattern, creases: list[Crease], maps: list[Floats]) -> float:
    worst = 0.0
    for crease in creases:
        ends = pattern.vertices[pattern.edges[crease.edge]]
        apart = _moved(maps[crease.left], ends) - _moved(maps[crease.right], ends)
        worst = max(worst, float(np.hypot(*apart.T).max()))
    return worst


def overlapping(state: FlatState) -> list[tuple[int, int]]:
    """Return the pairs of facets that lie upon each other, ascending."""
    import shapely

    pairs = shapely.STRtree(state.facets).query(state.facets, predicate="intersects").T
    return sorted({(int(a), int(b)) for a, b in pairs if a < b})


def stacked(state: FlatState, pairs: list[tuple[int, int]]) -> list[tuple[int, int, int]]:
    """Return the triples of facets that lie upon each other at one place."""
    import shapely

    beside: dict[int, set[int]] = {}
    for a, b in pairs:
        beside.setdefault(a, set()).add(b)
    found = []
    for a, b in pairs:
        common = sorted(beside.get(a, set()) & beside.get(b, set()))
        if common:
            shared = shapely.intersection(state.facets[a], state.facets[b])
            meets = shapely.intersects(shared, [state.facets[c] for c in common])
            found += [(a, b, c) for c, does in zip(common, meets.tolist(), strict=True) if does]
    return found


def through(state: FlatState) -> list[tuple[int, int]]:
    """Return (crease, facet) where a crease lies across the inside of a facet not its own."""
    import shapely

    lines = shapely.linestrings(state.segments)
    pairs = shapely.STRtree(state.facets).query(lines, predicate="intersects").T.tolist()
    found = []
    for number, facet in pairs:
        crease = state.creases[number]
        if facet in {crease.left, crease.right}:
            continue
        shared = shapely.intersection(lines[number], state.facets[facet])
        if shapely.length(shared) > state.touch:
            found.append((int(number), int(facet)))
    return sorted(found)


def upon(state: FlatState) -> list[tuple[int, int]]:
    """Return the pairs of creases that lie along each other, their facets on the same side."""
    found = []
    middles = [np.array(facet.representative_point().coords[0]) for facet in state.facets]
    for one, two in combinations(range(len(state.creases)), 2):
        a, b = state.segments[one]
        along = (b - a) / np.hypot(*(b - a))
        off = np.array([-along[1], along[0]])
        ends = state.segments[two] - a
        if np.abs(ends @ off).max() > 2 * state.touch:
            continue
        low, high = sorted((ends @ along).tolist())
        if min(high, float((b - a) @ along)) - max(low, 0.0) <= 4 * state.touch:
            continue
        sides = [_side(state, middles, k, a, off) for k in (one, two)]
        if sides[0] == sides[1]:
            found.append((one, two))
    return found


def _side(state: FlatState, middles: list[Floats], crease: int, a: Floats, off: Floats) -> bool:
    """Tell on which side of a line the facets of a crease lie next to it."""
    import shapely

    own = state.facets[state.creases[crease].left]
    spot = state.segments[crease].mean(axis=0)
    reach = 4 * state.touch
    above, below = (shapely.distance(own, shapely.Point(spot + s * reach * off)) for s in (1, -1))
    if abs(above - below) > state.touch:
        return bool(above < below)
    return bool((middles[state.creases[crease].left] - a) @ off > 0)
