"""The motion along the arc: the planes close on each other, and the open sheet folds flat.

Θ' goes from Θ = 180°/N to 0 while r_1, β and every branch stay (thesis 5.2.1). The folding rate is
FR = 100 (1 − Θ'/Θ) % (Eq. 5.8), so that t = FR / 100. The seam is open on the way.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.tube import Glued, Tube, in_space
from foldmill.motion import Measure, Motion
from foldmill.tolerances import ON_LINE
from foldmill_plugins.six_crease import solve
from foldmill_plugins.six_crease.params import SixCreaseParams

Floats = NDArray[np.float64]

SAMPLES = 200
"""Places at which the way is looked at: half a percent of the folding rate apart."""
FOLDING_RATE = Measure("folding rate FR", "%", 0.0, 100.0)
"""Eq. 5.8: even with t, as Θ' is."""
ROUNDS = 4
"""How often the step before the first fault is divided by SAMPLES again."""


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
    low, high, side = 0.0, 1.0, 0
    for _ in range(ROUNDS):
        rates = np.linspace(low, high, SAMPLES + 1)
        places = solve.meridians(params, solve.wedge_angle(params) * (1 - rates))
        side = side or _side(places[0])
        faults = _faults(places, side)
        faulty = np.flatnonzero(faults.any(axis=1))
        if not len(faulty):
            return 1.0, ""
        first = int(faulty[0])
        if first == 0:
            break
        low, high = float(rates[first - 1]), float(rates[first])
    i = 1 + int(np.flatnonzero(faults[first])[0])
    return low, _reason(params, low, i, places[first])


def _side(places: Floats) -> int:
    """Return on which side of the axis the form is: 1, or -1 where its radii are negative."""
    r = places[:, 0]
    return 1 if np.nanmax(r) >= -np.nanmin(r) else -1


def _faults(places: Floats, side: int) -> NDArray[np.bool_]:
    """Tell which points (K, T) have no place, or are beyond the axis."""
    r = places[..., 0]
    limit = ON_LINE * float(np.nanmax(np.abs(places)))
    return np.isnan(r) | (side * r < -limit)


def _reason(params: SixCreaseParams, t: float, i: int, places: Floats) -> str:
    if t == 0 and not np.isnan(places[i - 1, 0]):
        return f"The form lies on both sides of its axis from the start: point {i} is beyond it."
    where = f"At a folding rate of {100 * t:.4g} % point {i}"
    if not np.isnan(places[i - 1, 0]):
        return f"{where} reaches the axis: its radius is 0, and beyond it facets would penetrate."
    theta = solve.wedge_angle(params) * (1 - t)
    (r2, z2), (r1, z1) = places[i - 3 : i - 1]
    if np.hypot(r1 * np.cos(theta) - r2, z1 - z2) <= ON_LINE * np.nanmax(np.abs(places)):
        return f"{where} can turn freely about point {i - 2}: how it goes on is not determined."
    return (
        f"{where} loses its place: point {i - 1} comes {params.w:.6g} mm from its plane, and no "
        "more paper reaches there."
    )
