"""The motion along the arc: the planes close on each other, and the open sheet folds flat.

Θ' goes from Θ = 180°/N to 0 while the first points, every branch and the flat sheet stay (thesis
3.3.2 and 5.2.1). The folding rate is FR = 100 (1 − Θ'/Θ) % (Eq. 5.8), so that t = FR / 100. The
sheet is open along one l2: at t the gap between its borders is 2·N·(Θ − Θ').
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.strip import Paper, Strip, meet
from foldmill.motion import Measure
from foldmill.tolerances import ON_LINE

Floats = NDArray[np.float64]

SAMPLES = 200
"""Places at which the way is looked at: half a percent of the folding rate apart."""
FOLDING_RATE = Measure("folding rate FR", "%", 0.0, 100.0)
"""Eq. 5.8: even with t, as Θ' is."""
ROUNDS = 4
"""How often the step before the first fault is divided by SAMPLES again."""


@dataclass(frozen=True)
class Arc:
    """A strip that is solved for any angle between its planes."""

    theta: float
    """Θ of the closed form, rad."""
    meridians: Callable[[Floats], Floats]
    """Θ' (K,) in rad → the points (K, n, 2) as (r, z), mm; NaN from the first without a place."""
    reaches: Callable[[int], float]
    """The number i of a point → how far the paper of p_{i-1} reaches across to its line, mm."""
    first: int = 1
    """The number of the first point there: 1, or 0 where the centre belongs to the strip."""


def in_space(meridian: Floats, theta: float, first: int = 1) -> Floats:
    """Return points (n, 3) from (r, z) (n, 2): odd ones at azimuth 0, even ones at theta rad.

    first : the number of the first point.
    """
    azimuth = np.where((np.arange(len(meridian)) + first) % 2 == 0, theta, 0.0)
    r, z = meridian.T
    return np.column_stack([r * np.cos(azimuth), r * np.sin(azimuth), z])


def meridians(solved: Strip, branches: Mapping[int, int], thetas: Floats) -> Floats:
    """Return P_0 … P_T (K, T+1, 2) as (r, z), mm, at K angles Θ' in rad between the planes.

    P_0, P_1 and the pattern stay as solved. NaN from the first point without one place.
    """
    spots = np.full((len(thetas), len(solved.flat), 2), np.nan)
    spots[:, :2] = solved.meridian[:2]
    for i in range(2, len(solved.flat)):
        before, across = spots[:, i - 2], spots[:, i - 1]
        spots[:, i] = meet(Paper.of(solved.flat, i), branches[i], before, across, thetas)
    return spots


def find_reach(arc: Arc) -> tuple[float, str]:
    """Return the t to which the motion goes, and why it stops there: empty where it does not.

    It stops where a point has no place or reaches the axis.
    """
    low, high, side = 0.0, 1.0, 0
    for _ in range(ROUNDS):
        rates = np.linspace(low, high, SAMPLES + 1)
        places = arc.meridians(arc.theta * (1 - rates))
        side = side or _side(places[0])
        faults = _faults(places, side)
        faulty = np.flatnonzero(faults.any(axis=1))
        if not len(faulty):
            return 1.0, ""
        first = int(faulty[0])
        if first == 0:
            break
        low, high = float(rates[first - 1]), float(rates[first])
    k = int(np.flatnonzero(faults[first])[0])
    return low, _reason(arc, low, k, places[first])


def _side(places: Floats) -> int:
    """Return on which side of the axis the form is: 1, or -1 where its radii are negative."""
    r = places[:, 0]
    return 1 if np.nanmax(r) >= -np.nanmin(r) else -1


def _faults(places: Floats, side: int) -> NDArray[np.bool_]:
    """Tell which points (K, n) have no place, or are beyond the axis."""
    r = places[..., 0]
    limit = ON_LINE * float(np.nanmax(np.abs(places)))
    return np.isnan(r) | (side * r < -limit)


def _reason(arc: Arc, t: float, k: int, places: Floats) -> str:
    i = k + arc.first
    if t == 0 and not np.isnan(places[k, 0]):
        return f"The form lies on both sides of its axis from the start: point {i} is beyond it."
    where = f"At a folding rate of {100 * t:.4g} % point {i}"
    if not np.isnan(places[k, 0]):
        return f"{where} reaches the axis: its radius is 0, and beyond it facets would penetrate."
    theta = arc.theta * (1 - t)
    (r2, z2), (r1, z1) = places[k - 2 : k]
    if np.hypot(r1 * np.cos(theta) - r2, z1 - z2) <= ON_LINE * np.nanmax(np.abs(places)):
        return f"{where} can turn freely about point {i - 2}: how it goes on is not determined."
    return (
        f"{where} loses its place: point {i - 1} comes {arc.reaches(i):.6g} mm from its plane, and "
        "no more paper reaches there."
    )
