"""Mountain or valley of creases that fold to ±180, where the form alone cannot tell.

A crease takes the sign it has just before it closes: while φ is not yet at 0 or 180, or while a
point is not yet on the axis but on that side of it where the form is. A crease that closes by
chance, two facets in one plane, can come from either sign, so that none is stated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.axisymmetric.rosette import EdgeSigns, HalfWedge, Rosette, Seat
from foldmill.errors import InvalidInput
from foldmill.tolerances import CLOSED_DEG, NEARLY_CLOSED_DEG, OFF_AXIS, ON_LINE

Floats = NDArray[np.float64]
Points = Mapping[int, LinePoint | FreePoint]


def signs(half: HalfWedge, phi: float, points: Points) -> EdgeSigns:
    """Return the signs, seen from above, of a solved strip's creases that may close to ±180.

    half : the strip's triangles alone; phi : deg; points : as for ``strip.solve``.
    """
    if phi == _ajar(phi) and not _on_axis(half).any():
        return {}
    rose = rosette.assemble(half)
    return off_axis(rose) | _by_opening(rose, phi, points)


def off_axis(whole: Rosette) -> EdgeSigns:
    """Return the signs of creases that are closed because a point is on the axis.

    None where the form is on both sides of its axis.
    """
    half = whole.half
    outward = _outward(half)
    radii = np.einsum("ij,ij->i", outward, half.spatial)
    size = float(np.abs(half.spatial).max())
    sides = np.unique(np.sign(radii[np.abs(radii) > ON_LINE * size]))
    on_axis = _on_axis(half)
    if len(sides) != 1 or not on_axis.any():
        return {}
    step = on_axis[:, None] * (OFF_AXIS * size * sides[0]) * outward
    return _of(whole.moved(replace(half, spatial=half.spatial + step)))


def _outward(half: HalfWedge) -> Floats:
    """Return the unit vectors (P, 3) away from the axis in the plane of each point."""
    azimuth = np.where([seat is Seat.L2 for seat in half.seats], np.pi / half.order, 0.0)
    return np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros_like(azimuth)])


def _on_axis(half: HalfWedge) -> NDArray[np.bool_]:
    """Tell which points lie on the axis, the centre not counted."""
    radii = np.einsum("ij,ij->i", _outward(half), half.spatial)
    size = float(np.abs(half.spatial).max())
    away_from_centre = np.array([seat is not Seat.CENTRE for seat in half.seats])
    near: NDArray[np.bool_] = (np.abs(radii) <= ON_LINE * size) & away_from_centre
    return near


def _ajar(phi: float) -> float:
    """Return the angle nearest to φ at which the innermost creases are not closed, deg."""
    return min(max(phi, NEARLY_CLOSED_DEG), 180 - NEARLY_CLOSED_DEG)


def _by_opening(rose: Rosette, phi: float, points: Points) -> EdgeSigns:
    near = _ajar(phi)
    if near == phi:
        return {}
    try:
        solved = strip.solve(rose.half.order, near, points, refuse_crossing=False)
    except InvalidInput:  # the form exists at its very end alone
        return {}
    return _of(rose.moved(replace(rose.half, spatial=solved.spatial)))


def _of(ajar: Rosette) -> EdgeSigns:
    """Return the signs of the creases of a form that are not closed, by their two points."""
    angles = ajar.fold_angles
    moves = (np.abs(angles) < 180 - CLOSED_DEG) & (ajar.edge_faces >= 0).all(axis=1)
    pairs, found = ajar.edge_origins[moves].tolist(), np.sign(angles[moves])
    return {(a, b): int(sign) for (a, b), sign in zip(pairs, found, strict=True)}
