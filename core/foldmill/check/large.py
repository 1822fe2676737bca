"""Do facets of a large form pass through each other? The rule of ``intersection``, by a tree.

Only facets whose boxes overlap can meet; a tree over the boxes finds them in the two axes that tell
the most facets apart, and the third axis thins them out. So the work grows with the facets, not
with their square.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from foldmill.check.triangles import cut_lengths, lengths_inside
from foldmill.folded import face_normals
from foldmill.planar import edge_faces, face_sides

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

BLOCK = 20_000
"""Facets asked for at a time: some million pairs."""
SAMPLE = 1_000
"""Facets by which the two axes are chosen."""


def penetrations(
    vertices: Floats, faces: Indices, eps: float, among: Indices | None = None
) -> Indices:
    """Return the pairs of faces (k, 2) that penetrate by more than eps, each once, sorted.

    vertices : (V, 3) mm; faces : (F, 3); among : only pairs with one of these (default: all).
    """
    corners = vertices[faces]
    normals = face_normals(vertices, faces)
    beside = _beside(faces)
    wanted = np.arange(len(faces)) if among is None else np.unique(among)
    is_wanted = np.isin(np.arange(len(faces)), wanted)
    found = [np.zeros((0, 2), np.intp)]
    for pairs in near_pairs(corners, wanted, eps):
        once = (pairs[:, 0] < pairs[:, 1]) | ~is_wanted[pairs[:, 1]]
        found.append(_crossing(corners, faces, pairs[once], eps))
        both = np.vstack([pairs[once], pairs[once][:, ::-1]])
        found.append(_along_edges(corners, normals, beside, both, eps))
    every = np.sort(np.vstack(found), axis=1)
    return np.unique(every, axis=0).astype(np.intp)


def near_pairs(corners: Floats, wanted: Indices, eps: float = 0.0) -> Iterator[Indices]:
    """Yield pairs (k, 2) of different facets, the first one wanted, whose boxes overlap.

    corners : (F, 3, 3) mm; eps : mm by which boxes are widened.
    """
    import shapely

    low, high = corners.min(axis=1) - eps, corners.max(axis=1) + eps
    x, y = _telling_axes(low, high)
    boxes = shapely.box(low[:, x], low[:, y], high[:, x], high[:, y])
    tree = shapely.STRtree(boxes)
    for start in range(0, len(wanted), BLOCK):
        rows = wanted[start : start + BLOCK]
        a, b = tree.query(boxes[rows])
        a = rows[a]
        meets = ((low[a] <= high[b]) & (high[a] >= low[b])).all(axis=1) & (a != b)
        yield np.column_stack([a[meets], b[meets]])


def _telling_axes(low: Floats, high: Floats) -> tuple[int, int]:
    """Return the two axes along which the fewest boxes of a sample overlap a box."""
    some = np.linspace(0, len(low) - 1, min(SAMPLE, len(low))).astype(np.intp)

    def overlaps(axes: tuple[int, int]) -> int:
        meets = np.ones((len(some), len(some)), bool)
        for axis in axes:
            meets &= low[some, None, axis] <= high[None, some, axis]
            meets &= high[some, None, axis] >= low[None, some, axis]
        return int(np.count_nonzero(meets))

    return min(combinations(range(3), 2), key=overlaps)


def _crossing(corners: Floats, faces: Indices, pairs: Indices, eps: float) -> Indices:
    one, two = faces[pairs[:, 0]], faces[pairs[:, 1]]
    shared = (one[:, :, None] == two[:, None, :]).sum(axis=(1, 2))
    pairs = pairs[shared < 2]
    if not len(pairs):
        return pairs
    lengths = cut_lengths(corners[pairs[:, 0]], corners[pairs[:, 1]], eps)
    hit: Indices = pairs[lengths > 0]
    return hit


def _beside(faces: Indices) -> Indices:
    """Return (F, 3) the face across each side, -1 where there is none."""
    sides, _ = face_sides(faces)
    across: Indices = edge_faces(sides, faces)[:, 1].reshape(-1, 3)
    return across


def _along_edges(
    corners: Floats, normals: Floats, beside: Indices, pairs: Indices, eps: float
) -> Indices:
    """Return which of the pairs (own, other) pass through the other exactly along an own side."""
    own, other = pairs.T
    rise = corners[own] - corners[other][:, :1]
    heights = np.einsum("nij,nj->ni", rise, normals[other])
    level = np.abs(heights) <= eps
    row, side = np.nonzero(level & level[:, [1, 2, 0]])
    next_ = beside[own[row], side]
    kept = (next_ >= 0) & (next_ != other[row])
    row, side, next_ = row[kept], side[kept], next_[kept]
    plane, origin = normals[other[row]], corners[other[row], 0]
    here = heights[row, (side + 2) % 3]
    far = np.einsum("nij,nj->ni", corners[next_] - origin[:, None], plane)
    there = np.take_along_axis(far, np.abs(far).argmax(axis=1)[:, None], axis=1)[:, 0]
    passes = (np.minimum(here, there) < -eps) & (np.maximum(here, there) > eps)
    row, side, next_ = row[passes], side[passes], next_[passes]
    at = own[row]
    segments = np.stack([corners[at, side], corners[at, (side + 1) % 3]], axis=1)
    inside = lengths_inside(segments, corners[other[row]], eps) > eps
    row, next_ = row[inside], next_[inside]
    ends = np.column_stack([other[row], own[row]]), np.column_stack([other[row], next_])
    found: Indices = np.vstack(ends).astype(np.intp)
    return found
