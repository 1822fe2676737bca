"""Is a target given by a user a surface at all? Looked at before anything is solved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry
from foldmill_plugins.waterbomb.poles import PLACES, grid_over, require_normals
from foldmill_plugins.waterbomb.surfaces import Jet, Surface

Floats = NDArray[np.float64]

LIKE = 1e-9
"""Share of the target's size by which places of a surface of revolution may be off."""

LARGEST = 1e9
"""Of a coordinate or a slope; what is beyond it is next to a place without a value."""

Evaluate = Callable[[Floats, Floats], Jet]


def sound(surface: Surface) -> Surface:
    """Return the surface with its sides and its symmetry found out, and its jet guarded.

    Raises ImpossibleGeometry where it has no finite point, or shrinks to a point or a line.
    """
    guarded = replace(surface, jet=finite(surface.jet))
    require_normals(guarded)
    is_turned = guarded.is_u_periodic and _is_revolution(guarded)
    return replace(guarded, is_outward=_is_outward(guarded), is_revolution=is_turned)


def finite(jet: Evaluate) -> Evaluate:
    """Return the jet as one that raises ImpossibleGeometry, with the place, where it is no number.

    A target may be asked for places beyond its range, so that looking beforehand is not enough.
    """

    def guarded(u: Floats, v: Floats) -> Jet:
        with np.errstate(all="ignore"):
            found = jet(u, v)
        parts = np.hstack([found.p, found.u, found.v, found.uu, found.uv, found.vv])
        bad = np.argwhere(~(np.abs(parts) <= LARGEST))
        if len(bad):
            at, column = bad[0]
            raise ImpossibleGeometry(
                f"At u = {u[at]:.6g}, v = {v[at]:.6g} the target's {'xyz'[column % 3]} or one of "
                "its slopes is no finite number. Choose a range of u and v without that place."
            )
        return found

    return guarded


def _is_outward(surface: Surface) -> bool:
    """Tell whether P_u × P_v points away from what the target goes round.

    That is its inside where it closes both ways, else the middle of each of its rings. An open
    sheet's outside is where the normal points.
    """
    if not (surface.is_u_periodic or surface.is_v_periodic):
        return True
    u, v = (grid[:-1, :-1] for grid in grid_over(surface.u, surface.v))
    jet = surface.jet(u.ravel(), v.ravel())
    points, normals = (part.reshape(*u.shape, 3) for part in (jet.p, jet.cross))
    if surface.is_u_periodic and surface.is_v_periodic:
        return float((points * normals).sum()) > 0
    along = 0 if surface.is_u_periodic else 1
    return float(((points - points.mean(axis=along, keepdims=True)) * normals).sum()) > 0


def _is_revolution(surface: Surface) -> bool:
    """Tell whether the target turns about z once as u runs once, from a plane through z."""
    u, v = grid_over(surface.u, surface.v)
    points = surface.points(u.ravel(), v.ravel()).reshape(*u.shape, 3)
    first, gap = points[0], LIKE * float(np.ptp(points.reshape(-1, 3), axis=0).max())
    radius = np.hypot(first[:, 0], first[:, 1])
    x, y = first[0, :2] / radius[0] if radius[0] > 0 else (0.0, 0.0)
    if not np.allclose(first[:, :2], radius[:, None] * (x, y), rtol=0, atol=gap):
        return False
    share = np.linspace(0, 2 * np.pi, PLACES)
    for turn in (share, -share):
        c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
        turned = np.stack(
            [c * first[:, 0] - s * first[:, 1], s * first[:, 0] + c * first[:, 1]], axis=2
        )
        level = np.abs(points[..., 2] - first[:, 2]).max() <= gap
        if level and np.abs(points[..., :2] - turned).max() <= gap:
            return True
    return False
