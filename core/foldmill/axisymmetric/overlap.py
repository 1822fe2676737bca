"""An overlap along a seam: paper beyond the one border that lies upon the facets of the other.

It continues the pattern as if a wedge more began there, up to a straight edge: so it has the
creases of the facets it lies upon, mountain as mountain, and is in contact with them everywhere.
While the tube opens it moves as that wedge would. Its ends lean inwards by the taper.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.tube import Sheet, Tube
from foldmill.errors import ImpossibleGeometry, InvalidParameters
from foldmill.tolerances import COINCIDENT_MM

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Overlap:
    """A sheet with its overlap: new vertices on the facets of one half wedge, mirrored."""

    sheet: Sheet
    """The sheet with its overlap; old vertices keep their numbers."""
    behind: Indices
    """(k, 3) corners of the last half wedge's facet whose mirror image holds each new vertex."""
    shares: Floats
    """(k, 3) how much of each corner."""
    border: Indices
    """The vertices of the border where it begins, in the plane that mirrors."""

    def carry(self, spatial: Floats) -> Floats:
        """Return old vertices (V, 3) followed by the new ones, as the next wedge would have them.

        spatial : the form on its way, symmetric about the plane of the border and the z axis.
        """
        rim = spatial[self.border, :2]
        across = rim[np.argmax(np.hypot(*rim.T))][::-1] * [1.0, -1.0]
        across /= np.hypot(*across)
        spots = np.einsum("ki,kij->kj", self.shares, spatial[self.behind])
        spots[:, :2] -= 2 * np.outer(spots[:, :2] @ across, across)
        return np.vstack([spatial, spots])


