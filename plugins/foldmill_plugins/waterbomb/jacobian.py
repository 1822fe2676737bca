"""The angle sums of interior vertices and their derivatives, in one fixed sparse pattern.

Every interior vertex has six facets, so that its row is one star of seven vertices: arrays of
(component, row, spoke), no scattering.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.topology import Flags, Indices, Topology

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stars:
    """Interior vertices with their six neighbours, and which vertices may move."""

    centre: Indices
    """(m,) the interior vertices."""
    around: Indices
    """(m, 6) the neighbours of each, in order."""
    is_free: Flags
    """(V,) whether a vertex may move."""

    @classmethod
    def of(cls, topology: Topology, *, is_boundary_free: bool) -> Stars:
        """Return the stars of a topology; a boundary that is not free stays where it is."""
        free = np.ones_like(topology.is_interior) if is_boundary_free else topology.is_interior
        return cls(*topology.stars, free)

    @cached_property
    def _pattern(self) -> tuple[Indices, NDArray[np.int32], NDArray[np.int32]]:
        """Which of the (m, 7) derivatives go where: chosen (n,), indices (3n,), indptr (m + 1,)."""
        vertices = np.column_stack([self.centre, self.around])
        order = np.argsort(vertices, axis=1)
        flat = order + 7 * np.arange(len(vertices))[:, None]
        kept = self.is_free[np.take_along_axis(vertices, order, 1)]
        chosen = flat[kept]
        column = np.cumsum(self.is_free) - 1
        first = 3 * column[vertices.ravel()[chosen]]
        indices = (first[:, None] + np.arange(3)).ravel().astype(np.int32)
        ends = np.concatenate([[0], 3 * np.cumsum(kept.sum(axis=1))]).astype(np.int32)
        return chosen, indices, ends

    def residual(self, points: Floats) -> Floats:
        """Return (m,) angle sum minus 2π at every interior vertex, rad; points : (V, 3)."""
        return self.evaluate(points, with_gradient=False)[0]

    def linearised(self, points: Floats) -> tuple[Floats, Any]:
        """Return the residual (m,) and the Jacobian, a CSR matrix (m, 3 · free vertices)."""
        from scipy.sparse import csr_matrix

        residual, gradient = self.evaluate(points, with_gradient=True)
        chosen, indices, ends = self._pattern
        whole = np.concatenate([-gradient.sum(axis=2)[:, :, None], gradient], axis=2)
        data = whole.reshape(3, -1)[:, chosen].T.ravel()
        shape = (len(self.centre), 3 * int(np.count_nonzero(self.is_free)))
        return residual, csr_matrix((data, indices, ends), shape=shape)

    def moved(self, points: Floats, step: Floats) -> Floats:
        """Return the vertices after a step (3 · free vertices,) of those that may move."""
        out = points.copy()
        out[self.is_free] += step.reshape(-1, 3)
        return out

    def evaluate(self, points: Floats, *, with_gradient: bool) -> tuple[Floats, Floats]:
        """Return the residual (m,) and its derivatives (3, m, 6) by the neighbours' places.

        With spokes e_i and facet normals n_i the derivative is e_i × (n_i − n_{i−1}) / |e_i|².
        """
        columns = np.ascontiguousarray(points.T)
        x, y, z = columns[:, self.around] - columns[:, self.centre, None]
        x1, y1, z1 = (np.roll(each, -1, axis=1) for each in (x, y, z))
        nx, ny, nz = y * z1 - z * y1, z * x1 - x * z1, x * y1 - y * x1
        area = np.sqrt(nx * nx + ny * ny + nz * nz)
        sums = np.arctan2(area, x * x1 + y * y1 + z * z1).sum(axis=1) - 2 * np.pi
        if not with_gradient:
            return sums, sums
        area = np.maximum(area, np.finfo(float).tiny)
        dx, dy, dz = (n - np.roll(n, 1, axis=1) for n in (nx / area, ny / area, nz / area))
        square = np.maximum(x * x + y * y + z * z, np.finfo(float).tiny)
        return sums, np.stack([y * dz - z * dy, z * dx - x * dz, x * dy - y * dx]) / square
