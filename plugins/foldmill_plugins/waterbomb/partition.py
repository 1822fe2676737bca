"""A sheet in pieces: which facet is of which piece, and where pieces meet in space.

Terminology: a *joint* is an edge that is two in the pieces and one in space; the *host* holds a
glue tab there, the *land* is what the tab lies upon. A *seam* is a row of joints between the same
two pieces. Pieces keep the places of the whole flat sheet: an overlap between two of them is none.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold
from foldmill.axisymmetric.tabs import Joint
from foldmill.axisymmetric.tube import Sheet
from foldmill_plugins.waterbomb.topology import Topology

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Side = tuple[int, int, int, int]
"""A border edge: its face, its ends, the face's third corner."""


@dataclass(frozen=True)
class Seam:
    """A row of joints between two pieces, or between two borders of one."""

    number: int
    """From 1, another one for every seam of a piece; far seams may have the same."""
    host: int
    """Number of the piece that holds the tabs, from 0."""
    land: int
    joints: tuple[Joint, ...]
    """In order along the seam."""


@dataclass(frozen=True, eq=False)
class Partition:
    """The facets of a whole sheet, sorted into pieces that share no vertices."""

    fold: Fold
    """The whole sheet, over the opened topology."""
    cut: Topology
    origin: Indices
    """(V,) the vertex of the closed topology each vertex comes from."""
    columns: int
    rows: int

    @cached_property
    def piece(self) -> Indices:
        """(F,) number of each facet's piece, from 0, along u first."""
        faces, cut = self.cut.faces, self.cut
        ends = np.round(np.linspace(0, cut.n_u, self.columns + 1)) * 2
        column = np.searchsorted(ends, cut.k[faces].mean(axis=1), side="right") - 1
        strips = np.round(np.linspace(0, cut.n_v, self.rows + 1))
        row = np.searchsorted(strips, cut.j[faces[:, 0]], side="right") - 1
        numbers: Indices = (row * self.columns + column).astype(np.intp)
        return numbers

    @cached_property
    def _corners(self) -> tuple[Indices, Indices]:
        """The keys (n,) of all vertices of all pieces, and the faces (F, 3) over them."""
        count = len(self.cut.k)
        keys, faces = np.unique(
            self.piece[:, None] * count + self.fold.pattern.faces, return_inverse=True
        )
        return keys, faces.reshape(-1, 3).astype(np.intp)

    @property
    def faces(self) -> Indices:
        """(F, 3) over the pieces' own vertices."""
        return self._corners[1]

    @cached_property
    def of(self) -> Indices:
        """(n,) the vertex of the whole sheet that each vertex of a piece is."""
        whole: Indices = self._corners[0] % len(self.cut.k)
        return whole

    @cached_property
    def sheet(self) -> Sheet:
        """All pieces, flat where the whole sheet has them, in space where they belong."""
        form = self.fold.folded
        assert form is not None
        flat, spatial = self.fold.pattern.vertices[self.of], form.vertices[self.of]
        nothing = np.zeros((0, 2), np.intp)
        return Sheet(flat, spatial, edges_of(self.faces), self.faces, nothing)

    @cached_property
    def seams(self) -> tuple[Seam, ...]:
        """Every seam, sorted by its pieces."""
        rows: dict[tuple[int, int, bool], list[tuple[float, Joint]]] = defaultdict(list)
        for (f, a, b, c), (g, d, e, h) in self._pairs():
            partner = dict(zip(self.origin[self.of[[d, e]]].tolist(), (d, e), strict=True))
            ends = [partner[int(self.origin[self.of[x]])] for x in (a, b)]
            is_own = set(self.of[[a, b]].tolist()) != set(self.of[[d, e]].tolist())
            joint = Joint((a, b, c), (ends[0], ends[1], h))
            rows[int(self.piece[f]), int(self.piece[g]), is_own].append((self._place(a, b), joint))
        used: dict[int, set[int]] = defaultdict(set)
        found = []
        for (host, land, _), row in sorted(rows.items()):
            taken = used[host] | used[land]
            number = next(n for n in range(1, len(taken) + 2) if n not in taken)
            used[host].add(number)
            used[land].add(number)
            joints = tuple(joint for _, joint in sorted(row, key=lambda each: each[0]))
            found.append(Seam(number, host, land, joints))
        return tuple(found)

    def _place(self, a: int, b: int) -> float:
        """Return how far along its seam a joint is; one of u and v is the same all along it."""
        ends, cut = self.of[[a, b]], self.cut
        return float((cut.k[ends] + cut.j[ends] + 0.5 * cut.is_centre[ends]).sum())

    def _pairs(self) -> list[tuple[Side, Side]]:
        """Return the border edges that are one in space: (face, a, b, third corner), host first.

        The host has the lower number; of one piece, it is the side that comes later along u or v.
        """
        sides: dict[tuple[int, int], list[Side]] = defaultdict(list)
        for face, a, b, c in border_sides(self.faces):
            x, y = self.origin[self.of[[a, b]]].tolist()
            sides[min(x, y), max(x, y)].append((face, a, b, c))
        pairs = [sorted(row, key=self._rank) for row in sides.values() if len(row) == 2]
        return [(host, land) for host, land in pairs]

    def _rank(self, side: Side) -> tuple[int, int]:
        return int(self.piece[side[0]]), -int(self.of[[side[1], side[2]]].sum())


def border_sides(faces: Indices) -> list[Side]:
    """Return face, ends and third corner of every edge with one face."""
    corners = np.stack([faces, np.roll(faces, -1, axis=1), np.roll(faces, -2, axis=1)], axis=2)
    rows = np.column_stack([np.repeat(np.arange(len(faces)), 3), corners.reshape(-1, 3)])
    keys = np.sort(rows[:, 1:3], axis=1)
    _, first, uses = np.unique(keys, axis=0, return_index=True, return_counts=True)
    return [tuple(row) for row in rows[np.sort(first[uses == 1])].tolist()]


def edges_of(faces: Indices) -> Indices:
    """Return the edges (E, 2) of triangles (F, 3), each once, sorted."""
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges: Indices = np.unique(sides, axis=0)
    return edges