def add(whole: Tube, width: float, taper: float) -> Overlap:
    """Add an overlap along the whole second border of the seam.

    width : mm, less than half a wedge; taper : deg by which each end leans inwards.
    Raises ImpossibleGeometry where it does not fit, InvalidParameters where it has no width.
    """
    sheet = Sheet.of(whole)
    _refuse(whole, width, taper)
    pieces = [(k, _clipped(whole, k, width, taper)) for k in range(len(whole.half.faces))]
    last, first = _copy(whole, whole.half.order - 1, False), _copy(whole, 0, True)
    corners = _Corners(whole, last)
    faces = [face for k, piece in pieces for face in _fan(corners.numbers(k, piece))]
    triangles = np.array(faces, np.intp)
    held = whole.half.faces[corners.facets]
    shares = np.array(corners.shares)
    shift = np.array([2 * whole.half.order * whole.half.flat[:, 0].max(), 0.0])
    flat = np.einsum("ki,kij->kj", shares, sheet.flat[first[held]]) + shift
    spatial = np.einsum("ki,kij->kj", shares, sheet.spatial[first[held]])
    sides = np.sort(np.vstack([triangles[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    known = {tuple(edge) for edge in np.sort(sheet.edges, axis=1).tolist()}
    new = [edge for edge in np.unique(sides, axis=0).tolist() if tuple(edge) not in known]
    grown = replace(
        sheet,
        flat=np.vstack([sheet.flat, flat]),
        spatial=np.vstack([sheet.spatial, spatial]),
        edges=np.vstack([sheet.edges, np.array(new, np.intp)]),
        faces=np.vstack([sheet.faces, triangles]),
    )
    return Overlap(grown, last[held], shares, whole.seams[:, 1])


def _refuse(whole: Tube, width: float, taper: float) -> None:
    if width <= COINCIDENT_MM:
        raise InvalidParameters(f"An overlap {width:g} mm wide holds nothing; make it wider.")
    room = float(whole.half.flat[:, 0].max())
    if width > room - COINCIDENT_MM:
        raise ImpossibleGeometry(
            f"An overlap {width:g} mm wide does not fit: it must be narrower than w = {room:g} mm, "
            "so that it ends within the facets it lies upon. Make it narrower."
        )
    low, high = _ends(whole)
    if high - low - 2 * width * _lean(taper) <= COINCIDENT_MM:
        widest = (high - low) / (2 * _lean(taper))
        raise ImpossibleGeometry(
            f"An overlap {width:g} mm wide does not fit at the seam that is {high - low:.4g} mm "
            f"long: with a taper of {taper:g}° it must be narrower than {widest:.4g} mm. Make it "
            "narrower, or its taper smaller."
        )


def _lean(taper: float) -> float:
    return float(np.tan(np.radians(taper)))


def _ends(whole: Tube) -> tuple[float, float]:
    y = whole.flat[whole.seams[:, 1], 1]
    return float(y[0]), float(y[-1])


def _copy(whole: Tube, turn: int, mirrored: bool) -> Indices:
    """Return the vertex (m,) of each of the half wedge's points in one of its copies."""
    on_l2 = np.isclose(whole.half.flat[:, 0], whole.half.flat[:, 0].max())
    turns = turn - (on_l2 & mirrored)
    number = {pair: k for k, pair in enumerate(zip(whole.origin, whole.turn, strict=True))}
    return np.array([number[point, own] for point, own in enumerate(turns)], np.intp)


def _clipped(whole: Tube, facet: int, width: float, taper: float) -> Floats:
    """Return what of a half wedge's facet is covered: a convex polygon (n, 2), mm; n may be 0."""
    polygon: Floats = whole.half.flat[whole.half.faces[facet]]
    edge = float(whole.half.flat[:, 0].max())
    (low, high), lean = _ends(whole), _lean(taper)
    for slope, rise, offset in (
        (1.0, 0.0, edge - width),
        (lean, 1.0, low + lean * edge),
        (lean, -1.0, -high + lean * edge),
    ):
        steep = float(np.hypot(slope, rise))
        polygon = _cut(polygon, np.array([slope, rise]) / steep, offset / steep)
    return polygon


def _cut(polygon: Floats, normal: Floats, offset: float) -> Floats:
    """Keep of a convex polygon (n, 2) what has x·normal ≥ offset; a corner on the line is kept."""
    height = polygon @ normal - offset
    height[np.abs(height) <= COINCIDENT_MM] = 0.0
    kept: list[Floats] = []
    for k in range(len(polygon)):
        here, there = height[k], height[(k + 1) % len(polygon)]
        if here >= 0:
            kept.append(polygon[k])
        if here * there < 0:
            share = here / (here - there)
            kept.append(polygon[k] + share * (polygon[(k + 1) % len(polygon)] - polygon[k]))
    found: Floats = np.array(kept).reshape(-1, 2)
    return found if (height > 0).any() else found[:0]


class _Corners:
    """Numbers for the corners of the pieces: those on the border are there already."""

    def __init__(self, whole: Tube, last: Indices) -> None:
        self.flat, self.faces = whole.half.flat, whole.half.faces
        self.known = [(self.flat[p], int(last[p])) for p in np.unique(whole.origin[whole.seams])]
        self.count = len(whole.origin)
        self.facets: list[int] = []
        self.shares: list[Floats] = []

    def numbers(self, facet: int, piece: Floats) -> list[int]:
        """Return the vertex of each corner, clockwise: the piece is mirrored."""
        return [self._number(facet, spot) for spot in piece[::-1]]

    def _number(self, facet: int, spot: Floats) -> int:
        for place, number in self.known:
            if float(np.hypot(*(place - spot))) <= COINCIDENT_MM:
                return number
        self.known.append((spot, self.count))
        self.facets.append(facet)
        a, b, c = self.flat[self.faces[facet]]
        beta, gamma = np.linalg.solve(np.column_stack([b - a, c - a]), spot - a)
        self.shares.append(np.array([1 - beta - gamma, beta, gamma]))
        self.count += 1
        return self.count - 1


def _fan(corners: list[int]) -> Iterator[tuple[int, int, int]]:
    for k in range(1, len(corners) - 1):
        yield corners[0], corners[k], corners[k + 1]
