"""Creases in groups that fold alike, in a suggested order of folding.

The order follows from the pattern alone: flat forms close from the middle outward, because every
ring of creases carries those outside it; what folds onto itself (±180°) comes last, when the walls
beside it stand.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill.tolerances import CLOSED_DEG

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST_GROUPS = 16
"""More than these fit no table; then creases that fold less alike are put together."""
_GAPS = ((0.05, 0.001), (1.0, 0.01), (5.0, 0.05), (15.0, 0.2), (360.0, 2.0))
"""Degrees, and shares of the pattern's size, below which neighbours count as alike."""


@dataclass(frozen=True, eq=False)
class CreaseGroup:
    """Creases of one assignment that fold by about one angle at about one distance."""

    letter: str
    """A, B, C … in the order of folding."""
    assignment: Assignment
    angle: float
    """deg, unsigned, the mean."""
    distance: float
    """mm from the pattern's middle to the creases' middles, the mean."""
    edges: Indices
    """(k,) indices into the pattern's edges."""

    @property
    def is_closed(self) -> bool:
        """Whether the sheet folds onto itself here."""
        return self.angle >= 180 - CLOSED_DEG


def groups(pattern: CreasePattern) -> list[CreaseGroup]:
    """Return the creases in groups, in the suggested order of folding; flat lines are left out."""
    found: list[Indices] = []
    for degrees, share in _GAPS:
        found = _alike(pattern, degrees, share * pattern.size)
        if len(found) <= MOST_GROUPS:
            break
    unnamed = [_group(pattern, edges, "") for edges in found]
    ordered = sorted(
        unnamed, key=lambda g: (g.is_closed, round(g.distance, 3), g.assignment, round(g.angle, 3))
    )
    return [_group(pattern, g.edges, _letter(k)) for k, g in enumerate(ordered)]


def middle(pattern: CreasePattern) -> Floats:
    """Return the centre of area (2,), mm: the axis of any pattern that has one."""
    corners = pattern.vertices[pattern.faces]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    centre: Floats = np.average(corners.mean(axis=1), axis=0, weights=area)
    return centre


def midpoints(pattern: CreasePattern, edges: Indices) -> Floats:
    """Return the middles (k, 2) of edges, mm."""
    middles: Floats = pattern.vertices[pattern.edges[edges]].mean(axis=1)
    return middles


def _distances(pattern: CreasePattern, edges: Indices) -> Floats:
    distances: Floats = np.linalg.norm(midpoints(pattern, edges) - middle(pattern), axis=1)
    return distances


def _alike(pattern: CreasePattern, degrees: float, mm: float) -> list[Indices]:
    folded = (Assignment.M, Assignment.V, Assignment.U)
    creases = np.flatnonzero(np.isin(pattern.assignments, folded))
    if not len(creases):
        return []
    angles = _clusters(np.abs(pattern.fold_angles[creases]), degrees)
    rings = _clusters(_distances(pattern, creases), mm)
    keys = np.column_stack([pattern.assignments[creases], angles, rings])
    _, which = np.unique(keys, axis=0, return_inverse=True)
    return [creases[which.ravel() == k] for k in range(int(which.max()) + 1)]


def _clusters(values: Floats, gap: float) -> Indices:
    """Number the values so that neighbours nearer than ``gap`` share a number."""
    order = np.argsort(values, kind="stable")
    labels = np.zeros(len(values), np.intp)
    labels[order[1:]] = np.cumsum(np.diff(values[order]) > gap)
    return labels


def _group(pattern: CreasePattern, edges: Indices, letter: str) -> CreaseGroup:
    return CreaseGroup(
        letter=letter,
        assignment=Assignment(int(pattern.assignments[edges[0]])),
        angle=float(np.abs(pattern.fold_angles[edges]).mean()),
        distance=float(_distances(pattern, edges).mean()),
        edges=edges,
    )


def _letter(k: int) -> str:
    return chr(ord("A") + k)
