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

from foldmill.check import large
from foldmill.check.triangles import cut_lengths, lengths_inside
from foldmill.folded import face_normals
from foldmill.planar import edge_faces
from foldmill.tolerances import PENETRATION

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
