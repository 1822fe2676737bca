"""The motion ``unfold``: an axisymmetric form opens into its flat sheet, every facet rigid.

φ goes to 90°, where the sheet is flat whatever the branches: with one exception. A point with
c_i = 0 stands square over its crease in the pattern; at φ = 90° its two circles become one, and it
arrives there upright instead of flat. It is then turned down about P_{i-2}, by its direction γ,
which flattens the strip up to the next such point.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric import strip
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.axisymmetric.rosette import HalfWedge, Rosette
from foldmill.axisymmetric.strip import Strip
from foldmill.motion import Motion
from foldmill.tolerances import ON_LINE

Floats = NDArray[np.float64]
Points = Mapping[int, LinePoint | FreePoint]

NEAR_END = 1e-7
"""Share of a stage before its end at which the direction of an upright point is read: the solver
has no answer at the end itself. The error of γ is of the same order, in rad."""


@dataclass(frozen=True)
class _Stage:
    """One part of the motion: φ opens, or one upright point turns down."""

    phi: tuple[float, float]
    turns: int | None = None
    gamma: float = 0.0
    """Where the turning point starts, deg; it ends at 0, flat."""


def motion(rose: Rosette, order: int, phi: float, points: Points) -> Motion:
    """Return the motion of a form whose points all lie on their lines."""
    stages = _stages(order, phi, points)

    def path(t: float) -> Floats:
        solved = _at(stages, t, order, points)
        return rose.moved(_spread(rose.half, solved)).spatial

    return Motion("unfold", "Open into the flat sheet", path)


def _spread(half: HalfWedge, solved: Strip) -> HalfWedge:
    return replace(half, spatial=solved.spatial)


def _at(stages: list[_Stage], t: float, order: int, points: Points) -> Strip:
    """Solve the strip at t in [0, 1]; the stages share the time evenly."""
    place = t * len(stages)
    number = min(int(place), len(stages) - 1)
    return _solve(stages, number, place - number, order, points)


def _solve(stages: list[_Stage], number: int, share: float, order: int, points: Points) -> Strip:
    stage = stages[number]
    now = dict(points)
    for before in stages[:number]:
        if before.turns is not None:
            now[before.turns] = _with_gamma(now[before.turns], 0.0)
    if stage.turns is not None:
        now[stage.turns] = _with_gamma(now[stage.turns], stage.gamma * (1 - share))
    low, high = stage.phi
    return strip.solve(order, low + (high - low) * share, now)


def _with_gamma(point: LinePoint | FreePoint, gamma: float) -> LinePoint | FreePoint:
    return point.model_copy(update={"gamma": gamma})


def _stages(order: int, phi: float, points: Points) -> list[_Stage]:
    upright = upright_points(order, points)
    stages = [_Stage((phi, 90.0))] if phi != 90 or not upright else []
    for i in upright:
        gamma = _gamma_on_arrival(stages, i, order, points)
        stages.append(_Stage((90.0, 90.0), i, gamma))
    return stages


def _gamma_on_arrival(stages: list[_Stage], i: int, order: int, points: Points) -> float:
    """Return the direction of P_{i-2}P_i, deg, at the end of the stages so far."""
    if not stages:
        stated = points[i]
        return float(getattr(stated, "gamma", None) or 0.0)
    meridian = _solve(stages, len(stages) - 1, 1 - NEAR_END, order, points).meridian
    r, z = meridian[i] - meridian[i - 2]
    return float(np.degrees(np.arctan2(z, r)))


def upright_points(order: int, points: Points) -> list[int]:
    """Return the points with c_i = 0: p_{i-1} lies square beside p_{i-2} on the line of p_i."""
    theta = np.pi / order
    a = [0.0] + [float(getattr(points[i], "a", np.nan)) for i in sorted(points)]
    size = max(a)
    return [
        i for i in range(2, len(a)) if abs(a[i - 1] * np.cos(theta) - a[i - 2]) <= ON_LINE * size
    ]
