"""How each crease is folded, and a push back where it is folded too little, too much or wrongly.

Terminology: the *fold* of a crease is its fold angle counted from flat in the direction that a
waterbomb asks for: positive where a mountain is a mountain, negative where it has become a valley.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment
from foldmill_plugins.waterbomb.topology import Indices, Topology

Floats = NDArray[np.float64]
TINY = np.finfo(float).tiny


@dataclass(frozen=True, eq=False)
class Creases:
    """Creases, each as two facets that share an edge."""

    quads: Indices
    """(n, 4) ends a and b of the edge, the far corner of the facet on its left, on its right."""
    signs: Floats
    """(n,) 1 for a mountain as seen along P_u × P_v, -1 for a valley."""

    @classmethod
    def of(cls, topology: Topology, side: int) -> Creases:
        """Return every crease; side : 1 where the centres are displaced against P_u × P_v."""
        faces, count = topology.faces, len(topology.k)
        ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
        far = np.roll(faces, -2, axis=1).ravel()
        keys = ends.min(axis=1) * count + ends.max(axis=1)
        is_left = ends[:, 0] < ends[:, 1]
        left, right = np.flatnonzero(is_left), np.flatnonzero(~is_left)
        shared, one, two = np.intersect1d(keys[left], keys[right], return_indices=True)
        a, b = np.divmod(shared, count)
        quads = np.column_stack([a, b, far[left[one]], far[right[two]]]).astype(np.intp)
        codes = topology.assignments[topology.assignments != Assignment.B]
        return cls(quads, side * np.where(codes == Assignment.M, 1.0, -1.0))

    def chosen(self, rows: Indices) -> Creases:
        """Return some of the creases."""
        return Creases(self.quads[rows], self.signs[rows])

    def folds(self, points: Floats) -> Floats:
        """Return the folds (n,) in rad, from -π to π; points : (V, 3)."""
        a, b, c, d = points[self.quads].transpose(1, 0, 2)
        along = b - a
        left, right = np.cross(along, c - a), np.cross(d - a, along)
        length = np.linalg.norm(along, axis=1)
        sine = np.einsum("ij,ij->i", np.cross(left, right), along) / np.maximum(length, TINY)
        found: Floats = self.signs * np.arctan2(sine, np.einsum("ij,ij->i", left, right))
        return found

    def slopes(self, points: Floats) -> Floats:
        """Return the derivatives (n, 4, 3) of the folds by the places of the four corners."""
        a, b, c, d = points[self.quads].transpose(1, 0, 2)
        along = b - a
        square = np.maximum(np.einsum("ij,ij->i", along, along), TINY)[:, None]
        length = np.sqrt(square)
        left, right = np.cross(along, c - a), np.cross(d - a, along)
        # The far corners turn their facets about the edge; the ends follow as moments balance.
        by_c = -left * length / np.maximum((left**2).sum(axis=1), TINY)[:, None]
        by_d = -right * length / np.maximum((right**2).sum(axis=1), TINY)[:, None]
        at_c = np.einsum("ij,ij->i", c - a, along)[:, None] / square
        at_d = np.einsum("ij,ij->i", d - a, along)[:, None] / square
        by_a = -(1 - at_c) * by_c - (1 - at_d) * by_d
        by_b = -at_c * by_c - at_d * by_d
        found: Floats = self.signs[:, None, None] * np.stack([by_a, by_b, by_c, by_d], axis=1)
        return found


def beyond(values: Floats, low: float, high: float) -> Floats:
    """Return by how much values (n,) leave a range: negative below, positive above, 0 within."""
    out: Floats = np.minimum(values - low, 0.0) + np.maximum(values - high, 0.0)
    return out
