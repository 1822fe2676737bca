"""The motion along the arc of a tube: r_1, β and every branch stay, the seam opens."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric import along_arc as arc
from foldmill.axisymmetric.along_arc import FOLDING_RATE, Arc, in_space
from foldmill.axisymmetric.tube import Glued, Tube
from foldmill.motion import Motion
from foldmill_plugins.six_crease import solve
from foldmill_plugins.six_crease.params import SixCreaseParams

Floats = NDArray[np.float64]


def along_arc(params: SixCreaseParams, whole: Tube, glued: Glued | None) -> Motion:
    """Return the motion, and how far it goes: to where a point has no place or is on the axis.

    glued : the sheet with its tabs or its overlap, which knows how they move along.
    """
    start = glued.sheet.spatial if glued else whole.spatial
    reach, reason = find_reach(params)

    def path(t: float) -> Floats:
        if t == 0:
            return start.copy()
        theta = solve.wedge_angle(params) * (1 - t)
        places = whole.turned(in_space(solve.meridian(params, theta), theta), theta)
        return glued.carry(places) if glued else places

    title = "Fold flat along the arc, the seam open"
    return Motion("along-arc", title, path, reach, reason, FOLDING_RATE)


def folding_rate(params: SixCreaseParams, theta: float) -> float:
    """Return FR in percent for Θ' in deg (Eq. 5.8)."""
    return 100 * (1 - theta * params.n / 180)


def find_reach(params: SixCreaseParams) -> tuple[float, str]:
    """Return the t to which the motion goes, and why it stops there: empty where it does not."""
    solver = partial(solve.meridians, params)
    return arc.find_reach(Arc(solve.wedge_angle(params), solver, lambda _: params.w))
