"""What a person can drag: P_i in its plane, a_i and t along their lines in the pattern."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.handles import FARTHEST_MM, along_line
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.axisymmetric.strip import Strip
from foldmill.handle import Handle, Line, Plane, Space
from foldmill.tolerances import HANDLE_GAP_MM
from foldmill_plugins.tuck.flaps import Flap
from foldmill_plugins.tuck.params import Tuck, TuckParams
from foldmill_plugins.tuck.search import Placed

Floats = NDArray[np.float64]


def of(
    params: TuckParams, solved: Strip, made: list[Flap], placed: list[Placed], inside: int
) -> tuple[Handle, ...]:
    """Return every handle: ``points.i.a``, ``points.i``, and ``tucks.k.t``.

    inside : -1 where the pattern is seen from the other face, mirrored.
    """
    lines = [_along(i, solved, inside) for i in params.points if _is_line(params, i)]
    planes = [_in_plane(i, solved) for i in params.points if i > 1]
    numbers = _numbers(params, made)
    corners = [
        _corner(numbers[i], i, j, flap, each, inside)
        for flap, each in zip(made, placed, strict=True)
        for j, i in enumerate(flap.blank.points)
    ]
    return (*lines, *planes, *corners)


def _is_line(params: TuckParams, i: int) -> bool:
    return isinstance(params.points[i], LinePoint)


def _numbers(params: TuckParams, made: list[Flap]) -> dict[int, int]:
    """Return the place of every corner among the tucks; those not named yet come after."""
    numbers = {tuck.point: k for k, tuck in enumerate(params.tucks)}
    for i in (i for flap in made for i in flap.blank.points):
        numbers.setdefault(i, len(numbers))
    return numbers


def _with_point(params: TuckParams, i: int, point: LinePoint | FreePoint) -> TuckParams:
    return params.model_copy(update={"points": {**params.points, i: point}})


def _along(i: int, solved: Strip, inside: int) -> Handle:
    seen = solved.flat * np.array([1.0, inside])
    return along_line(i, seen[i], seen[max(i - 2, 0)])


def _in_plane(i: int, solved: Strip) -> Handle:
    azimuth = solved.theta if i % 2 == 0 else 0.0
    radial, up = np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.array([0.0, 0.0, 1.0])
    plane = Plane(np.zeros(3), radial, up)

    def drag(params: TuckParams, point: Floats) -> TuckParams:
        spot = plane.nearest(point)
        r, z = np.clip([spot @ radial, spot @ up], -FARTHEST_MM, FARTHEST_MM)
        return _with_point(params, i, FreePoint(r=float(r), z=float(z)))

    return Handle(
        f"points.{i}",
        f"Point {i} in its plane",
        Space.FOLDED,
        solved.spatial[i],
        plane,
        drag,
    )


def _corner(k: int, i: int, j: int, flap: Flap, placed: Placed, inside: int) -> Handle:
    azimuth = flap.blank.azimuth
    ray = Line(np.zeros(2), np.array([np.cos(azimuth), inside * np.sin(azimuth)]))
    here = float(placed.corners.t[0, j])
    low = min(here, float(placed.corners.low[0, j]) + HANDLE_GAP_MM)
    is_rim = flap.blank.is_open and i == flap.blank.points[-1]
    high = FARTHEST_MM if is_rim else float(placed.corners.high[0, j]) - HANDLE_GAP_MM
    high = max(here, high)

    def drag(params: TuckParams, point: Floats) -> TuckParams:
        t = float(np.clip(ray.nearest(point) @ ray.along, low, high))
        return params.model_copy(update={"tucks": _with_corner(params.tucks, i, t)})

    return Handle(
        f"tucks.{k}.t",
        f"The tuck's corner beside point {i}",
        Space.PATTERN,
        here * ray.along,
        ray,
        drag,
    )


def _with_corner(tucks: tuple[Tuck, ...], i: int, t: float) -> tuple[Tuck, ...]:
    """Return the tucks with the corner beside point i at t."""
    if all(tuck.point != i for tuck in tucks):
        return (*tucks, Tuck(point=i, t=t))
    return tuple(x.model_copy(update={"t": t}) if x.point == i else x for x in tucks)
