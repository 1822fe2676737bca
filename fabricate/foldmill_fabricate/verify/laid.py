"""Every copy of a pattern as it lies on the sheet, put together to one drawing; for verification.

The edges of copy k (0, 1, 2 …) are those of the pattern, k times its number of edges later; so are
its vertices. Copies are laid out by the plan's placements alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill_fabricate.passes import Placement, Plan
from foldmill_fabricate.verify.slit import Slits, slits

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Laid:
    """The copies of a pattern on a sheet."""

    plan: Plan
    pattern: CreasePattern

    @cached_property
    def places(self) -> tuple[Placement, ...]:
        """Where each copy lies."""
        return (self.plan.placement, *self.plan.copies)

    @property
    def count(self) -> int:
        """How many copies there are."""
        return len(self.places)

    @cached_property
    def spots(self) -> Floats:
        """(k·V, 2) mm: turned about the pattern's origin, then shifted."""
        return np.vstack([self._spots(place) for place in self.places])

    def _spots(self, place: Placement) -> Floats:
        angle = np.radians(place.angle)
        x, y = self.pattern.vertices.T
        return np.column_stack(
            [
                x * np.cos(angle) - y * np.sin(angle) + place.dx,
                x * np.sin(angle) + y * np.cos(angle) + place.dy,
            ]
        )

    @cached_property
    def edges(self) -> Indices:
        """(k·E, 2) numbers of spots."""
        return self._numbered(self.pattern.edges)

    @cached_property
    def faces(self) -> Indices:
        """(k·F, 3) numbers of spots."""
        return self._numbered(self.pattern.faces)

    @cached_property
    def assignments(self) -> NDArray[np.uint8]:
        """(k·E,)"""
        return np.tile(self.pattern.assignments, self.count)

    @cached_property
    def fold_angles(self) -> Floats:
        """(k·E,) deg."""
        return np.tile(self.pattern.fold_angles, self.count)

    @cached_property
    def slits(self) -> Slits:
        """The slits of every copy."""
        own = slits(self.pattern)
        node = self._numbered(own.node[:, None])[:, 0]
        return Slits(np.tile(own.first, self.count), np.tile(own.second, self.count), node)

    @cached_property
    def outlines(self) -> list[Indices]:
        """The outermost loop of each copy, as numbers of spots; none without an outline."""
        loops = self.pattern.outline()
        size = len(self.pattern.vertices)
        return [loops[0] + k * size for k in range(self.count)] if loops else []

    def edges_of(self, copy: int) -> slice:
        """Return which edges belong to a copy, 0, 1, 2 …"""
        size = len(self.pattern.edges)
        return slice(copy * size, (copy + 1) * size)

    def split(self, edge: int) -> tuple[int, int]:
        """Return the copy of an edge, 0, 1, 2 …, and its number in the pattern."""
        return divmod(edge, len(self.pattern.edges))

    @cached_property
    def parts(self) -> list[object]:
        """Each copy as one area."""
        import shapely

        size = len(self.pattern.faces)
        triangles = shapely.polygons(self.spots[self.faces])
        return [
            shapely.coverage_union_all(triangles[k * size : (k + 1) * size])
            for k in range(self.count)
        ]

    def _numbered(self, table: Indices) -> Indices:
        """Repeat a table of vertex numbers for each copy."""
        size = len(self.pattern.vertices)
        return np.vstack([table + k * size for k in range(self.count)])
