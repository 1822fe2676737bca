"""The search on a surface of revolution, by one sector: as many unknowns whatever N_u is.

The least motion keeps the symmetry of the base mesh: every vertex stays in its mirror plane, and
all vertices of an *orbit* (one ring and one parity of k, or the centres of one strip) move alike.
So an orbit has two unknowns, r and z, and one row; all orbits have N_u vertices, so that the least
motion of the orbits is that of the vertices.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.jacobian import Stars
from foldmill_plugins.waterbomb.topology import Indices, Topology

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Sector:
    """The conditions of one vertex of every orbit."""

    stars: Stars
    """The first interior vertex of every orbit."""
    orbit: Indices
    """(V,) number of the orbit of each vertex."""
    outwards: Floats
    """(V, 2) unit vector from the axis through each vertex."""
    column: Indices
    """(orbits,) number among the orbits that may move, -1 for others."""

    @classmethod
    def of(cls, topology: Topology, stars: Stars, points: Floats) -> Sector:
        """Return the sector of a topology that closes along u, over a base mesh (V, 3)."""
        ring = 2 * topology.j + topology.k % 2
        orbit = np.where(topology.is_centre, 2 * topology.rings + topology.j, ring).astype(np.intp)
        _, first = np.unique(orbit[stars.centre], return_index=True)
        few = Stars(stars.centre[first], stars.around[first], stars.is_free)
        is_free = np.zeros(2 * topology.rings + topology.n_v, bool)
        is_free[orbit[stars.is_free]] = True
        column = np.where(is_free, np.cumsum(is_free) - 1, -1).astype(np.intp)
        flat = points[:, :2]
        return cls(few, orbit, flat / np.linalg.norm(flat, axis=1, keepdims=True), column)

    def residual(self, points: Floats) -> Floats:
        """Return the angle sum minus 2π of every orbit, rad."""
        return self.stars.residual(points)

    def linearised(self, points: Floats) -> tuple[Floats, Any]:
        """Return the residual and the Jacobian by r and z of the orbits that may move."""
        from scipy.sparse import coo_matrix

        residual, gradient = self.stars.evaluate(points, with_gradient=True)
        whole = np.concatenate([-gradient.sum(axis=2)[:, :, None], gradient], axis=2)
        vertices = np.column_stack([self.stars.centre, self.stars.around])
        out = self.outwards[vertices]
        by_r = whole[0] * out[..., 0] + whole[1] * out[..., 1]
        column = self.column[self.orbit[vertices]]
        kept = column >= 0
        row = np.broadcast_to(np.arange(len(vertices))[:, None], column.shape)[kept]
        entries = (np.tile(row, 2), np.concatenate([2 * column[kept], 2 * column[kept] + 1]))
        values = np.concatenate([by_r[kept], whole[2][kept]])
        shape = (len(vertices), 2 * int(self.column.max() + 1))
        return residual, coo_matrix((values, entries), shape=shape).tocsr()

    def moved(self, points: Floats, step: Floats) -> Floats:
        """Return all vertices after a step of the orbits."""
        column = self.column[self.orbit]
        by = np.where((column >= 0)[:, None], step.reshape(-1, 2)[column], 0.0)
        out: Floats = points + np.column_stack([by[:, :1] * self.outwards, by[:, 1]])
        return out
