"""Mirror a half wedge and turn it N times: the whole pattern and its folded form.

A half wedge is a list of points, each on line l1, on line l2, in the centre, or inside, and of
triangles over them. Points on a line are shared between neighbouring half wedges; points inside
appear twice per wedge, and may coincide in space where a tuck is folded away between them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from foldmill import planar
from foldmill.axisymmetric.strip import Strip
from foldmill.design import Fold, Symmetry
from foldmill.folded import FoldedForm, assign, fold_angles
from foldmill.pattern import CreasePattern
from foldmill.tolerances import DISH
from foldmill.vectors import cross

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
VertexKey = tuple[int, int, bool]
EdgeSigns = dict[tuple[int, int], int]


class Seat(Enum):
    """Where a point of the half wedge lies, which decides with whom it is shared."""

    CENTRE = "centre"
    L1 = "l1"
    L2 = "l2"
    INSIDE = "inside"


@dataclass(frozen=True, eq=False)
class HalfWedge:
    """The part that is mirrored about l1 and turned N times.

    flat : (m, 2) mm; spatial : (m, 3) mm, of the copy that is not mirrored; seats : m;
    faces : (f, 3), counter-clockwise from above. A point on a line whose ``spatial`` lies off its
    plane (the tip of a tuck) is turned, never mirrored: all N tucks fold the same way.
    """

    order: int
    flat: Floats
    spatial: Floats
    seats: tuple[Seat, ...]
    faces: Indices
    one_sided: bool

    @classmethod
    def of(cls, strip: Strip) -> HalfWedge:
        """Return the strip's triangles as a half wedge."""
        count = len(strip.flat)
        seats = tuple(_seat(i, strip.off_line) for i in range(count))
        faces = [(i - 2, i - 1, i) if i % 2 == 0 else (i - 2, i, i - 1) for i in range(2, count)]
        return cls(
            strip.order,
            strip.flat,
            strip.spatial,
            seats,
            np.array(faces, np.intp).reshape(-1, 3),
            strip.one_sided,
        )


def _seat(i: int, off_line: tuple[int, ...]) -> Seat:
    if i == 0:
        return Seat.CENTRE
    if i in off_line:
        return Seat.INSIDE
    return Seat.L2 if i % 2 == 0 else Seat.L1


def _key(point: int, seat: Seat, turn: int, mirrored: bool, order: int) -> VertexKey:
    if seat is Seat.CENTRE:
        return (point, 0, False)
    if seat is Seat.INSIDE:
        return (point, turn, mirrored)
    # l2 of a mirrored half wedge is l2 of the wedge before it.
    return (point, (turn - (mirrored and seat is Seat.L2)) % order, False)


_TOPOLOGY = ("edge_faces", "edge_origins", "rim")
"""What a rosette knows of itself whatever the positions are."""


@dataclass(frozen=True, eq=False)
class Rosette:
    """A half wedge, mirrored and turned: the welded topology, and where each vertex came from."""

    half: HalfWedge
    edges: Indices
    faces: Indices
    origin: Indices
    """(V,) the point of the half wedge behind each vertex."""
    turn: Indices
    """(V,) by how many wedges it is turned."""
    mirrored: NDArray[np.bool_]
    """(V,) whether it is mirrored before it is turned."""

    @cached_property
    def flat(self) -> Floats:
        """(V, 2) mm."""
        return self._spread(self.half.flat)

    @cached_property
    def spatial(self) -> Floats:
        """(V, 3) mm."""
        return self._spread(self.half.spatial)

    @cached_property
    def edge_faces(self) -> Indices:
        """(E, 2) face left and right of each edge."""
        return planar.edge_faces(self.edges, self.faces)

    @cached_property
    def fold_angles(self) -> Floats:
        """(E,) deg, seen from above; near ±180 the sign is noise."""
        return fold_angles(self.spatial, self.edges, self.faces, self.edge_faces)

    @property
    def seams(self) -> Indices:
        """(S, 2) vertices that are two in the pattern and one in the closed form."""
        return np.zeros((0, 2), np.intp)

    @cached_property
    def rim(self) -> Indices:
        """The vertices of the outline, ascending."""
        return np.unique(self.edges[(self.edge_faces < 0).any(axis=1)])

    @cached_property
    def edge_origins(self) -> Indices:
        """(E, 2) the two points of the half wedge behind each edge, ascending."""
        ends: Indices = np.sort(self.origin[self.edges], axis=1)
        return ends

    def moved(self, half: HalfWedge) -> Rosette:
        """Return the same topology over other positions; what follows from it alone is kept."""
        other = replace(self, half=half)
        known = {name: self.__dict__[name] for name in _TOPOLOGY if name in self.__dict__}
        other.__dict__.update(known)
        return other

    def wedge_faces(self, faces: Indices) -> Indices:
        """Return the faces of the first wedge, plain and mirrored, by their half-wedge numbers."""
        return np.concatenate([faces, faces + len(self.half.faces)])

    def _spread(self, spots: Floats) -> Floats:
        return self.turned(spots, np.pi / self.half.order)

    def turned(self, spots: Floats, theta: float) -> Floats:
        """Return points (m, k) of the half wedge mirrored, and turned by 2·theta (rad) a wedge."""
        out = spots[self.origin]
        out[self.mirrored, 1] *= -1
        angle = 2 * theta * self.turn
        cos, sin = np.cos(angle), np.sin(angle)
        x, y = out[:, 0].copy(), out[:, 1].copy()
        out[:, 0], out[:, 1] = cos * x - sin * y, sin * x + cos * y
        return out


