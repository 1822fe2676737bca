"""Do facets pass through each other? An exact rule, free of collision-library margins.

Two triangles penetrate where each has corners on both sides of the other's plane, by more than eps,
and they overlap along the planes' common line by more than eps. Touching, lying upon each other and
sharing an edge are not penetration. A sheet can also pass through a triangle exactly along an edge:
the edge lies inside the triangle and its two faces leave on opposite sides.

Outside the rule is a crossing exactly where both sheets have a crease: there no edge lies inside a
triangle and no triangle straddles another's plane within it, and nothing is found. Any move by more
than eps off that line brings it back under the rule.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from foldmill.folded import face_normals
from foldmill.planar import edge_faces
from foldmill.tolerances import PENETRATION

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

_BLOCK = 2_000_000
"""Pairs looked at in one go: about 200 MB."""


def penetrations(
    vertices: Floats, edges: Indices, faces: Indices, among: Indices | None = None
) -> Indices:
    """Return the pairs of faces (k, 2) that penetrate, each pair once, sorted.

    vertices : (V, 3) mm; edges : (E, 2); faces : (F, 3);
    among : faces of interest; only pairs with one of them are looked at (default: all).
    """
    eps = PENETRATION * float(np.ptp(vertices, axis=0).max())
    wanted = np.arange(len(faces)) if among is None else np.asarray(among, np.intp)
    near = _near_pairs(vertices, faces, wanted)
    found = [_crossing(vertices, faces, pairs, eps) for pairs in near]
    found.append(_along_edges(vertices, edges, faces, wanted, eps))
    pairs: Indices = np.unique(np.sort(np.vstack(found), axis=1), axis=0)
    return pairs


def _near_pairs(vertices: Floats, faces: Indices, wanted: Indices) -> Iterator[Indices]:
    """Yield the pairs (k, 2) whose boxes overlap and that share no edge."""
    low, high = vertices[faces].min(axis=1), vertices[faces].max(axis=1)
    is_wanted = np.isin(np.arange(len(faces)), wanted)
    step = max(1, _BLOCK // max(1, len(faces)))
    for start in range(0, len(wanted), step):
        rows = wanted[start : start + step]
        apart = np.zeros((len(rows), len(faces)), bool)
        for k in range(3):
            apart |= low[rows, None, k] > high[None, :, k]
            apart |= high[rows, None, k] < low[None, :, k]
        a, b = np.nonzero(~apart)
        a = rows[a]
        once = (a < b) | ~is_wanted[b]
        a, b = a[once], b[once]
        shared = (faces[a][:, :, None] == faces[b][:, None, :]).sum(axis=(1, 2))
        yield np.column_stack([a, b])[shared < 2]


def _crossing(vertices: Floats, faces: Indices, pairs: Indices, eps: float) -> Indices:
    if not len(pairs):
        return pairs
    corners = vertices[faces]
    hit: Indices = pairs[cut_lengths(corners[pairs[:, 0]], corners[pairs[:, 1]], eps) > 0]
    return hit


def cut_lengths(one: Floats, two: Floats, eps: float) -> Floats:
    """Return along what length (n,) each pair of triangles penetrates, mm; 0 where it does not.

    one, two : (n, 3, 3) corners, mm; eps : mm by which they must pass through each other.
    """
    lengths = np.zeros(len(one))
    normal_one, normal_two = (_normals(triangles) for triangles in (one, two))
    height_two = np.einsum("nij,nj->ni", two - one[:, :1], normal_one)
    height_one = np.einsum("nij,nj->ni", one - two[:, :1], normal_two)
    both = _straddles(height_one, eps) & _straddles(height_two, eps)
    line = np.cross(normal_one[both], normal_two[both])
    line /= np.linalg.norm(line, axis=1, keepdims=True)
    low_one, high_one = _span(one[both], height_one[both], line)
    low_two, high_two = _span(two[both], height_two[both], line)
    overlap = np.minimum(high_one, high_two) - np.maximum(low_one, low_two)
    lengths[both] = np.where(overlap > eps, overlap, 0.0)
    return lengths


def _normals(triangles: Floats) -> Floats:
    """Return the unit normals (n, 3) of triangles (n, 3, 3); a facet without area has none."""
    return face_normals(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3))


def _straddles(heights: Floats, eps: float) -> Flags:
    flags: Flags = (heights.min(axis=1) < -eps) & (heights.max(axis=1) > eps)
    return flags


def _span(triangles: Floats, heights: Floats, line: Floats) -> tuple[Floats, Floats]:
    """Return where the triangles' cut with the other plane begins and ends along ``line``."""
    along = np.einsum("nij,nj->ni", triangles, line)
    after, along_after = np.roll(heights, -1, axis=1), np.roll(along, -1, axis=1)
    crosses = (heights * after < 0) | (heights == 0)
    share = heights / np.where(heights == after, 1.0, heights - after)
    spots = along + share * (along_after - along)
    return (
        np.where(crosses, spots, np.inf).min(axis=1),
        np.where(crosses, spots, -np.inf).max(axis=1),
    )


def _along_edges(
    vertices: Floats, edges: Indices, faces: Indices, wanted: Indices, eps: float
) -> Indices:
    """Find faces through which a sheet passes exactly along one of its own creases."""
    around = edge_faces(edges, faces)
    inner = np.flatnonzero((around >= 0).all(axis=1))
    hits: list[tuple[int, int]] = []
    normals = face_normals(vertices, faces)
    is_wanted = np.isin(np.arange(len(faces)), wanted)
    height = vertices @ normals.T - np.einsum("fi,fi->f", normals, vertices[faces[:, 0]])
    for block in np.array_split(inner, max(1, len(inner) * len(faces) // _BLOCK)):
        in_plane = (np.abs(height[edges[block]]) <= eps).all(axis=1)
        left, right = (_third_height(height, edges, faces, block, around[block, k]) for k in (0, 1))
        passes = in_plane & (np.minimum(left, right) < -eps) & (np.maximum(left, right) > eps)
        for edge, face in zip(*np.nonzero(passes), strict=True):
            own = around[block[edge]]
            if face in own or not (is_wanted[face] or is_wanted[own].any()):
                continue
            if _length_inside(vertices[edges[block[edge]]], vertices[faces[face]], eps) > eps:
                hits += [(int(face), int(own[0])), (int(face), int(own[1]))]
    return np.array(hits, np.intp).reshape(-1, 2)


def _third_height(
    height: Floats, edges: Indices, faces: Indices, block: Indices, own: Indices
) -> Floats:
    """Return over each face's plane the height of the corner of ``own`` that is not on the edge."""
    corners = faces[own]
    is_end = (corners[:, :, None] == edges[block][:, None, :]).any(axis=2)
    third = corners[~is_end]
    above: Floats = height[third]
    return above


def _length_inside(segment: Floats, triangle: Floats, eps: float) -> float:
    """Return the length of a segment in a triangle's plane that lies inside by more than eps."""
    start, step = segment[0], segment[1] - segment[0]
    normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
    low, high = 0.0, 1.0
    for k in range(3):
        side = triangle[(k + 1) % 3] - triangle[k]
        inward = np.cross(normal, side)
        inward /= np.linalg.norm(inward)
        offset, slope = float((start - triangle[k]) @ inward) - eps, float(step @ inward)
        if abs(slope) <= eps:
            if offset <= 0:
                return 0.0
            continue
        limit = -offset / slope
        low, high = (max(low, limit), high) if slope > 0 else (low, min(high, limit))
    return max(0.0, high - low) * float(np.linalg.norm(step))
