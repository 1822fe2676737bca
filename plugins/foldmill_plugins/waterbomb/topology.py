"""How the vertices of a waterbomb tessellation hang together, and which crease folds which way.

Terminology: a *ring* is a row of vertices along u; ring j is at v_s + j·Δv. A *strip* lies between
two rings. The *half-index* k counts half steps of u. A *base* is a centre and the six vertices
about it: two *mids* (at the centre's k) and four *corners* (at k ± 1). Strips with an odd
number are shifted by half a base: the mid of one strip is a corner of the next (thesis 6.1.1).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment

Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]
Codes = NDArray[np.uint8]


@dataclass(frozen=True)
class Topology:
    """The graph of N_u × N_v bases, closed or open along u and along v.

    Vertices are numbered ring by ring, then centres strip by strip. An open strip with an odd
    number begins and ends with half a base.
    """

    n_u: int
    n_v: int
    is_u_closed: bool = False
    is_v_closed: bool = False

    @property
    def width(self) -> int:
        """How many vertices a ring has."""
        return 2 * self.n_u + (not self.is_u_closed)

    @property
    def rings(self) -> int:
        """How many rings there are."""
        return self.n_v + (not self.is_v_closed)

    @cached_property
    def centres(self) -> Indices:
        """(C, 2) half-index k and strip of every centre."""
        even = np.arange(1, 2 * self.n_u, 2)
        odd = np.arange(0, self.width, 2)
        rows = [np.column_stack([k, np.full(len(k), j)]) for j in range(self.n_v)
                for k in (odd if j % 2 else even,)]  # fmt: skip
        return np.concatenate(rows).astype(np.intp)

    @cached_property
    def k(self) -> Indices:
        """(V,) half-index of every vertex."""
        ring = np.tile(np.arange(self.width), self.rings)
        return np.concatenate([ring, self.centres[:, 0]]).astype(np.intp)

    @cached_property
    def j(self) -> Indices:
        """(V,) ring of a ring vertex, strip of a centre."""
        ring = np.repeat(np.arange(self.rings), self.width)
        return np.concatenate([ring, self.centres[:, 1]]).astype(np.intp)

    @cached_property
    def is_centre(self) -> Flags:
        """(V,)"""
        return np.arange(self.rings * self.width + len(self.centres)) >= self.rings * self.width

    @cached_property
    def slides(self) -> Indices:
        """(V,) +1 for the mid of the strip above, -1 for the mid of the strip below, 0 centres."""
        sign = np.where((self.k + self.j) % 2 == 1, 1, -1)
        signs: Indices = np.where(self.is_centre, 0, sign)
        return signs

    @cached_property
    def faces(self) -> Indices:
        """(F, 3) counter-clockwise in (u, v), base by base: C with BL BM, BM BR, BR TR, …"""
        k, j = self.centres.T
        centre = self.rings * self.width + np.arange(len(k))
        low, high = j % self.rings * self.width, (j + 1) % self.rings * self.width
        left, right = (k - 1) % self.width, (k + 1) % self.width
        rim = [low + left, low + k, low + right, high + right, high + k, high + left]
        faces = np.stack([np.column_stack([centre, rim[n], rim[(n + 1) % 6]]) for n in range(6)], 1)
        kept = np.ones((len(k), 6), bool)
        if not self.is_u_closed:
            kept[k == 0] = [False, True, True, True, False, False]
            kept[k == 2 * self.n_u] = [True, False, False, False, True, True]
        chosen: Indices = faces[kept].astype(np.intp)
        return chosen

    @cached_property
    def edges(self) -> Indices:
        """(E, 2) each once, sorted."""
        return self._edges_and_uses[0]

    @cached_property
    def _edges_and_uses(self) -> tuple[Indices, Indices]:
        sides = np.sort(self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        count = len(self.is_centre)
        keys, uses = np.unique(sides[:, 0] * count + sides[:, 1], return_counts=True)
        return np.column_stack(np.divmod(keys, count)).astype(np.intp), uses.astype(np.intp)

    @cached_property
    def assignments(self) -> Codes:
        """(E,) boundary; valley from a centre to its corners; mountain elsewhere.

        Seen from the side opposite to that to which the centres are displaced.
        """
        edges, uses = self._edges_and_uses
        to_corner = self.is_centre[edges[:, 1]] & (self.k[edges[:, 0]] != self.k[edges[:, 1]])
        codes = np.where(to_corner, Assignment.V, Assignment.M).astype(np.uint8)
        codes[uses == 1] = Assignment.B
        return codes

    @cached_property
    def is_interior(self) -> Flags:
        """(V,) whether six facets meet at a vertex; all others lie on the boundary."""
        flags: Flags = np.bincount(self.faces.ravel(), minlength=len(self.is_centre)) == 6
        return flags

    @cached_property
    def stars(self) -> tuple[Indices, Indices]:
        """The interior vertices (m,), and the six neighbours (m, 6) of each, counter-clockwise."""
        faces = self.faces
        corner = faces.ravel()
        after, before = np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
        kept = self.is_interior[corner]
        corner, after, before = corner[kept], after[kept], before[kept]
        order = np.argsort(corner, kind="stable")
        starts, ends = after[order].reshape(-1, 6), before[order].reshape(-1, 6)
        star = np.zeros_like(starts)
        star[:, 0] = starts[:, 0]
        for n in range(1, 6):
            here = starts == star[:, n - 1, None]
            star[:, n] = ends[np.arange(len(star)), here.argmax(axis=1)]
        return np.flatnonzero(self.is_interior), star

    def opened(self) -> Topology:
        """Return the topology once it is cut: along k = 0, and along ring 0."""
        return Topology(self.n_u, self.n_v)

    @cached_property
    def origin(self) -> Indices:
        """(V of the opened one,) the vertex each vertex of the opened topology comes from."""
        cut = self.opened()
        k, j = cut.k % self.width, cut.j % self.rings
        ring = j * self.width + k
        first = np.searchsorted(self.centres[:, 1], np.arange(self.n_v))
        centre = self.rings * self.width + first[cut.j % self.n_v] + k // 2
        spots: Indices = np.where(cut.is_centre, centre, ring).astype(np.intp)
        return spots