def assemble(half: HalfWedge) -> Rosette:
    """Weld N turned and mirrored copies by what they are, not by where they lie."""
    return weld(Rosette, half, _key)


AnyRosette = TypeVar("AnyRosette", bound=Rosette)
Key = Callable[[int, Seat, int, bool, int], VertexKey]


def weld(kind: type[AnyRosette], half: HalfWedge, key_of: Key) -> AnyRosette:
    """Weld N copies of a half wedge and its mirror image wherever their keys are one.

    key_of : (point, seat, turn, whether mirrored, N) → (point, turn, whether mirrored)
    """
    index: dict[VertexKey, int] = {}
    used = list(dict.fromkeys(half.faces.ravel().tolist()))
    number = np.zeros(len(half.seats), np.intp)
    copies: list[Indices] = []
    for turn in range(half.order):
        for mirrored in (False, True):
            for point in used:
                key = key_of(point, half.seats[point], turn, mirrored, half.order)
                number[point] = index.setdefault(key, len(index))
            corners = number[half.faces]
            copies.append(corners[:, ::-1] if mirrored else corners)
    faces = np.concatenate(copies)
    edges, _ = planar.unique_pairs(planar.face_sides(faces)[0])
    origin, turns, mirrors = (np.array(column) for column in zip(*index, strict=True))
    return kind(half, edges, faces, origin, turns, mirrors.astype(bool))


def fold(rose: Rosette, closed: EdgeSigns | None = None, *, wedge_decides: bool) -> Fold:
    """Return the whole fold, its front on the outside of the form.

    closed : sign (+1 valley, -1 mountain, seen from above) of the creases that fold to ±180, by the
    numbers of their two points in the half wedge.
    wedge_decides : whether the half wedge alone decides about penetration (false with tucks).
    """
    signs = _signs(rose, closed or {})
    measured, flat, faces, around = rose.fold_angles, rose.flat, rose.faces, rose.edge_faces
    if is_inside_out(rose):
        # Look at the sheet from its other face: the pattern mirrors, every fold changes its sign.
        flat, faces, around = flat * np.array([1.0, -1.0]), faces[:, ::-1], around[:, ::-1]
        measured, signs = -measured, -signs
    codes, angles = assign(measured, around, signs)
    pattern = CreasePattern(flat, rose.edges, codes, angles, faces)
    half = rose.half
    wedge = np.arange(len(half.faces))
    symmetry = Symmetry(half.order, wedge, half.one_sided and wedge_decides)
    return Fold(pattern, FoldedForm(rose.spatial, rose.seams), symmetry)


def _signs(rose: Rosette, closed: EdgeSigns) -> Indices:
    """Return the sign (E,) stated of every edge, 0 where none is."""
    table = np.zeros((len(rose.half.seats),) * 2, np.intp)
    for ends, sign in closed.items():
        table[ends] = sign
    first, last = rose.edge_origins.T
    signs: Indices = table[first, last]
    return signs


def is_inside_out(rose: Rosette) -> bool:
    """Tell whether the upper side of the sheet is the inside of the dished form."""
    spots = rose.spatial - rose.spatial[rose.rim].mean(axis=0)
    a, b, c = (spots[rose.faces[:, k]] for k in range(3))
    volume = float((a * cross(b, c)).sum()) / 6
    return volume < -(DISH * float(np.abs(rose.spatial).max()) ** 3)
