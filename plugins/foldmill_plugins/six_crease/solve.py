"""From parameters to P_1 … P_T, for one angle Θ' between the planes or for many (thesis 5.1.2).

P_1 = (L sin φ, L cos φ) as (r, z). C_2 is the foot of P_1 on Π2, and P_2 lies on the circle about
it with ρ² = |p_1p_2|² − (r_1 sin Θ')², at the angle β from the axis. Every later P_i is where two
circles meet, with c = y_{i-1} − y_{i-2} and h = w. Only r_1 = L sin φ and β shape the form: L cos φ
moves it along the axis, so that the space of forms has two dimensions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill import NoCandidate
from foldmill.axisymmetric.strip import Paper, Side, meet, place
from foldmill_plugins.six_crease.params import SixCreaseParams

Floats = NDArray[np.float64]


def wedge_angle(params: SixCreaseParams) -> float:
    """Return Θ = π/N, rad: the angle between Π1 and Π2 of the closed tube."""
    return float(np.pi / params.n)


def flat(params: SixCreaseParams) -> Floats:
    """Return p_1 … p_T (T, 2), mm: odd ones on x = 0, even ones on x = w."""
    y = [point.y for point in params.points.values()]
    return np.array([(params.w * (k % 2), height) for k, height in enumerate(y)])


def meridian(params: SixCreaseParams, theta: float | None = None) -> Floats:
    """Return P_1 … P_T (T, 2) as (r, z), mm; theta : Θ' in rad, by default that of the tube.

    Raises NoCandidate naming the first point without a place and by how much, and
    InvalidParameters where a γ is missing.
    """
    angle = wedge_angle(params) if theta is None else theta
    _refuse_long(params)
    spots = np.zeros((len(params.points), 2))
    spots[:2] = _first_two(params, np.array(angle))
    for i, paper, side in _steps(params):
        remedy = f"Bring point {i - 1} nearer to the axis, or make w larger."
        spots[i - 1] = place(i, paper, side, spots[i - 3 : i - 1], angle, remedy)
    return spots


def meridians(params: SixCreaseParams, thetas: Floats) -> Floats:
    """Return P_1 … P_T (K, T, 2) at K angles Θ' in rad; NaN from the first without one place on."""
    spots = np.full((len(thetas), len(params.points), 2), np.nan)
    spots[:, :2] = np.moveaxis(_first_two(params, thetas), 0, 1)
    for i, paper, side in _steps(params):
        spots[:, i - 1] = meet(paper, side.branch, spots[:, i - 3], spots[:, i - 2], thetas)
    return spots


def longest(params: SixCreaseParams) -> float:
    """Return L_b, mm: the largest L for which P_2 has a place (Eq. 5.4); infinite on the axis."""
    sine = sine_of(params.phi)
    reach = _first_edge(params) / np.sin(wedge_angle(params))
    return float(reach / sine) if sine > 0 else float("inf")


def centre_and_radius(params: SixCreaseParams, theta: Floats) -> tuple[Floats, Floats]:
    """Return C_2 (2, ...) as (r, z), mm, and ρ (...), mm, for Θ' (...) in rad."""
    r, z = _first(params)
    s, edge = r * np.sin(theta), _first_edge(params)
    squared = (edge - s) * (edge + s)
    return np.array([r * np.cos(theta), z + 0 * theta]), np.sqrt(np.maximum(squared, 0.0))


def sine_of(degrees: float) -> float:
    """Return the sine, exactly 0 at 0, at 180, and a turn from them."""
    return 0.0 if degrees % 180 == 0 else float(np.sin(np.radians(degrees)))


def _first(params: SixCreaseParams) -> tuple[float, float]:
    return params.L * sine_of(params.phi), params.L * float(np.cos(np.radians(params.phi)))


def _first_edge(params: SixCreaseParams) -> float:
    return float(np.hypot(params.w, params.points[2].y - params.points[1].y))


def _first_two(params: SixCreaseParams, theta: Floats) -> Floats:
    """Return P_1 and P_2 (2, ..., 2)."""
    centre, radius = centre_and_radius(params, theta)
    swing = np.array([sine_of(params.beta), np.cos(np.radians(params.beta))])
    second = centre + radius * swing.reshape(2, *[1] * theta.ndim)
    first = np.zeros_like(second) + np.array(_first(params)).reshape(2, *[1] * theta.ndim)
    return np.stack([np.moveaxis(spot, 0, -1) for spot in (first, second)])


def _steps(params: SixCreaseParams) -> list[tuple[int, Paper, Side]]:
    points = params.points
    size = max(params.w, max(p.y for p in points.values()) - min(p.y for p in points.values()))
    steps = []
    for i in range(3, len(points) + 1):
        low, middle, high = (points[k].y for k in (i - 2, i - 1, i))
        paper = Paper(high - low, middle - low, params.w, size)
        steps.append((i, paper, Side(points[i].branch, points[i].gamma)))
    return steps


def _refuse_long(params: SixCreaseParams) -> None:
    bound = longest(params)
    if bound < params.L:
        raise NoCandidate(
            f"Point 2 has no place: L = {params.L:g} mm is more than L_b = {bound:.6g} mm, the "
            f"most for φ = {params.phi:g}° ({params.L - bound:.3g} mm too many). Make L smaller, "
            "or turn φ away from 90°.",
            point=2,
        )
