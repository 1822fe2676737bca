"""Planar graphs: which faces lie between lines, which face lies left of an edge, which loops close.

Pure functions over arrays; they know nothing of creases.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidPattern
from foldmill.tolerances import ON_LINE

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def face_sides(faces: Indices) -> tuple[Indices, Indices]:
    """Return the directed sides (3F, 2) of triangles (F, 3) and the face (3F,) each belongs to."""
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    return sides, np.repeat(np.arange(len(faces)), 3)


def edge_faces(edges: Indices, faces: Indices) -> Indices:
    """Return (E, 2): the face left and right of each edge, -1 where there is none."""
    sides, owners = face_sides(faces)
    left_of = {(int(a), int(b)): int(f) for (a, b), f in zip(sides, owners, strict=True)}
    pairs = [(left_of.get((a, b), -1), left_of.get((b, a), -1)) for a, b in edges.tolist()]
    return np.array(pairs, np.intp).reshape(-1, 2)


def topology_fault(edges: Indices, faces: Indices) -> str | None:
    """Say which face side is no edge or is used twice in one direction; None where all is well."""
    sides, owners = face_sides(faces)
    known = {(int(a), int(b)) for a, b in np.sort(edges, axis=1)}
    seen: set[tuple[int, int]] = set()
    for (a, b), face in zip(sides.tolist(), owners.tolist(), strict=True):
        if (min(a, b), max(a, b)) not in known:
            return f"face {face} has the side {a}-{b}, which is no edge"
        if (a, b) in seen:
            return f"face {face} overlaps another face along the edge {a}-{b}"
        seen.add((a, b))
    return None


def polygons(points: Floats, edges: Indices) -> list[list[int]]:
    """Return the bounded faces of a planar straight-line graph, counter-clockwise.

    points : (V, 2); edges : (E, 2), not crossing between vertices.
    Each half-edge is followed by the next one clockwise about its head.
    """
    turn = _next_half_edge(points, edges)
    found: list[list[int]] = []
    open_half_edges = set(turn)
    for start in list(turn):
        if start not in open_half_edges:
            continue
        loop, half_edge = [], start
        while half_edge in open_half_edges:
            open_half_edges.discard(half_edge)
            loop.append(half_edge[0])
            half_edge = turn[half_edge]
        if signed_area(points[loop]) > 0:
            found.append(loop)
    return found


def _next_half_edge(points: Floats, edges: Indices) -> dict[tuple[int, int], tuple[int, int]]:
    around: dict[int, list[tuple[float, int]]] = {}
    for a, b in edges.tolist():
        for tail, head in ((a, b), (b, a)):
            step = points[head] - points[tail]
            around.setdefault(tail, []).append((float(np.arctan2(step[1], step[0])), head))
    turn: dict[tuple[int, int], tuple[int, int]] = {}
    for vertex, spokes in around.items():
        heads = [head for _, head in sorted(spokes)]
        for k, head in enumerate(heads):
            turn[(head, vertex)] = (vertex, heads[k - 1])
    return turn


def signed_area(loop: Floats) -> float:
    """Return the area of a closed loop (n, 2), positive counter-clockwise."""
    x, y = loop[:, 0], loop[:, 1]
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def triangulate(points: Floats, loops: list[list[int]]) -> tuple[Indices, Indices, Indices]:
    """Cut simple polygons into triangles without new vertices.

    Returns faces (F, 3), the polygon (F,) each is part of, and the added edges (A, 2). Raises
    InvalidPattern for a polygon whose lines cross.
    """
    faces: list[tuple[int, ...]] = []
    owners: list[int] = []
    extra: list[tuple[int, int]] = []
    for number, loop in enumerate(loops):
        triangles = [tuple(loop)] if len(loop) == 3 else _cut_polygon(points, loop)
        faces += triangles
        owners += [number] * len(triangles)
        rim = {frozenset(side) for side in zip(loop, loop[1:] + loop[:1], strict=True)}
        sides = {frozenset((t[k - 1], t[k])) for t in triangles for k in range(3)}
        inner = sorted((min(side), max(side)) for side in sides - rim)
        extra += inner
    return (
        np.array(faces, np.intp).reshape(-1, 3),
        np.array(owners, np.intp),
        np.array(extra, np.intp).reshape(-1, 2),
    )


def _cut_polygon(points: Floats, loop: list[int]) -> list[tuple[int, ...]]:
    import shapely

    # Ties, as in a square, are decided by the first corner; so begin where every caller would.
    first = loop.index(min(loop))
    loop = loop[first:] + loop[:first]
    index = {tuple(points[k]): k for k in loop}
    try:
        cut = shapely.constrained_delaunay_triangles(shapely.Polygon(points[loop]))
        corners = [shapely.get_coordinates(part.exterior)[:3] for part in cut.geoms]
        triangles = [_ascending(points, [index[tuple(c)] for c in three]) for three in corners]
    except (shapely.GEOSException, KeyError):  # KeyError: a corner where no vertex is
        triangles = []
    area, covered = signed_area(points[loop]), sum(signed_area(points[list(t)]) for t in triangles)
    if abs(area - covered) > ON_LINE * area:
        x, y = points[loop[0]]
        raise InvalidPattern(
            f"The lines around the polygon at ({x:g}, {y:g}) mm cross or overlap between its "
            f"{len(loop)} vertices; give them a vertex wherever they meet."
        )
    return sorted(triangles)


def _ascending(points: Floats, corners: list[int]) -> tuple[int, ...]:
    """Return a triangle counter-clockwise, its lowest number first."""
    ccw = corners if signed_area(points[corners]) > 0 else corners[::-1]
    k = ccw.index(min(ccw))
    return tuple(ccw[k:] + ccw[:k])


def loops(points: Floats, edges: Indices) -> list[Indices]:
    """Chain edges (E, 2) into closed loops, counter-clockwise, the largest area first.

    Edges that close no loop are left out. At a vertex where loops touch, the chain turns right, so
    that loops do not cross.
    """
    turn = _next_half_edge(points, edges)
    chains: list[Indices] = []
    open_half_edges = set(turn)
    for start in list(turn):
        if start not in open_half_edges:
            continue
        chain, half_edge = [], start
        while half_edge in open_half_edges:
            open_half_edges.discard(half_edge)
            chain.append(half_edge[0])
            half_edge = turn[half_edge]
        if len(chain) > 2 and signed_area(points[chain]) > 0:
            chains.append(np.array(chain, np.intp))
    return sorted(chains, key=lambda chain: -signed_area(points[chain]))
