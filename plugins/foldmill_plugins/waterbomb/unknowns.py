"""What a search may move, and one of every set of parts that symmetry keeps alike.

On a surface of revolution all vertices of an orbit move alike (sector.py), so that two numbers for
each orbit are all there is to find; and one crease or facet stands for all those like it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.sector import Sector
from foldmill_plugins.waterbomb.solve import Conditions
from foldmill_plugins.waterbomb.topology import Flags, Indices

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Parts:
    """Rows that stand for others."""

    rows: Indices
    """(n,)"""
    counts: Floats
    """(n,) how many each stands for, itself included."""


@dataclass(frozen=True, eq=False)
class Unknowns:
    """The numbers to be found, and how vertices follow from them."""

    conditions: Conditions
    """What makes the mesh developable, by the same numbers."""
    basis: Any
    """Sparse (3V, n): by how much each coordinate moves with each number."""
    orbit: Indices
    """(V,) number of the vertices that move alike."""

    @classmethod
    def of(cls, conditions: Conditions, is_free: Flags) -> Unknowns:
        """Return three numbers for each vertex that may move."""
        return cls(conditions, _plain(is_free), np.arange(len(is_free)))

    @classmethod
    def by_orbit(cls, sector: Sector) -> Unknowns:
        """Return two numbers for each orbit that may move."""
        return cls(sector, _by_orbit(sector), sector.orbit)

    def parts(self, corners: Indices) -> Parts:
        """Return one of all rows of corners (n, k) that are alike up to the order of corners."""
        keys = np.sort(self.orbit[corners], axis=1)
        _, rows, counts = np.unique(keys, axis=0, return_index=True, return_counts=True)
        return Parts(rows.astype(np.intp), counts.astype(np.float64))

    def derivatives(self, slopes: Floats, corners: Indices) -> Any:
        """Return the sparse derivatives (m, n) by the numbers.

        slopes : (m, k, 3) derivatives by the places of the corners (m, k).
        """
        from scipy.sparse import csr_matrix

        rows, wide = corners.shape
        columns = (3 * corners[:, :, None] + np.arange(3)).ravel()
        ends = 3 * wide * np.arange(rows + 1)
        shape = (rows, self.basis.shape[0])
        return csr_matrix((slopes.ravel(), columns, ends), shape=shape) @ self.basis


def _plain(is_free: Flags) -> Any:
    from scipy.sparse import identity

    return identity(3 * len(is_free), format="csc")[:, np.repeat(is_free, 3)].tocsr()


def _by_orbit(sector: Sector) -> Any:
    from scipy.sparse import coo_matrix

    column = sector.column[sector.orbit]
    free = np.flatnonzero(column >= 0)
    first = 2 * column[free]
    rows = np.concatenate([3 * free, 3 * free + 1, 3 * free + 2])
    columns = np.concatenate([first, first, first + 1])
    out = sector.outwards[free]
    values = np.concatenate([out[:, 0], out[:, 1], np.ones(len(free))])
    shape = (3 * len(column), 2 * int(sector.column.max() + 1))
    return coo_matrix((values, (rows, columns)), shape=shape).tocsr()
