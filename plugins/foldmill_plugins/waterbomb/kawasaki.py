"""Flat-foldability as a condition: round every inner vertex the alternating angle sum is 0.

Kawasaki: a vertex folds flat only if every other angle adds up to 180°. On a surface of revolution
it holds by itself, as every vertex lies on a mirror plane of the form.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.jacobian import Stars
from foldmill_plugins.waterbomb.topology import Indices
from foldmill_plugins.waterbomb.unknowns import Unknowns

Floats = NDArray[np.float64]
TINY = np.finfo(float).tiny
SIGNS = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


def angles(points: Floats, centre: Indices, around: Indices) -> Floats:
    """Return the angles (m, 6) in rad between each neighbour and the next one, round a vertex."""
    spokes = points[around] - points[centre][:, None]
    after = np.roll(spokes, -1, axis=1)
    area = np.linalg.norm(np.cross(spokes, after), axis=2)
    found: Floats = np.arctan2(area, np.einsum("mkc,mkc->mk", spokes, after))
    return found


@dataclass(frozen=True, eq=False)
class FlatFoldable:
    """The conditions of developability, and below them those of Kawasaki: (2m,) rows."""

    stars: Stars

    def residual(self, points: Floats) -> Floats:
        """Return angle sums minus 2π, then alternating sums, rad; points : (V, 3)."""
        return np.concatenate([self.stars.residual(points), self._alternating(points)])

    def linearised(self, points: Floats) -> tuple[Floats, Any]:
        """Return the residual (2m,) and its Jacobian (2m, 3 · free vertices)."""
        from scipy.sparse import vstack

        sums, above = self.stars.linearised(points)
        vertices = np.column_stack([self.stars.centre, self.stars.around])
        below = self._free.derivatives(self._slopes(points), vertices)
        residual = np.concatenate([sums, self._alternating(points)])
        return residual, vstack([above, below]).tocsr()

    def moved(self, points: Floats, step: Floats) -> Floats:
        """Return the vertices after a step (3 · free vertices,) of those that may move."""
        return self.stars.moved(points, step)

    @cached_property
    def _free(self) -> Unknowns:
        return Unknowns.of(self.stars, self.stars.is_free)

    def _alternating(self, points: Floats) -> Floats:
        found: Floats = angles(points, self.stars.centre, self.stars.around) @ SIGNS
        return found

    def _slopes(self, points: Floats) -> Floats:
        """Return the derivatives (m, 7, 3) of the alternating sums, the vertex' own first.

        With spokes e_i and facet normals n_i that by a neighbour is ± e_i × (n_i + n_{i−1}) / e_i².
        """
        spokes = points[self.stars.around] - points[self.stars.centre][:, None]
        normals = np.cross(spokes, np.roll(spokes, -1, axis=1))
        normals = normals / np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), TINY)
        square = np.maximum((spokes**2).sum(axis=2, keepdims=True), TINY)
        both = normals + np.roll(normals, 1, axis=1)
        by = SIGNS[:, None] * np.cross(spokes, both) / square
        out: Floats = np.concatenate([-by.sum(axis=1, keepdims=True), by], axis=1)
        return out
