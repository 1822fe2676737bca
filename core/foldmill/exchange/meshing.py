"""Many slits and holes at once: flat lines among all vertices of a sheet, that cross nothing."""

from __future__ import annotations

import numpy as np

from foldmill import planar
from foldmill.pattern import Flags, Floats, Indices

_ALONG = 1e-9
"""Sine of the angle below which two lines run along each other."""


def meshed(
    points: Floats, edges: Indices, inside: Flags, core: Flags
) -> list[tuple[int, int]] | None:
    """Return the Delaunay lines (a, b) between vertices that cross no line of the sheet.

    points : (V, 2) mm; edges : (E, 2), a planar graph; inside : (V,) whether a vertex is one of the
    sheet; core : (E,) whether an edge is one of those that enclose it. None where they leave a face
    without a rim of its own, as slits too close together may.
    """
    from scipy.spatial import Delaunay

    used = np.unique(edges[inside[edges].all(axis=1)])
    corners = used[Delaunay(points[used]).simplices]
    sides = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    new = _without(np.unique(sides, axis=0), np.sort(edges, axis=1))
    new = new[within(points[new].mean(axis=1), edges[core], points)]
    new = new[_is_clear(points, edges, new)]
    both = np.vstack([edges, new])
    loops = planar.polygons(points, both)
    if any(len(set(loop)) < len(loop) for loop in loops) or not _is_one(both):
        return None
    return [(int(a), int(b)) for a, b in new]


def _without(pairs: Indices, known: Indices) -> Indices:
    both = np.vstack([known, pairs])
    _, first, count = np.unique(both, axis=0, return_index=True, return_counts=True)
    lone = np.sort(first[(count == 1) & (first >= len(known))])
    kept: Indices = both[lone]
    return kept


def _is_clear(points: Floats, edges: Indices, new: Indices) -> Flags:
    """Tell which new lines meet the others at common ends only, and leave them at an angle."""
    import shapely

    tree = shapely.STRtree(shapely.linestrings(points[edges]))
    k, e = tree.query(shapely.linestrings(points[new]), predicate="intersects")
    mine, other = new[k], edges[e]
    same = mine[:, :, None] == other[:, None, :]
    meets = same.any(axis=(1, 2))
    clear = np.ones(len(new), bool)
    clear[k[~meets]] = False
    mine, other, same, k = mine[meets], other[meets], same[meets], k[meets]
    shared = mine[same.any(axis=2)]
    own = points[mine.sum(axis=1) - shared] - points[shared]
    far = points[other.sum(axis=1) - shared] - points[shared]
    across = np.abs(own[:, 0] * far[:, 1] - own[:, 1] * far[:, 0])
    along = (across <= _ALONG * np.hypot(*own.T) * np.hypot(*far.T)) & ((own * far).sum(axis=1) > 0)
    clear[k[along]] = False
    return clear


def within(spots: Floats, edges: Indices, points: Floats) -> Flags:
    """Tell which spots lie within the sheet that lines between points enclose."""
    import shapely

    if not len(edges):
        return np.zeros(len(spots), bool)
    rings = shapely.polygonize(shapely.linestrings(points[edges]).tolist())
    sheet = shapely.union_all(rings)
    shapely.prepare(sheet)
    return np.asarray(shapely.contains_xy(sheet, spots[:, 0], spots[:, 1]), bool)


def _is_one(edges: Indices) -> bool:
    """Tell whether all lines hang together."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    named, ends = np.unique(edges, return_inverse=True)
    pairs = ends.reshape(-1, 2)
    ties = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(named),) * 2)
    return bool(connected_components(ties, directed=False)[0] == 1)
