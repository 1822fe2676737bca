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
from foldmill.design import Fold
from foldmill.handle import Circle, Handle, Line, Space

Floats = NDArray[np.float64]

LEAST_STEP = 1.0
"""mm that a dragged point keeps from its neighbours on the line: nobody folds less."""


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
    spot = fold.pattern.vertices[_vertex(rose, i)]
    locus = Line(np.zeros(2), spot / np.hypot(*spot))
    return Handle(
        f"points.{i}.a",
        f"Point {i} along its line",
        Space.PATTERN,
        spot,
        locus,
        partial(_drag_along, i, locus),
    )


def _drag_along(i: int, locus: Line, params: Any, point: Floats) -> Any:
    wanted = float((np.asarray(point, float) - locus.origin) @ locus.along)
    low, high = _room(params, i)
    return _changed(params, i, a=float(np.clip(wanted, low, high)))


def _room(params: Any, i: int) -> tuple[float, float]:
    """Return between which distances a point may lie, by its neighbours on the same line."""
    inner, outer = params.points.get(i - 2), params.points.get(i + 2)
    low = (inner.a if isinstance(inner, LinePoint) else 0.0) + LEAST_STEP
    high = outer.a - LEAST_STEP if isinstance(outer, LinePoint) else np.inf
    return low, max(low, high)


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
