"""How far vertices are from the target, and how far they have drifted along it.

Terminology: the *foot* of a vertex is the nearest place of the target. Half the square of the
distance changes as the vertex moves off the directions in which its foot can follow: along both
tangents within the target, along its rim where the foot is on the rim, nowhere at a corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.distance import Target
from foldmill_plugins.waterbomb.surfaces import Surface

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Nearness:
    """Where some vertices are beside the target: for each an arrow, and what it changes by."""

    away: Floats
    """(n, 3) from the foot to the vertex."""
    off: Floats
    """(n, 3, 3) projection onto the directions in which the foot does not follow."""
    along: Floats
    """(n, 3, 3) projection onto the tangent plane at the foot."""

    @classmethod
    def of(cls, target: Target, points: Floats) -> Nearness:
        """Return where points (n, 3) are."""
        spots = target.projected(points)[0]
        jet = target.surface.jet(*spots.T)
        u, v, normal = _unit(jet.u), _unit(jet.v), _unit(jet.cross)
        along = np.eye(3) - _onto(normal)
        at_u, at_v = _at_ends(target.surface, spots).T[:, :, None, None]
        follows = np.where(
            at_u & at_v,
            0.0,
            np.where(at_v, _onto(u), np.where(at_u, _onto(v), along)),
        )
        return cls(points - jet.p, np.eye(3) - follows, along)


def _unit(arrows: Floats) -> Floats:
    lengths = np.linalg.norm(arrows, axis=1, keepdims=True)
    out: Floats = arrows / np.maximum(lengths, np.finfo(float).tiny)
    return out


def _onto(units: Floats) -> Floats:
    """Return the projections (n, 3, 3) onto unit vectors (n, 3)."""
    out: Floats = np.einsum("ni,nj->nij", units, units)
    return out


def _at_ends(surface: Surface, spots: Floats) -> NDArray[np.bool_]:
    """Tell which of u and v (n, 2) are at an open end of their range."""
    low, high = np.array([surface.u, surface.v]).T
    is_open = ~np.array([surface.is_u_periodic, surface.is_v_periodic])
    ends: NDArray[np.bool_] = ((spots <= low) | (spots >= high)) & is_open
    return ends
