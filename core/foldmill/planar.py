"""Planar graphs: which faces lie between lines, which face lies left of an edge, which loops close.

Pure functions over arrays; they know nothing of creases.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def face_sides(faces: Indices) -> tuple[Indices, Indices]:
    """Return the directed sides (3F, 2) of triangles (F, 3) and the face (3F,) each belongs to."""
    sides = np.stack([faces, faces[:, [1, 2, 0]]], axis=2).reshape(-1, 2)
    return sides, np.repeat(np.arange(len(faces)), 3)


def edge_faces(edges: Indices, faces: Indices) -> Indices:
    """Return (E, 2): the face left and right of each edge, -1 where there is none."""
    sides, owners = face_sides(faces)
    if not len(edges) or not len(faces):
        return np.full((len(edges), 2), -1, np.intp)
    count = int(max(faces.max(), edges.max())) + 1
    keys = _keys(sides, count)
    order = np.argsort(keys, kind="stable")
    wanted = np.stack([_keys(edges, count), _keys(edges[:, ::-1], count)], axis=1)
    # Of faces that claim the same side, the last one has it.
    spot = np.searchsorted(keys[order], wanted, side="right") - 1
    found: Indices = np.where(keys[order][spot] == wanted, owners[order][spot], -1)
    return found


def _keys(pairs: Indices, count: int) -> Indices:
    """Return one number (n,) for each ordered pair (n, 2) of numbers below ``count``."""
    keys: Indices = pairs[:, 0] * count + pairs[:, 1]
    return keys


def unique_pairs(pairs: Indices) -> tuple[Indices, Indices]:
    """Return the unordered pairs among (n, 2), ascending, and where each is first met."""
    if not len(pairs):
        return np.zeros((0, 2), np.intp), np.zeros(0, np.intp)
    count = int(pairs.max()) + 1
    keys = np.minimum(pairs[:, 0], pairs[:, 1]) * count + np.maximum(pairs[:, 0], pairs[:, 1])
    found, first = np.unique(keys, return_index=True)
    return np.column_stack(np.divmod(found, count)), first


def topology_fault(edges: Indices, faces: Indices) -> str | None:
    """Say which face side is no edge or is used twice in one direction; None where all is well."""
    sides, owners = face_sides(faces)
    if not len(sides):
        return None
    count = int(max(sides.max(), edges.max(initial=0))) + 1
    is_edge = np.isin(_keys(np.sort(sides, axis=1), count), _keys(np.sort(edges, axis=1), count))
    is_repeated = np.ones(len(sides), bool)
    is_repeated[np.unique(_keys(sides, count), return_index=True)[1]] = False
    wrong = np.flatnonzero(~is_edge | is_repeated)
    if not len(wrong):
        return None
    (a, b), face = sides[wrong[0]], owners[wrong[0]]
    if not is_edge[wrong[0]]:
        return f"face {face} has the side {a}-{b}, which is no edge"
    return f"face {face} overlaps another face along the edge {a}-{b}"


def polygons(points: Floats, edges: Indices) -> list[list[int]]:
    """Return the bounded faces of a planar straight-line graph, counter-clockwise.

    points : (V, 2); edges : (E, 2), not crossing between vertices.
    Each half-edge is followed by the next one clockwise about its head.
    """
    found = _walks(points, edges)
    areas = signed_areas(points, found).tolist()
    return [loop for loop, area in zip(found, areas, strict=True) if area > 0]


def _walks(points: Floats, edges: Indices) -> list[list[int]]:
    """Return the vertices along every closed walk of half-edges, each turning right where it can.

    Walks begin with the edges of the vertex that is named first.
    """
    tails, following = _next_half_edges(points, edges)
    is_open = [True] * len(tails)
    found: list[list[int]] = []
    for start in range(len(tails)):
        loop, half_edge = [], start
        while is_open[half_edge]:
            is_open[half_edge] = False
            loop.append(tails[half_edge])
            half_edge = following[half_edge]
        if loop:
            found.append(loop)
    return found


def _next_half_edges(points: Floats, edges: Indices) -> tuple[list[int], list[int]]:
    """Return the tail of each half-edge, and the half-edge that follows it clockwise at its head.

    They are listed by their heads, as those are first named, and about each by angle.
    """
    halves = np.stack([edges, edges[:, ::-1]], axis=1).reshape(-1, 2)
    if not len(halves):
        return [], []
    named, first = np.unique(halves[:, 0], return_index=True)
    rank = np.zeros(named[-1] + 1, np.intp)
    rank[named] = np.argsort(np.argsort(first))
    steps = points[halves[:, 1]] - points[halves[:, 0]]
    angles = np.arctan2(steps[:, 1], steps[:, 0])
    order = np.lexsort((halves[:, 1], angles, rank[halves[:, 0]]))
    at, to = halves[order].T
    begins = np.flatnonzero(np.append(True, at[1:] != at[:-1]))
    before = np.arange(len(at)) - 1
    before[begins] = np.append(begins[1:], len(at)) - 1
    # The half-edge to→at is followed by at→to of the spoke before, which stands where its twin is.
    place = np.zeros(len(at), np.intp)
    place[order] = np.arange(len(at))
    twin = place[order ^ 1]
    following = twin[before]
    return to.tolist(), following.tolist()


def signed_area(loop: Floats) -> float:
    """Return the area of a closed loop (n, 2), positive counter-clockwise."""
    x, y = loop[:, 0], loop[:, 1]
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def signed_areas(points: Floats, loops: list[list[int]]) -> Floats:
    """Return the area (n,) of each closed loop of vertices, positive counter-clockwise."""
    sizes = np.array([len(loop) for loop in loops], np.intp)
    areas = np.zeros(len(loops))
    for size in np.unique(sizes).tolist():
        same = np.flatnonzero(sizes == size)
        x, y = points[np.array([loops[k] for k in same.tolist()], np.intp)].transpose(2, 0, 1)
        ahead, above = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
        areas[same] = 0.5 * ((x * above).sum(axis=1) - (y * ahead).sum(axis=1))
    return areas


def loops(points: Floats, edges: Indices) -> list[Indices]:
    """Chain edges (E, 2) into closed loops, counter-clockwise, the largest area first.

    Edges that close no loop are left out. At a vertex where loops touch, the chain turns right, so
    that loops do not cross.
    """
    found = _walks(points, edges)
    areas = signed_areas(points, found).tolist()
    chains = [
        np.array(chain, np.intp)
        for chain, area in zip(found, areas, strict=True)
        if len(chain) > 2 and area > 0
    ]
    return sorted(chains, key=lambda chain: -signed_area(points[chain]))
