"""Places where a target has no normal, P_u × P_v = 0: poles, tips, edges, also between samples.

Looked for from every sample whose normal vanishes within reach at its own slope, by Gauss–Newton on
the three components of P_u × P_v. So a pole between two samples is found where it is, before a base
mesh is laid across it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry
from foldmill_plugins.waterbomb.surfaces import Jet, Span, Surface

Floats = NDArray[np.float64]

PLACES = 41
"""Places along u and along v that are looked at, ends and middle included."""
DEGENERATE = 1e-9
"""Area of an element of the target, as a share of a square of its size, below which it has none."""
REACH = 2.0
"""Cells of samples within which a normal may vanish, at the slope it has."""
STEPS = 60
"""Steps towards a zero. They halve the way where the zero is double, square the rest elsewhere."""
ALONG = 1e-6
"""Share of the normal's slope across a line below which it does not change along it."""
DIGITS = 9
"""Decimals of a place that are told."""


def require_normals(surface: Surface, u: Span | None = None, v: Span | None = None) -> None:
    """Raise ImpossibleGeometry, with the place, where the target has no normal.

    u, v : the ranges that are looked at, the target's own where left out.
    """
    spans = u or surface.u, v or surface.v
    at = np.array([grid.ravel() for grid in grid_over(*spans)])
    jet = surface.jet(*at)
    size = float(np.ptp(jet.p, axis=0).max())
    if not size > 0:
        raise ImpossibleGeometry("The target is a single point. Let x, y and z depend on u and v.")
    cell = float(np.ptp(surface.u) * np.ptp(surface.v))
    least = DEGENERATE * size**2 / cell
    with np.errstate(over="ignore"):
        vanishes = ~(np.linalg.norm(jet.cross, axis=1) > least)
    if vanishes.all():
        raise ImpossibleGeometry(
            "The target is a curve, not a surface: u and v move its points along the same line. "
            "Let x, y and z depend on both."
        )
    place = at[:, vanishes.argmax()] if vanishes.any() else _between(surface, spans, at, jet, least)
    if place is not None:
        raise ImpossibleGeometry(_sentence(surface, place))


def grid_over(u: Span, v: Span) -> list[Floats]:
    """Return u and v (PLACES, PLACES) of the places that are looked at."""
    share = np.linspace(0, 1, PLACES)
    return [*np.meshgrid(*(low + share * (high - low) for low, high in (u, v)), indexing="ij")]


def _slopes(jet: Jet) -> Floats:
    """Return the derivatives (n, 3, 2) of P_u × P_v by u and v."""
    by_u = np.cross(jet.uu, jet.v) + np.cross(jet.u, jet.uv)
    by_v = np.cross(jet.uv, jet.v) + np.cross(jet.u, jet.vv)
    return np.stack([by_u, by_v], axis=2)


def _between(
    surface: Surface, spans: tuple[Span, Span], at: Floats, jet: Jet, least: float
) -> Floats | None:
    """Return u and v (2,) of a place between the samples at (2, n) without a normal, or None."""
    low, high = np.array(spans).T
    step = (high - low) / (PLACES - 1)
    change = np.linalg.norm(_slopes(jet), axis=1) @ step
    near = np.linalg.norm(jet.cross, axis=1) <= REACH * change
    spots = at.T[near]
    for _ in range(STEPS if len(spots) else 0):
        here = surface.jet(*spots.T)
        gone = np.linalg.norm(here.cross, axis=1) <= least
        if gone.any():
            return np.asarray(spots[gone.argmax()])
        moves = np.einsum("nij,nj->ni", np.linalg.pinv(_slopes(here)), here.cross)
        spots = np.clip(spots - np.clip(moves, -step, step), low, high)
    return None


def _sentence(surface: Surface, place: Floats) -> str:
    by_u, by_v = np.linalg.norm(_slopes(surface.jet(*place[:, None]))[0], axis=0)
    u, v = (f"{round(float(each), DIGITS) + 0.0:.6g}" for each in place)
    # Where the normal vanishes along a line, it changes across that line only.
    clear = "of u or of v so that it leaves that place out"
    if by_u <= ALONG * by_v:
        clear = f"of v so that it stays clear of v = {v}"
    elif by_v <= ALONG * by_u:
        clear = f"of u so that it stays clear of u = {u}"
    return (
        f"At u = {u}, v = {v} the target shrinks to a point or a line (a pole, a tip, an edge): "
        f"facets there would have no area. Shorten the range {clear}."
    )
