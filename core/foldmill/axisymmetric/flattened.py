"""Where a form ends when its planes close, Θ' → 0, and which creases end folded there.

The limit rule: a crease on l1 or l2 lies between a facet and its mirror image, so it always ends
folded to ±180. A zigzag crease p_{i-1}p_i ends folded iff b_{i+1} = b_i: P_{i-2} and P_{i+1} are
then on the same side of it; else it ends flat. Mountain or valley is read from the thickness of the
wedge: near the limit the depth of a point is its radius times its azimuth, and of two facets that
lie upon each other the deeper one is behind.

Maekawa's theorem must be read in this limit: on the way a crease may change its sign, or go flat.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.rosette import Rosette, Seat
from foldmill.tolerances import ON_LINE

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def ends_folded(whole: Rosette, branches: Mapping[int, int]) -> NDArray[np.bool_]:
    """Tell which edges (E,) end folded, by the limit rule; those of the border do not.

    branches : b by the number of the point in the half wedge, for every point that has one.
    """
    low, high = whole.edge_origins.T
    on_line = (high - low == 2) | np.array([seat is Seat.CENTRE for seat in whole.half.seats])[low]
    known = np.array([branches.get(k, 0) for k in range(len(whole.half.seats) + 1)])
    same: NDArray[np.bool_] = on_line | (known[high] == known[np.minimum(high + 1, len(known) - 1)])
    return same & (whole.edge_faces >= 0).all(axis=1)


def folded_signs(whole: Rosette, meridian: Floats) -> Indices:
    """Return which way each edge (E,) is folded in the limit, seen from above, were it folded.

    meridian : (m, 2) the points of the half wedge as (r, z), mm, at Θ' = 0.
    +1 valley, -1 mountain; 0 on the border and where two facets are equally deep.
    """
    spots, drift = _to_first_order(whole, meridian)
    normals, turning = _normals(whole.faces, spots, drift)
    inner = (whole.edge_faces >= 0).all(axis=1)
    f, g = whole.edge_faces[inner].T
    along = spots[whole.edges[inner, 1]] - spots[whole.edges[inner, 0]]
    parts = np.cross(turning[f], normals[g]), np.cross(normals[f], turning[g])
    sine = np.einsum("ij,ij->i", parts[0] + parts[1], along)
    noise = ON_LINE * sum(np.linalg.norm(p, axis=1) for p in parts) * np.linalg.norm(along, axis=1)
    signs = np.zeros(len(whole.edges), np.intp)
    signs[inner] = np.where(np.abs(sine) <= noise, 0, -np.sign(sine))
    return signs


def _to_first_order(whole: Rosette, meridian: Floats) -> tuple[Floats, Floats]:
    """Return the vertices (V, 3) at Θ' = 0, and by how much each moves per rad of Θ'."""
    on_l2 = np.array([seat is Seat.L2 for seat in whole.half.seats])[whole.origin]
    wedges = 2 * whole.turn + np.where(whole.mirrored, -1, 1) * on_l2
    r, z = meridian[whole.origin].T
    none = np.zeros_like(r)
    return np.column_stack([r, none, z]), np.column_stack([none, r * wedges, none])


def _normals(faces: Indices, spots: Floats, drift: Floats) -> tuple[Floats, Floats]:
    """Return the normals (F, 3) at Θ' = 0, and how they turn per rad; neither of unit length."""
    (a, b, c), (da, db, dc) = spots[faces].swapaxes(0, 1), drift[faces].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    return normal, np.cross(db - da, c - a) + np.cross(b - a, dc - da)
