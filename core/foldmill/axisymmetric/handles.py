"""Handles of the axisymmetric families: points along their lines, φ and γ as circles.

They serve any parameter model with ``phi`` and ``points``; dragging is a pure function from
parameters to parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.points import LinePoint
from foldmill.axisymmetric.rosette import Rosette
from foldmill.design import MOST_MM, Fold
from foldmill.errors import InvalidParameters
from foldmill.handle import Circle, Handle, Line, Space
from foldmill.tolerances import HANDLE_GAP_MM

Floats = NDArray[np.float64]

FARTHEST_MM = MOST_MM - HANDLE_GAP_MM
"""mm. As far out as a handle brings anything."""


def handles(fold: Fold, rose: Rosette, params: Any) -> tuple[Handle, ...]:
    """Return a handle for every a, for φ, and for every γ that is stated.

    params : any model with ``phi`` and ``points``.
    """
    found: list[Handle] = []
    for i, point in params.points.items():
        if isinstance(point, LinePoint):
            found.append(_along_line(fold, rose, i))
            if point.gamma is not None and i > 1:  # P_1 turns by φ
                found.append(_turning(rose, i))
    if fold.folded is not None:
        found.append(_opening(rose))
    return tuple(found)


def _vertex(rose: Rosette, point: int) -> int:
    """Return the vertex of a half wedge's point in the first wedge."""
    own = (rose.origin == point) & (rose.turn == 0) & ~rose.mirrored
    return int(np.flatnonzero(own)[0])


def _along_line(fold: Fold, rose: Rosette, i: int) -> Handle:
    spots = fold.pattern.vertices
    inner = spots[_vertex(rose, i - 2)] if i > 2 else np.zeros(2)
    return along_line(i, spots[_vertex(rose, i)], inner)


def along_line(i: int, spot: Floats, inner: Floats) -> Handle:
    """Return the handle ``points.i.a``: point i along its line in the pattern.

    spot, inner : (2,) mm, where point i and point i-2 (or the centre) are in the pattern. It stops
    short of both neighbours on its line; where the inner one lies beside it, short of its foot.
    """
    locus = Line(np.zeros(2), spot / np.hypot(*spot))
    drag = partial(_drag_along, i, locus, float(inner @ locus.along))
    return Handle(f"points.{i}.a", f"Point {i} along its line", Space.PATTERN, spot, locus, drag)


def _drag_along(i: int, locus: Line, foot: float, params: Any, point: Floats) -> Any:
    if not isinstance(params.points[i], LinePoint):
        raise InvalidParameters(f"Point {i} is placed by hand; drag it in its plane.")
    wanted = float((np.asarray(point, float) - locus.origin) @ locus.along)
    low, high = _room(params.points, i, foot)
    return _changed(params, i, a=float(np.clip(wanted, low, high)))


def _room(points: Any, i: int, foot: float) -> tuple[float, float]:
    """Return between which distances a point may lie, by its neighbours on the same line.

    One that is nearer to a neighbour than a handle brings it may stay there.
    """
    here, inner, outer = points[i].a, points.get(i - 2), points.get(i + 2)
    low = inner.a if isinstance(inner, LinePoint) else foot
    high = outer.a - HANDLE_GAP_MM if isinstance(outer, LinePoint) else FARTHEST_MM
    return min(here, low + HANDLE_GAP_MM), max(here, high)


def _opening(rose: Rosette) -> Handle:
    centre, spot = rose.spatial[_vertex(rose, 0)], rose.spatial[_vertex(rose, 1)]
    up, out = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    locus = Circle(centre, float(np.linalg.norm(spot - centre)), up, out)
    return Handle("phi", "Opening angle", Space.FOLDED, spot, locus, partial(_drag_opening, locus))


def _drag_opening(locus: Circle, params: Any, point: Floats) -> Any:
    degrees = float(np.degrees(locus.angle(np.asarray(point, float))))
    # Beyond either end of the half circle the nearer end is meant.
    clamped = degrees if degrees >= 0 else (0.0 if degrees > -90 else 180.0)
    return params.model_copy(update={"phi": clamped})


def _turning(rose: Rosette, i: int) -> Handle:
    azimuth = 0.0 if i % 2 else float(np.pi / rose.half.order)
    out = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    centre, spot = rose.spatial[_vertex(rose, i - 2)], rose.spatial[_vertex(rose, i)]
    up = np.array([0.0, 0.0, 1.0])
    locus = Circle(centre, float(np.linalg.norm(spot - centre)), out, up)
    drag: Callable[[Any, Floats], Any] = partial(_drag_turning, i, locus)
    return Handle(f"points.{i}.gamma", f"Direction of point {i}", Space.FOLDED, spot, locus, drag)


def _drag_turning(i: int, locus: Circle, params: Any, point: Floats) -> Any:
    return _changed(params, i, gamma=float(np.degrees(locus.angle(np.asarray(point, float)))))


def _changed(params: Any, i: int, **values: float) -> Any:
    points = dict(params.points)
    points[i] = points[i].model_copy(update=values)
    return params.model_copy(update={"points": points})
