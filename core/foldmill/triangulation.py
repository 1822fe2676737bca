"""Polygons become triangles without new vertices, all at once."""

from __future__ import annotations

import numpy as np

from foldmill.errors import InvalidPattern
from foldmill.planar import Floats, Indices, signed_areas
from foldmill.tolerances import ON_LINE

_Keyed = tuple[Floats, Indices]
"""(n, 3) the number of the polygon and a corner's place, and the corner's vertex (n,)."""


def triangulate(points: Floats, loops: list[list[int]]) -> tuple[Indices, Indices, Indices]:
    """Cut simple polygons into triangles without new vertices.

    points : (V, 2); loops : vertices of each polygon, counter-clockwise. Returns faces (F, 3), the
    polygon (F,) each is part of, and the added edges (A, 2). Raises InvalidPattern for a polygon
    whose lines cross.
    """
    own = np.array([k for k, loop in enumerate(loops) if len(loop) == 3], np.intp)
    larger = np.array([k for k, loop in enumerate(loops) if len(loop) != 3], np.intp)
    whole = np.array([loops[k] for k in own.tolist()], np.intp).reshape(-1, 3)
    # Ties, as in a square, are decided by the first corner; so begin where every caller would.
    turned = [_from_lowest(loops[k]) for k in larger.tolist()]
    cut, part = _cut(points, turned)
    _refuse_crossed(points, [loops[k] for k in larger.tolist()], cut, part)
    extra = _added(turned, cut, part)
    owners = np.concatenate([own, larger[part]])
    order = np.argsort(owners, kind="stable")
    return np.vstack([whole, cut])[order], owners[order], extra


def _from_lowest(loop: list[int]) -> list[int]:
    first = loop.index(min(loop))
    return loop[first:] + loop[:first]


def _cut(points: Floats, loops: list[list[int]]) -> tuple[Indices, Indices]:
    """Return triangles (F, 3), ascending and counter-clockwise, and the polygon of each, in order.

    A polygon that cannot be cut, or only with corners of its own, has none.
    """
    if not loops:
        return np.zeros((0, 3), np.intp), np.zeros(0, np.intp)
    corners = np.array([vertex for loop in loops for vertex in loop], np.intp)
    ring = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    places, part = _delaunay(points[corners], ring, len(loops))
    known: Floats = np.column_stack([ring.astype(float), points[corners]]) + 0.0
    wanted: Floats = (
        np.column_stack([np.repeat(part, 3).astype(float), places.reshape(-1, 2)]) + 0.0
    )
    vertex = _vertices((known, corners), wanted).reshape(-1, 3)
    fits = ~np.isin(part, part[(vertex < 0).any(axis=1)])
    faces, part = _ascending(points, vertex[fits]), part[fits]
    order = np.lexsort((faces[:, 2], faces[:, 1], faces[:, 0], part))
    return faces[order], part[order]


def _delaunay(places: Floats, ring: Indices, count: int) -> tuple[Floats, Indices]:
    """Return the corners (F, 3, 2) of triangles, and the polygon of each."""
    import shapely

    rings = shapely.linearrings(places, indices=ring)
    polygons = shapely.polygons(rings)
    try:
        cut = shapely.constrained_delaunay_triangles(polygons)
    except shapely.GEOSException:
        cut = np.array([_one_cut(polygons[k]) for k in range(count)])
    parts, of = shapely.get_parts(cut, return_index=True)
    corners = shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3]
    return corners, of.astype(np.intp)


def _one_cut(polygon: object) -> object:
    """Return the triangles of one polygon; none where it has no inside to cut."""
    import shapely

    try:
        return shapely.constrained_delaunay_triangles(polygon)
    except shapely.GEOSException:
        return shapely.GeometryCollection()


def _vertices(known: _Keyed, wanted: Floats) -> Indices:
    """Return the vertex at each place wanted (n, 3); -1 where its polygon has none there.

    Of two vertices of a polygon at one place it is the latter.
    """
    table, vertex = known
    both = np.vstack([table, wanted])
    order = np.lexsort((both[:, 2], both[:, 1], both[:, 0]))
    begins = np.append(True, (both[order][1:] != both[order][:-1]).any(axis=1))
    label = np.zeros(len(both), np.intp)
    label[order] = np.cumsum(begins) - 1
    found = np.full(int(label.max(initial=-1)) + 1, -1, np.intp)
    found[label[: len(table)]] = vertex
    return found[label[len(table) :]]


def _ascending(points: Floats, corners: Indices) -> Indices:
    """Return triangles (F, 3) counter-clockwise, the lowest number first."""
    clockwise = _areas(points, corners) <= 0
    ccw = np.where(clockwise[:, None], corners[:, ::-1], corners)
    turn = (ccw.argmin(axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(ccw, turn, axis=1)


def _areas(points: Floats, triangles: Indices) -> Floats:
    x, y = points[triangles].transpose(2, 0, 1)
    ahead, above = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    areas: Floats = 0.5 * ((x * above).sum(axis=1) - (y * ahead).sum(axis=1))
    return areas


def _refuse_crossed(
    points: Floats, loops: list[list[int]], triangles: Indices, part: Indices
) -> None:
    """Refuse polygons that their triangles do not cover exactly."""
    areas = signed_areas(points, loops)
    covered = np.bincount(part, _areas(points, triangles), minlength=len(loops))
    wrong = np.flatnonzero(np.abs(areas - covered) > ON_LINE * areas)
    if len(wrong):
        loop = _from_lowest(loops[int(wrong[0])])
        x, y = points[loop[0]]
        raise InvalidPattern(
            f"The lines around the polygon at ({x:g}, {y:g}) mm cross or overlap between its "
            f"{len(loop)} vertices; give them a vertex wherever they meet."
        )


def _added(loops: list[list[int]], triangles: Indices, part: Indices) -> Indices:
    """Return the sides (A, 2) of triangles that are no sides of their polygon, in its order."""
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    cut = np.unique(np.column_stack([np.repeat(part, 3), np.sort(sides, axis=1)]), axis=0)
    known = _rims(loops)
    both, where, count = np.unique(
        np.vstack([cut, known]), axis=0, return_index=True, return_counts=True
    )
    added: Indices = both[(count == 1) & (where < len(cut)), 1:]
    return added


def _rims(loops: list[list[int]]) -> Indices:
    """Return the sides (n, 3) of polygons, each once: the polygon's number and both vertices."""
    if not loops:
        return np.zeros((0, 3), np.intp)
    sizes = np.array([len(loop) for loop in loops], np.intp)
    corners = np.array([vertex for loop in loops for vertex in loop], np.intp)
    following = np.arange(1, len(corners) + 1)
    following[np.cumsum(sizes) - 1] -= sizes
    sides = np.sort(np.stack([corners, corners[following]], axis=1), axis=1)
    number = np.repeat(np.arange(len(loops)), sizes)
    return np.unique(np.column_stack([number, sides]), axis=0)
