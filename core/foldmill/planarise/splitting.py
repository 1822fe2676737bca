"""Weld points that coincide and split lines where others meet them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def weld(points: Floats, touch: float) -> tuple[Floats, Indices]:
    """Return points (V, 2) and, for each given one, the number of the point that stands for it.

    Points nearer than ``touch`` mm become the first of them, exactly.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    near = cKDTree(points).query_pairs(touch, output_type="ndarray") if len(points) else None
    if near is None or not len(near):
        return points.copy(), np.arange(len(points))
    links = coo_array((np.ones(len(near)), near.T), shape=(len(points),) * 2)
    label = connected_components(links, directed=False)[1]
    _, first, same = np.unique(label, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    return points[np.sort(first)], rank[same].astype(np.intp)


def split(
    points: Floats, edges: Indices, owner: Indices, touch: float
) -> tuple[Floats, Indices, Indices, Indices]:
    """Split edges where another's end lies on them, and where they cross.

    points : (V, 2) mm; edges : (E, 2); owner : (E,) the line each is part of. Returns the same for
    the split edges, in order along the old ones, and the vertices at which something was split.
    """
    edge, place, vertex, points = _meetings(points, edges, touch)
    if not len(edge):
        return points, edges, owner, vertex
    points, same = weld(points, touch)
    edges, vertex = same[edges], same[vertex]
    count = np.arange(len(edges))
    on = np.concatenate([count, edge, count])
    at = np.concatenate([np.zeros(len(edges)), place, np.ones(len(edges))])
    who = np.concatenate([edges[:, 0], vertex, edges[:, 1]])
    order = np.lexsort((at, on))
    on, who = on[order], who[order]
    real = (on[1:] == on[:-1]) & (who[1:] != who[:-1])
    pieces = np.stack([who[:-1], who[1:]], axis=1)[real]
    return points, pieces, owner[on[:-1][real]], np.unique(vertex)


def _meetings(
    points: Floats, edges: Indices, touch: float
) -> tuple[Indices, Floats, Indices, Floats]:
    """Return edge, place along it in (0, 1) and vertex of every split, and all points."""
    import shapely

    lines = shapely.linestrings(points[edges])
    found = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=touch)
    i, j = found[:, found[0] != found[1]].astype(np.intp)
    parts = [_ends_on(points, edges, i, edges[j, side], touch) for side in (0, 1)]
    once = i < j
    crossing = _crossings(points, edges, i[once], j[once], touch)
    parts += [(e, t, len(points) + np.arange(len(e))) for e, t in crossing[:2]]
    edge, place, vertex = (np.concatenate([part[k] for part in parts]) for k in range(3))
    return edge, place, vertex.astype(np.intp), np.vstack([points, crossing[2]])


def _ends_on(
    points: Floats, edges: Indices, i: Indices, vertex: Indices, touch: float
) -> tuple[Indices, Floats, Indices]:
    """Keep the pairs whose vertex lies on the edge, between its ends."""
    a, b = points[edges[i, 0]], points[edges[i, 1]]
    along = b - a
    length = np.hypot(*along.T)
    step = points[vertex] - a
    place = (step * along).sum(axis=1) / length**2
    beside = np.abs(along[:, 0] * step[:, 1] - along[:, 1] * step[:, 0]) / length
    other = (vertex != edges[i, 0]) & (vertex != edges[i, 1])
    on = other & (beside <= touch) & (place > 0) & (place < 1)
    return i[on], place[on], vertex[on]


def _crossings(
    points: Floats, edges: Indices, i: Indices, j: Indices, touch: float
) -> tuple[tuple[Indices, Floats], tuple[Indices, Floats], Floats]:
    """Return (edge, place) of both edges of each pair that cross inside, and where."""
    a, c = points[edges[i, 0]], points[edges[j, 0]]
    u, v = points[edges[i, 1]] - a, points[edges[j, 1]] - c
    w = c - a
    across = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    lengths = np.hypot(*u.T), np.hypot(*v.T)
    open_ = np.abs(across) > 1e-12 * lengths[0] * lengths[1]
    safe = np.where(open_, across, 1.0)
    s = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / safe
    t = (w[:, 0] * u[:, 1] - w[:, 1] * u[:, 0]) / safe
    inside = open_ & _within(points, edges[i], a + s[:, None] * u, s, touch)
    inside &= _within(points, edges[j], a + s[:, None] * u, t, touch)
    where = (a + s[:, None] * u)[inside]
    return (i[inside], s[inside]), (j[inside], t[inside]), where


def _within(
    points: Floats, edges: Indices, where: Floats, place: Floats, touch: float
) -> NDArray[np.bool_]:
    """Tell which places lie on their edge, farther than ``touch`` from both its ends."""
    clear = np.ones(len(edges), bool)
    for side in (0, 1):
        clear &= np.hypot(*(where - points[edges[:, side]]).T) > touch
    inside: NDArray[np.bool_] = clear & (place > 0) & (place < 1)
    return inside
