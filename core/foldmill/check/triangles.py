"""Pairs of triangles and of segments in space, by the rule of ``intersection``."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.vectors import cross, least, lengths, most, units

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def cut_lengths(one: Floats, two: Floats, eps: float) -> Floats:
    """Return along what length (n,) each pair of triangles penetrates, mm; 0 where it does not.

    one, two : (n, 3, 3) corners, mm; eps : mm by which they must pass through each other.
    """
    found = np.zeros(len(one))
    normal_one, normal_two = triangle_normals(one), triangle_normals(two)
    height_two = np.einsum("nij,nj->ni", two - one[:, :1], normal_one)
    height_one = np.einsum("nij,nj->ni", one - two[:, :1], normal_two)
    both = np.flatnonzero(_straddles(height_one, eps) & _straddles(height_two, eps))
    if not len(both):
        return found
    line = units(cross(normal_one[both], normal_two[both]))
    low_one, high_one = _span(one[both], height_one[both], line)
    low_two, high_two = _span(two[both], height_two[both], line)
    overlap = np.minimum(high_one, high_two) - np.maximum(low_one, low_two)
    found[both] = np.where(overlap > eps, overlap, 0.0)
    return found


def triangle_normals(triangles: Floats) -> Floats:
    """Return the unit normals (n, 3) of triangles (n, 3, 3); a facet without area has none."""
    first = triangles[:, 0]
    return units(cross(triangles[:, 1] - first, triangles[:, 2] - first))


def lengths_inside(segments: Floats, triangles: Floats, eps: float) -> Floats:
    """Return the lengths (n,) of segments (n, 2, 3), each in the plane of a triangle, inside it.

    triangles : (n, 3, 3) mm; eps : mm by which to keep away from their sides.
    """
    start, step = segments[:, 0], segments[:, 1] - segments[:, 0]
    sides = triangles[:, [1, 2, 0]] - triangles
    inward = units(cross(triangle_normals(triangles)[:, None], sides))
    offset = ((start[:, None] - triangles) * inward).sum(axis=2) - eps
    slope = (step[:, None] * inward).sum(axis=2)
    level = np.abs(slope) <= eps
    limit = -offset / np.where(level, 1.0, slope)
    low = np.where(~level & (slope > 0), limit, 0.0).max(axis=1, initial=0.0)
    high = np.where(~level & (slope < 0), limit, 1.0).min(axis=1, initial=1.0)
    outside = (level & (offset <= 0)).any(axis=1)
    share: Floats = np.where(outside, 0.0, np.maximum(0.0, high - low))
    return share * lengths(step)


def _straddles(heights: Floats, eps: float) -> Flags:
    """Tell which triangles, by their corners' heights (n, 3), are on both sides of a plane."""
    flags: Flags = (least(heights) < -eps) & (most(heights) > eps)
    return flags


def _span(triangles: Floats, heights: Floats, line: Floats) -> tuple[Floats, Floats]:
    """Return where the triangles' cut with the other plane begins and ends along ``line``."""
    along = np.einsum("nij,nj->ni", triangles, line)
    after, along_after = heights[:, [1, 2, 0]], along[:, [1, 2, 0]]
    crosses = (heights * after < 0) | (heights == 0)
    share = heights / np.where(heights == after, 1.0, heights - after)
    spots = along + share * (along_after - along)
    return least(np.where(crosses, spots, np.inf)), most(np.where(crosses, spots, -np.inf))
