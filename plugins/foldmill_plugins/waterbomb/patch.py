"""A smooth surface through a grid of points: bicubic splines, straight on beyond their edge."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.surfaces import Jet

Floats = NDArray[np.float64]

FEWEST = 4
"""Nodes along a side that a bicubic spline needs."""


def patch(u: Floats, v: Floats, points: Floats) -> Callable[[Floats, Floats], Jet]:
    """Return the jet of the surface with points (a, b, c) at nodes u (a,) and v (b,).

    c : 1 for heights over the plane of u and v, 3 for places in space.
    """
    from scipy.interpolate import RectBivariateSpline

    splines = [RectBivariateSpline(u, v, points[:, :, k]) for k in range(points.shape[2])]

    def jet(at_u: Floats, at_v: Floats) -> Jet:
        at_u, at_v = np.broadcast_arrays(np.asarray(at_u, float), np.asarray(at_v, float))
        near_u, near_v = np.clip(at_u, u[0], u[-1]), np.clip(at_v, v[0], v[-1])
        columns = [
            _continued(spline, near_u, near_v, at_u - near_u, at_v - near_v) for spline in splines
        ]
        if len(columns) == 1:
            columns = [*_plane(at_u, at_v), *columns]
        return Jet(*np.stack(columns, axis=2))

    return jet


def _continued(spline: Any, u: Floats, v: Floats, du: Floats, dv: Floats) -> Floats:
    """Return f, f_u, f_v, f_uu, f_uv, f_vv (6, n) at u + du, v + dv; du, dv : beyond the edge.

    There the surface goes on along its tangent, so that it has no step and no kink.
    """
    orders = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2))
    f, fu, fv, fuu, fuv, fvv, fuuv, fuvv = (spline.ev(u, v, dx=a, dy=b) for a, b in orders)
    inner_u, inner_v = du == 0, dv == 0
    out: Floats = np.stack(
        [
            f + fu * du + fv * dv + fuv * du * dv,
            fu + fuv * dv,
            fv + fuv * du,
            np.where(inner_u, fuu + fuuv * dv, 0.0),
            fuv,
            np.where(inner_v, fvv + fuvv * du, 0.0),
        ]
    )
    return out


def _plane(u: Floats, v: Floats) -> tuple[Floats, Floats]:
    o, one = np.zeros_like(u), np.ones_like(u)
    return np.stack([u, one, o, o, o, o]), np.stack([v, o, one, o, o, o])
