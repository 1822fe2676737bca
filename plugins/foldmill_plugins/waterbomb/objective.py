"""What a fit makes small: five sums of squares, the means over the parts of the form.

near      distance of a vertex from the target, in edges
drift     how far a vertex has moved along the target since the start, in edges: without it strips
          collapse into spikes whose tips are close, and the rim leaves that of the target
folds     how far a crease is folded beyond its bounds, in rad: without it the form crumples
slivers   by how much a facet's least altitude falls short, in edges
contacts  by how much facets that a step pushed through each other are too near, in edges
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.barrier import altitudes
from foldmill_plugins.waterbomb.contact import Contacts
from foldmill_plugins.waterbomb.distance import Target
from foldmill_plugins.waterbomb.hinge import Creases, beyond
from foldmill_plugins.waterbomb.nearness import Nearness
from foldmill_plugins.waterbomb.options import FitOptions
from foldmill_plugins.waterbomb.surfaces import Surface
from foldmill_plugins.waterbomb.topology import Flags, Indices, Topology
from foldmill_plugins.waterbomb.unknowns import Parts, Unknowns

Floats = NDArray[np.float64]

STIFF = 30.0
"""Weight of folds and slivers beside the distance: bounds give way by about 1° and 1/100 edge."""
GAP = 0.02
"""Edges by which facets that met on the way are kept apart."""


@dataclass(frozen=True, eq=False)
class Objective:
    """The sums over a tessellation, of which one part stands for all that are alike."""

    target: Target
    unknowns: Unknowns
    options: FitOptions
    start: Floats
    """(V, 3) where drift is counted from."""
    edge: float
    """The mean length of an edge at the start."""
    vertices: Indices
    is_rim: Flags
    """(vertices,) whether each lies on the boundary."""
    creases: Creases
    faces: Indices
    contacts: Contacts
    weights: tuple[Floats, Floats, Floats]
    """Square roots of the shares that vertices, creases and faces have in their mean."""

    @classmethod
    def of(
        cls,
        surface: Surface,
        topology: Topology,
        side: int,
        unknowns: Unknowns,
        start: Floats,
        options: FitOptions,
    ) -> Objective:
        """Return the objective of a tessellation that is developed: start (V, 3)."""
        creases = Creases.of(topology, side)
        all_vertices = np.arange(len(start))[:, None]
        some = [unknowns.parts(each) for each in (all_vertices, creases.quads, topology.faces)]
        ends = start[topology.edges]
        edge = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())
        return cls(
            Target.of(surface),
            unknowns,
            options,
            start,
            edge,
            some[0].rows,
            ~topology.is_interior[some[0].rows],
            creases.chosen(some[1].rows),
            topology.faces[some[2].rows],
            Contacts.of(start, topology.faces, np.zeros((0, 2), np.intp)),
            (_shares(some[0]), _shares(some[1]), _shares(some[2])),
        )

    def value(self, points: Floats) -> float:
        """Return the sum at points (V, 3)."""
        values = self._values(points, self._nearness(points))
        return float(sum((each**2).sum() for each in values))

    def linearised(self, points: Floats) -> tuple[Floats, Any]:
        """Return the residuals (m,) whose squares are summed, and their derivatives (m, n)."""
        from scipy.sparse import vstack

        nearness = self._nearness(points)
        values = self._values(points, nearness)
        slopes = self._slopes(points, nearness, values)
        rows = [self.unknowns.derivatives(*each) for each in slopes]
        return np.concatenate([each.ravel() for each in values]), vstack(rows).tocsr()

    def _nearness(self, points: Floats) -> Nearness:
        return Nearness.of(self.target, points[self.vertices])

    def _drag(self) -> Floats:
        pull = np.where(self.is_rim, self.options.rim, self.options.tangential)
        drag: Floats = self.weights[0] * np.sqrt(pull) / self.edge
        return drag

    def _values(self, points: Floats, nearness: Nearness) -> list[Floats]:
        vertex, crease, face = self.weights
        drift = np.einsum("nij,nj->ni", nearness.along, (points - self.start)[self.vertices])
        bounds = np.radians([self.options.lowest, self.options.highest])
        folds = beyond(self.creases.folds(points), *bounds)
        height = altitudes(points, self.faces)[0] / self.edge - self.options.altitude
        gaps = self.contacts.heights(points) / self.edge - GAP
        return [
            nearness.away * (vertex / self.edge)[:, None],
            drift * self._drag()[:, None],
            np.sqrt(STIFF) * crease * folds,
            np.sqrt(STIFF) * face * np.minimum(height, 0.0),
            np.sqrt(STIFF / len(self.vertices)) * np.minimum(gaps, 0.0),
        ]

    def _slopes(
        self, points: Floats, nearness: Nearness, values: list[Floats]
    ) -> list[tuple[Floats, Indices]]:
        """Return derivatives (m, k, 3) by corners (m, k), term by term."""
        vertex, crease, face = self.weights
        alone = np.repeat(self.vertices, 3)[:, None]
        near = nearness.off * (vertex / self.edge)[:, None, None]
        drift = nearness.along * self._drag()[:, None, None]
        folds = self.creases.slopes(points) * (np.sqrt(STIFF) * crease)[:, None, None]
        _, heights, corners = altitudes(points, self.faces)
        heights = heights * (np.sqrt(STIFF) * face / self.edge)[:, None, None]
        bent, low = np.flatnonzero(values[2]), np.flatnonzero(values[3])
        return [
            (near.reshape(-1, 1, 3), alone),
            (drift.reshape(-1, 1, 3), alone),
            _only(folds, bent, self.creases.quads),
            _only(heights, low, corners),
            self._contact_slopes(values[4]),
        ]

    def _contact_slopes(self, values: Floats) -> tuple[Floats, Indices]:
        arrows = self.contacts.arrows * (np.sqrt(STIFF / len(self.vertices)) / self.edge)
        both = np.stack([arrows, -arrows], axis=1)
        ends = np.column_stack([self.contacts.upper, self.contacts.lower])
        return _only(both, np.flatnonzero(values), ends)


def _only(slopes: Floats, rows: Indices, corners: Indices) -> tuple[Floats, Indices]:
    """Return slopes that are 0 in other rows than these, and the corners they belong to."""
    out = np.zeros_like(slopes)
    out[rows] = slopes[rows]
    return out, corners


def _shares(parts: Parts) -> Floats:
    shares: Floats = np.sqrt(parts.counts / parts.counts.sum())
    return shares
