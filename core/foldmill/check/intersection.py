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
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill.folded import face_normals
from foldmill.planar import edge_faces
from foldmill.tolerances import PENETRATION
from foldmill.vectors import cross, least, lengths, most, units

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]
Signs = NDArray[np.int8]

_BLOCK = 2_000_000
"""Heights over planes looked at in one go: about 50 MB."""
MANY = 2_000_000
"""Vertices times faces beyond which a tree finds the facets that are near each other."""


@dataclass(frozen=True, eq=False)
class _Mesh:
    """Triangles in space, and which of them are of interest."""

    vertices: Floats
    faces: Indices
    is_wanted: Flags
    """(F,) whether a face is of interest."""
    eps: float

    @cached_property
    def corners(self) -> Floats:
        """(F, 3, 3) mm."""
        return self.vertices[self.faces]

    @cached_property
    def normals(self) -> Floats:
        """(F, 3); a facet without area has none."""
        return face_normals(self.vertices, self.faces)

    @cached_property
    def offsets(self) -> Floats:
        """(F,) mm from the origin to each plane, along its normal."""
        offsets: Floats = np.einsum("fi,fi->f", self.normals, self.corners[:, 0])
        return offsets

    @cached_property
    def table(self) -> Signs | None:
        """(V, F) the signs of all vertices over all planes; None where that is too much."""
        if len(self.vertices) * len(self.faces) > _BLOCK:
            return None
        return self._signs(self.vertices @ self.normals.T - self.offsets)

    def over_all(self, spots: Indices) -> Signs:
        """Return on which side (n, F) of all faces' planes vertices (n,) are: 1, -1 or 0."""
        if self.table is not None:
            return self.table[spots]
        return self._signs(self.vertices[spots] @ self.normals.T - self.offsets)

    def over_some(self, rows: Indices) -> Signs:
        """Return on which side (V, k) of the planes of faces (k,) all vertices are."""
        if self.table is not None:
            return self.table[:, rows]
        return self._signs(self.vertices @ self.normals[rows].T - self.offsets[rows])

    def over(self, spots: Indices, rows: Indices) -> Signs:
        """Return on which side (n,) of the plane of its face (n,) each vertex (n,) is."""
        if self.table is not None:
            return self.table[spots, rows]
        heights = (self.vertices[spots] * self.normals[rows]).sum(axis=-1)
        return self._signs(heights - self.offsets[rows])

    def _signs(self, heights: Floats) -> Signs:
        return (heights > self.eps).astype(np.int8) - (heights < -self.eps)

    def blocks(self, rows: Indices, width: int) -> Iterator[Indices]:
        """Yield the rows in parts whose tables of so many columns fit in memory."""
        step = max(1, _BLOCK // max(1, width))
        for start in range(0, len(rows), step):
            yield rows[start : start + step]


def penetrations(
    vertices: Floats, edges: Indices, faces: Indices, among: Indices | None = None
) -> Indices:
    """Return the pairs of faces (k, 2) that penetrate, each pair once, sorted.

    vertices : (V, 3) mm; edges : (E, 2); faces : (F, 3);
    among : faces of interest; only pairs with one of them are looked at (default: all).
    """
    eps = PENETRATION * float(np.ptp(vertices, axis=0).max())
    if len(vertices) * len(faces) > MANY:
        from foldmill.check import large

        return large.penetrations(vertices, faces, eps, among)
    is_wanted = np.full(len(faces), among is None)
    is_wanted[np.asarray([] if among is None else among, np.intp)] = True
    mesh = _Mesh(vertices, faces, is_wanted, eps)
    found = [_crossing(mesh, pairs) for pairs in _straddling(mesh)]
    found += list(_along_edges(mesh, edges))
    if not any(len(each) for each in found):
        return np.zeros((0, 2), np.intp)
    pairs: Indices = np.unique(np.sort(np.vstack(found), axis=1), axis=0)
    return pairs


def _straddling(mesh: _Mesh) -> Iterator[Indices]:
    """Yield the pairs (k, 2) that straddle each other's plane, may meet, and share no edge."""
    faces = mesh.faces
    low, high = (bound.reduce(mesh.corners, axis=1) for bound in (np.minimum, np.maximum))
    for rows in mesh.blocks(np.flatnonzero(mesh.is_wanted), 3 * len(faces)):
        over = _on_both_sides(*(mesh.over_all(faces[rows, k]) for k in range(3)))
        if len(rows) == len(faces):
            under = over
        else:
            signs = mesh.over_some(rows)
            under = _on_both_sides(*(signs[faces[:, k]] for k in range(3)))
        a, b = np.nonzero(over & under.T)
        a = rows[a]
        a, b = _kept((a < b) | ~mesh.is_wanted[b], a, b)
        a, b = _kept(((low[a] <= high[b]) & (high[a] >= low[b])).all(axis=1), a, b)
        shared = (faces[a][:, :, None] == faces[b][:, None, :]).sum(axis=(1, 2))
        yield np.column_stack(_kept(shared < 2, a, b))


def _on_both_sides(a: Signs, b: Signs, c: Signs) -> Flags:
    """Tell of which planes triangles have corners on both sides, by their corners' signs."""
    both: Flags = np.minimum(np.minimum(a, b), c) < 0
    both &= np.maximum(np.maximum(a, b), c) > 0
    return both


def _crossing(mesh: _Mesh, pairs: Indices) -> Indices:
    if not len(pairs):
        return pairs
    one, two = mesh.corners[pairs[:, 0]], mesh.corners[pairs[:, 1]]
    hit: Indices = pairs[cut_lengths(one, two, mesh.eps) > 0]
    return hit


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


def _along_edges(mesh: _Mesh, edges: Indices) -> Iterator[Indices]:
    """Yield faces (k, 2) through which a sheet passes exactly along one of its own creases."""
    around = edge_faces(edges, mesh.faces)
    inner = np.flatnonzero((around[:, 0] >= 0) & (around[:, 1] >= 0))
    for block in mesh.blocks(inner, len(mesh.faces)):
        (first, last), own = edges[block].T, around[block]
        lies = (mesh.over_all(first) == 0) & (mesh.over_all(last) == 0)
        asked: Flags = mesh.is_wanted[own[:, 0]] | mesh.is_wanted[own[:, 1]]
        lies &= mesh.is_wanted | asked[:, None]
        lies[np.arange(len(block))[:, None], own] = False
        row, face = np.nonzero(lies)
        left, right = (mesh.faces[own].sum(axis=2) - (first + last)[:, None]).T
        passes = mesh.over(left[row], face) * mesh.over(right[row], face) < 0
        row, face = _kept(passes, row, face)
        if len(row):
            inside = lengths_inside(mesh.vertices[edges[block[row]]], mesh.corners[face], mesh.eps)
            row, face = _kept(inside > mesh.eps, row, face)
        yield np.column_stack([np.repeat(face, 2), own[row].ravel()])


def _kept(flags: Flags, a: Indices, b: Indices) -> tuple[Indices, Indices]:
    return a[flags], b[flags]


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
