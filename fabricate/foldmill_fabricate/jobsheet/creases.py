"""Creases in groups that fold alike, lettered from where the pattern begins to where it ends.

A pattern that repeats has few kinds of creases: in rings round its middle, or in rows of a strip.
One that does not has nearly as many angles as creases; there a group is a range of angles.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill.tolerances import CLOSED_DEG

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST_GROUPS = 30
"""More than these fit no table; then creases that fold less alike are put together."""
_GAPS = ((0.05, 0.001), (1.0, 0.01))
"""Degrees, and shares of the pattern's size, below which neighbours count as alike."""
_NARROW = 0.03
"""Share of the pattern's size: what is wider is no ring and no row."""
_RANGES = (5.0, 10.0, 15.0, 20.0, 30.0, 60.0, 181.0)
"""Degrees: how wide the ranges of angles are where creases are not alike."""


@dataclass(frozen=True, eq=False)
class CreaseGroup:
    """Creases of one assignment that fold by about one angle at about one place."""

    letter: str
    """A, B … Z, AA … in order of place, what folds onto itself last."""
    assignment: Assignment
    angle: float
    """deg, unsigned, the mean."""
    spread: float
    """deg: how much its angles differ."""
    distance: float
    """mm; where its creases are in their arrangement, the mean."""
    edges: Indices
    """(k,) indices into the pattern's edges."""

    @property
    def is_closed(self) -> bool:
        """Whether the sheet folds onto itself here."""
        return self.angle >= 180 - CLOSED_DEG


@dataclass(frozen=True, eq=False)
class Arrangement:
    """How the creases of a pattern lie: in rings, in rows, or in no order that repeats."""

    kind: Literal["rings", "rows", "none"]
    name: str
    """Of the column of places, for people."""
    groups: list[CreaseGroup]


def groups(pattern: CreasePattern) -> list[CreaseGroup]:
    """Return the creases in groups, in order of place; flat lines are left out."""
    return arrange(pattern).groups


def arrange(pattern: CreasePattern) -> Arrangement:
    """Return the groups, and how they lie: whatever puts the creases into the fewest groups."""
    folded = (Assignment.M, Assignment.V, Assignment.U)
    creases = np.flatnonzero(np.isin(pattern.assignments, folded))
    rings = _distances(pattern)
    if not len(creases):
        return Arrangement("none", "from the middle", [])
    ways: tuple[tuple[Literal["rings", "rows"], str, Floats], ...] = (
        ("rings", "from the middle", rings),
        *(("rows", name, places) for name, places in _rows(pattern)),
    )
    for degrees, share in _GAPS:
        sorted_ways = [_alike(pattern, creases, w[2], degrees, share * pattern.size) for w in ways]
        best = min(range(len(ways)), key=lambda k: len(sorted_ways[k]))
        if len(sorted_ways[best]) <= MOST_GROUPS:
            kind, name, places = ways[best]
            found = _lettered(pattern, sorted_ways[best], places)
            narrow = all(np.ptp(places[g.edges]) <= _NARROW * pattern.size for g in found)
            repeats = narrow and len(creases) >= 3 * len(found)
            return Arrangement(kind if repeats else "none", name, found)
    return Arrangement("none", "from the middle", _in_ranges(pattern, creases, rings))


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


def _every(pattern: CreasePattern) -> Floats:
    return midpoints(pattern, np.arange(len(pattern.edges)))


def _distances(pattern: CreasePattern) -> Floats:
    distances: Floats = np.linalg.norm(_every(pattern) - middle(pattern), axis=1)
    return distances


def _rows(pattern: CreasePattern) -> list[tuple[str, Floats]]:
    """Return names and places (E,) across a strip that lies along x, or along y."""
    low = pattern.vertices.min(axis=0)
    x, y = (_every(pattern) - low).T
    return [("from the lower edge", y), ("from the left edge", x)]


def _alike(
    pattern: CreasePattern, creases: Indices, places: Floats, degrees: float, mm: float
) -> list[Indices]:
    angles = _clusters(np.abs(pattern.fold_angles[creases]), degrees)
    rows = _clusters(places[creases], mm)
    return _split(creases, np.column_stack([pattern.assignments[creases], angles, rows]))


def _in_ranges(pattern: CreasePattern, creases: Indices, places: Floats) -> list[CreaseGroup]:
    angles = np.abs(pattern.fold_angles[creases])
    found: list[Indices] = []
    for width in _RANGES:
        ranges = np.floor(np.minimum(angles, 180 - 1e-6) / width).astype(np.intp)
        found = _split(creases, np.column_stack([pattern.assignments[creases], ranges]))
        if len(found) <= MOST_GROUPS:
            break
    return _lettered(pattern, found, places)


def _split(creases: Indices, keys: NDArray[np.integer]) -> list[Indices]:
    _, which = np.unique(keys, axis=0, return_inverse=True)
    return [creases[which.ravel() == k] for k in range(int(which.max()) + 1)]


def _clusters(values: Floats, gap: float) -> Indices:
    """Number the values so that neighbours nearer than ``gap`` share a number."""
    order = np.argsort(values, kind="stable")
    labels = np.zeros(len(values), np.intp)
    labels[order[1:]] = np.cumsum(np.diff(values[order]) > gap)
    return labels


def _lettered(pattern: CreasePattern, found: list[Indices], places: Floats) -> list[CreaseGroup]:
    unnamed = [_group(pattern, edges, places, "") for edges in found]
    ordered = sorted(
        unnamed, key=lambda g: (g.is_closed, round(g.distance, 3), g.assignment, round(g.angle, 3))
    )
    return [_group(pattern, g.edges, places, _letter(k)) for k, g in enumerate(ordered)]


def _group(pattern: CreasePattern, edges: Indices, places: Floats, letter: str) -> CreaseGroup:
    angles = np.abs(pattern.fold_angles[edges])
    return CreaseGroup(
        letter=letter,
        assignment=Assignment(int(pattern.assignments[edges[0]])),
        angle=float(angles.mean()),
        spread=float(np.ptp(angles)),
        distance=float(places[edges].mean()),
        edges=edges,
    )


def _letter(k: int) -> str:
    """Return A, B … Z, AA, AB …"""
    return ("A" if k >= 26 else "") + chr(ord("A") + k % 26)
