"""A half strip between parallel lines, mirrored and set side by side N times: an open tube.

The pattern is a band 2·N·w wide. In space its two long borders meet: each vertex of that seam is
two in the pattern and one in space.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.along_arc import in_space
from foldmill.axisymmetric.rosette import HalfWedge, Rosette, Seat, VertexKey, weld
from foldmill.axisymmetric.strip import on_one_side
from foldmill.folded import FoldedForm, fold_pattern
from foldmill.pattern import CreasePattern
from foldmill.tolerances import DISH

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Tube(Rosette):
    """A half wedge, mirrored and repeated: open along the first and the last l2 of the pattern."""

    @cached_property
    def flat(self) -> Floats:
        """(V, 2) mm; l1 of the first wedge is x = 0."""
        out = self.half.flat[self.origin]
        out[self.mirrored, 0] *= -1
        out[:, 0] += 2 * self.half.flat[:, 0].max() * self.turn
        return out

    @cached_property
    def seams(self) -> Indices:
        """(S, 2) the vertices of the first and the last l2, upwards: two in the pattern."""
        on_l2 = np.array([seat is Seat.L2 for seat in self.half.seats])[self.origin]
        first, last = (np.flatnonzero(on_l2 & (self.turn == k)) for k in (-1, self.half.order - 1))
        pairs: Indices = np.column_stack([first, last])
        return pairs[np.argsort(self.origin[first])]


def half_wedge(order: int, flat: Floats, meridian: Floats) -> HalfWedge:
    """Return the triangles (i-2, i-1, i) over points p_1 … p_T as a half wedge.

    flat : (T, 2) mm, l1 at x = 0; meridian : (T, 2) as (r, z), mm, in planes Π1 and Π2 by turns.
    """
    count = len(flat)
    faces = [(k - 2, k - 1, k) if k % 2 == 0 else (k - 2, k, k - 1) for k in range(2, count)]
    seats = tuple(Seat.L1 if k % 2 == 0 else Seat.L2 for k in range(count))
    one_sided = on_one_side(meridian)
    spatial = in_space(meridian, np.pi / order)
    return HalfWedge(order, flat, spatial, seats, np.array(faces, np.intp), one_sided)


def assemble(half: HalfWedge) -> Tube:
    """Weld N copies side by side; the first and the last l2 stay apart."""
    return weld(Tube, half, _key)


def _key(point: int, seat: Seat, turn: int, mirrored: bool, _: int) -> VertexKey:
    return (point, turn - (mirrored and seat is Seat.L2), False)


@dataclass(frozen=True, eq=False)
class Sheet:
    """A triangulated sheet, flat and in space, seen from above: before it is turned over."""

    flat: Floats
    """(V, 2) mm."""
    spatial: Floats
    """(V, 3) mm."""
    edges: Indices
    """(E, 2)"""
    faces: Indices
    """(F, 3)"""
    seams: Indices
    """(S, 2) vertices that are two in the pattern and one in space."""

    @classmethod
    def of(cls, tube: Tube) -> Sheet:
        """Return a tube as a sheet."""
        return cls(tube.flat, tube.spatial, tube.edges, tube.faces, tube.seams)

    @property
    def is_inside_out(self) -> bool:
        """Whether the upper side looks at the axis, by area and distance: ∫(x, y, 0)·n dA < 0.

        For a closed tube that is twice its volume up to the share of its open ends, and for a lid
        of any height it is none, so that the two ends do not decide.
        """
        corners = self.spatial[self.faces]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
        outwards = float((corners.mean(axis=1) * normal)[:, :2].sum())
        return outwards < -(DISH * float(np.abs(self.spatial).max()) ** 3)

    def finish(self, closed: Indices) -> tuple[CreasePattern, FoldedForm]:
        """Return pattern and folded form, the front on the outside.

        closed : the signs of the first edges, seen from above, where they fold to ±180.
        """
        flat, faces = self.flat, self.faces
        signs = np.zeros(len(self.edges), np.intp)
        signs[: len(closed)] = closed
        if self.is_inside_out:
            flat, faces, signs = flat * np.array([-1.0, 1.0]), faces[:, ::-1], -signs
        pattern, form = fold_pattern(flat, self.spatial, self.edges, faces, signs)
        return pattern, replace(form, seams=self.seams)


class Glued(Protocol):
    """A sheet with paper along its seam that closes the tube: tabs, or an overlap."""

    @property
    def sheet(self) -> Sheet:
        """The sheet with that paper; old vertices keep their numbers."""

    def carry(self, spatial: Floats) -> Floats:
        """Return old vertices (V, 3) of a form on its way, followed by the new ones."""
