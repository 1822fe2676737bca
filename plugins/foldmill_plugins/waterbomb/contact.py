"""Keep facets apart that a step would push through each other.

Two triangles that do not penetrate lie on both sides of a plane. Its normal is found among the
normals of both, the crosses of their sides and the normals of sides within their planes; along it
the lowest corner of one must stay above the highest corner of the other. Where both share a corner
the plane goes through it, and each must stay on its own side of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.check.intersection import penetrations
from foldmill_plugins.waterbomb.topology import Indices, Topology

Floats = NDArray[np.float64]

PARALLEL = 1e-9
"""Share of the longest cross product below which two sides are parallel."""


@dataclass(frozen=True, eq=False)
class Clashes:
    """Finds the facets that pass through each other, among those of one wedge where it decides."""

    edges: Indices
    faces: Indices

    @classmethod
    def of(cls, topology: Topology, *, is_symmetric: bool) -> Clashes:
        """Return the finder; symmetric: of a form that every half wedge repeats."""
        k = topology.k[topology.faces]
        wedge = (k <= 1).all(axis=1)
        return cls(topology.edges, topology.faces[wedge] if is_symmetric else topology.faces)

    def pairs(self, points: Floats) -> Indices:
        """Return the pairs (n, 2) of rows of `faces` that do; points : (V, 3)."""
        return penetrations(points, self.edges, self.faces)


@dataclass(frozen=True, eq=False)
class Contacts:
    """Corners that must stay above others along fixed arrows."""

    upper: Indices
    """(n,)"""
    lower: Indices
    """(n,)"""
    arrows: Floats
    """(n, 3) unit vectors."""

    @classmethod
    def of(cls, points: Floats, faces: Indices, pairs: Indices) -> Contacts:
        """Return what keeps pairs (k, 2) of faces (F, 3) apart that are apart at points (V, 3)."""
        rows = [row for one, two in pairs for row in _rows(points, faces[one], faces[two])]
        upper, lower = (np.array([row[n] for row in rows], np.intp) for n in (0, 1))
        return cls(upper, lower, np.array([row[2] for row in rows]).reshape(-1, 3))

    def heights(self, points: Floats) -> Floats:
        """Return by how much (n,) the upper corners are above the lower ones."""
        rise = points[self.upper] - points[self.lower]
        found: Floats = np.einsum("ij,ij->i", rise, self.arrows)
        return found


def _rows(points: Floats, one: Indices, two: Indices) -> list[tuple[int, int, Floats]]:
    """Return corners above, corners below and arrows for two triangles of corners (3,)."""
    shared = np.intersect1d(one, two)
    axes = _axes(points[one], points[two])
    axes = np.concatenate([axes, -axes])
    if len(shared) == 0:
        low, high = points[one] @ axes.T, points[two] @ axes.T
        best = int((low.min(axis=0) - high.max(axis=0)).argmax())
        return [(one[low[:, best].argmin()], two[high[:, best].argmax()], axes[best])]
    hinge = shared[0]
    ups, downs = np.setdiff1d(one, shared), np.setdiff1d(two, shared)
    low, high = (points[ups] - points[hinge]) @ axes.T, (points[downs] - points[hinge]) @ axes.T
    best = int(np.minimum(low.min(axis=0), -high.max(axis=0)).argmax())
    return [
        (ups[low[:, best].argmin()], hinge, axes[best]),
        (hinge, downs[high[:, best].argmax()], axes[best]),
    ]


def _axes(one: Floats, two: Floats) -> Floats:
    """Return the unit normals (n, 3) of planes that may part two triangles (3, 3)."""
    sides = [np.roll(each, -1, axis=0) - each for each in (one, two)]
    normals = [np.cross(each[0], each[1]) for each in sides]
    between = np.cross(sides[0][:, None], sides[1][None]).reshape(-1, 3)
    within = [np.cross(each, normal) for each, normal in zip(sides, normals, strict=True)]
    axes = np.vstack([*normals, between, *within])
    long = np.linalg.norm(axes, axis=1)
    units: Floats = axes[long > PARALLEL * long.max()]
    units /= np.linalg.norm(units, axis=1, keepdims=True)
    return units
