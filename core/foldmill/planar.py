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
    halves = np.stack([edges, edges[:, ::-1]], axis=1).reshape(-1, 2)
    steps = points[halves[:, 1]] - points[halves[:, 0]]
    angles = np.arctan2(steps[:, 1], steps[:, 0]).tolist()
    for (tail, head), angle in zip(halves.tolist(), angles, strict=True):
        around.setdefault(tail, []).append((angle, head))
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


def triangulate(points: Floats, loops: list[list[int]]) -> tuple[Indices, Indices, Indices]:
    """Cut simple polygons into triangles without new vertices.

    Returns faces (F, 3), the polygon (F,) each is part of, and the added edges (A, 2). Raises
    InvalidPattern for a polygon whose lines cross.
    """
    faces: list[tuple[int, ...]] = []
    owners: list[int] = []
    extra: list[tuple[int, int]] = []
    for number, loop in enumerate(loops):
        if len(loop) == 3:
            faces.append(tuple(loop))
            owners.append(number)
            continue
        triangles = _cut_polygon(points, loop)
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
