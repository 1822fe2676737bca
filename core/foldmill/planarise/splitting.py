"""Weld points that coincide and split lines where others meet them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.planarise.meetings import meetings

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_CROWD = 4
"""Points in a square of half ``touch`` above which they are one without being paired."""


def weld(points: Floats, touch: float) -> tuple[Floats, Indices]:
    """Return points (V, 2) and, for each given one, the number of the point that stands for it.

    Points nearer than ``touch`` mm become the first of them, exactly.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    if not len(points):
        return points.copy(), np.arange(0)
    first_of = _crowds(points, touch)
    lone = np.flatnonzero(first_of == np.arange(len(points)))
    near = lone[cKDTree(points[lone]).query_pairs(touch, output_type="ndarray")]
    if not len(near) and len(lone) == len(points):
        return points.copy(), np.arange(len(points))
    links = np.vstack([near, np.stack([np.arange(len(points)), first_of], axis=1)])
    graph = coo_array((np.ones(len(links)), links.T), shape=(len(points),) * 2)
    label = connected_components(graph, directed=False)[1]
    _, first, same = np.unique(label, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    return points[np.sort(first)], rank[same].astype(np.intp)


def _crowds(points: Floats, touch: float) -> Indices:
    """Return for each point (n,) the first of its crowd; itself where there is none.

    A thousand lines through one point cross half a million times there, and pairs of those would
    be more than any memory holds.
    """
    cells = np.floor(points * (2 / touch))
    order = np.lexsort((cells[:, 1], cells[:, 0]))
    begins = np.append(True, (cells[order][1:] != cells[order][:-1]).any(axis=1))
    start = np.flatnonzero(begins)
    count = np.diff(np.append(start, len(points)))
    first = np.arange(len(points))
    crowd = np.repeat(count > _CROWD, count)
    first[order[crowd]] = np.repeat(order[start], count)[crowd]
    return first


def split(
    points: Floats, edges: Indices, owner: Indices, touch: float, most: int | None = None
) -> tuple[Floats, Indices, Indices, Indices]:
    """Split edges where another's end lies on them, and where they cross.

    points : (V, 2) mm; edges : (E, 2); owner : (E,) the line each is part of. Returns the same for
    the split edges, in order along the old ones, and the vertices at which something was split.
    most : edges that there may be after it; raises InvalidPattern where there would be more.
    """
    edge, place, vertex, points = meetings(points, edges, touch, most)
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
