"""The angles between facets at a vertex, and how they change while a form moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.design import Fold
from foldmill.errors import InvalidParameters
from foldmill.folded import fold_angles
from foldmill.motion import Motion
from foldmill.pattern import Assignment

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class DihedralTable:
    """The creases of one vertex, and their dihedral angles along a motion."""

    vertex: int
    edges: Indices
    """(k,) creases of the vertex, clockwise from straight up in the pattern."""
    times: Floats
    """(m,) t of the motion."""
    angles: Floats
    """(m, k) deg in [0, 180]: interior angle between the facets, 180 − |fold angle|."""
    names: tuple[str, ...]
    """(k,) each crease by its two vertices and its letter in the pattern: "17-23 M"."""


def dihedral_angles(
    fold: Fold, motion: Motion, vertex: int, times: Sequence[float] | Floats
) -> DihedralTable:
    """Return the dihedral angles round a vertex at every t of ``times``.

    Raises InvalidParameters for a vertex that is not in the pattern, or a t beyond the motion.
    """
    edges = creases_of(fold, vertex)
    pattern = fold.pattern
    around, ends = pattern.edge_faces[edges], pattern.edges[edges]
    rows = [
        180 - np.abs(fold_angles(motion.at(float(t)), ends, pattern.faces, around)) for t in times
    ]
    table = np.array(rows, np.float64).reshape(len(rows), len(edges))
    names = tuple(_name(fold, vertex, int(edge)) for edge in edges)
    return DihedralTable(vertex, edges, np.asarray(times, np.float64), table, names)


def _name(fold: Fold, vertex: int, edge: int) -> str:
    far = int(fold.pattern.edges[edge].sum()) - vertex
    return f"{vertex}-{far} {Assignment(fold.pattern.assignments[edge]).name}"


def creases_of(fold: Fold, vertex: int) -> Indices:
    """Return the creases at a vertex, clockwise from straight up; border edges are left out."""
    pattern = fold.pattern
    if not 0 <= vertex < len(pattern.vertices):
        raise InvalidParameters(
            f"There is no vertex {vertex}; the pattern has 0 to {len(pattern.vertices) - 1}."
        )
    inner = (pattern.edge_faces >= 0).all(axis=1)
    edges = np.flatnonzero((pattern.edges == vertex).any(axis=1) & inner)
    far = pattern.edges[edges].sum(axis=1) - vertex
    x, y = (pattern.vertices[far] - pattern.vertices[vertex]).T
    ordered: Indices = edges[np.argsort(np.arctan2(x, y) % (2 * np.pi), kind="stable")]
    return ordered
