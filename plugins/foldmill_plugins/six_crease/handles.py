"""What a person can drag: the heights of the points in the pattern, P_1 and P_2 in space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.handle import Circle, Handle, Line, Plane, Space
from foldmill.tolerances import COINCIDENT_MM, HANDLE_GAP_MM
from foldmill_plugins.six_crease import solve
from foldmill_plugins.six_crease.params import FARTHEST, SixCreaseParams

Floats = NDArray[np.float64]


def handles(params: SixCreaseParams, meridian: Floats, mirrored: bool) -> tuple[Handle, ...]:
    """Return the handles of a form.

    meridian : (T, 2) P_1 … P_T as (r, z), mm; mirrored : whether the pattern is turned over.
    """
    sign = np.array([-1.0 if mirrored else 1.0, 1.0])
    spots = solve.flat(params) * sign
    heights = [_height(i, spots[i - 1]) for i in params.points]
    return (*heights, _first(meridian[0]), *_second(params, meridian))


def _height(i: int, spot: Floats) -> Handle:
    along = Line(spot, np.array([0.0, 1.0]))

    def drag(params: SixCreaseParams, point: Floats) -> SixCreaseParams:
        y = _between(params, i, float(along.nearest(point)[1]))
        points = {**params.points, i: params.points[i].model_copy(update={"y": y})}
        return params.model_copy(update={"points": points})

    name = f"points.{i}.y"
    return Handle(name, f"Height of point {i}", Space.PATTERN, spot, along, drag)


def _between(params: SixCreaseParams, i: int, y: float) -> float:
    """Keep a height between those of its neighbours on the line, a hair's breadth apart."""
    low = params.points[i - 2].y + HANDLE_GAP_MM if i - 2 in params.points else -FARTHEST
    high = params.points[i + 2].y - HANDLE_GAP_MM if i + 2 in params.points else FARTHEST
    return float(min(max(y, low), high))


def _first(spot: Floats) -> Handle:
    plane = Plane(np.zeros(3), np.array([1.0, 0, 0]), np.array([0, 0, 1.0]))

    def drag(params: SixCreaseParams, point: Floats) -> SixCreaseParams:
        x, _, z = plane.nearest(point)
        changed = params.model_copy(update={"phi": float(np.degrees(np.arctan2(max(x, 0.0), z)))})
        reach = min(float(np.hypot(max(x, 0.0), z)), solve.longest(changed), FARTHEST)
        return changed.model_copy(update={"L": reach})

    here = np.array([spot[0], 0.0, spot[1]])
    return Handle("L", "Point 1 in its plane: L and φ", Space.FOLDED, here, plane, drag)


def _second(params: SixCreaseParams, meridian: Floats) -> list[Handle]:
    """Return the handle of β; none where the circle of P_2 is a point."""
    theta = solve.wedge_angle(params)
    (r, z), radius = solve.centre_and_radius(params, np.array(theta))
    if radius <= COINCIDENT_MM:
        return []
    outward = np.array([np.cos(theta), np.sin(theta), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    circle = Circle(r * outward + z * up, float(radius), up, outward)

    def drag(params: SixCreaseParams, point: Floats) -> SixCreaseParams:
        beta = float(np.degrees(circle.angle(point))) % 360
        return params.model_copy(update={"beta": beta})

    here = meridian[1, 0] * outward + meridian[1, 1] * up
    return [Handle("beta", "Point 2 on its circle: β", Space.FOLDED, here, circle, drag)]
