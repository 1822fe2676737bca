"""From coarse to fine: what the search does to a small tessellation begins that of a large one.

The displacement of every vertex, in units of its cell (P_u Δu, P_v Δv and L n), is smooth over the
target for each class of vertices: mids of the strip above, mids of the strip below, centres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.base import cell_sizes, closed_topology
from foldmill_plugins.waterbomb.metric import grid_of
from foldmill_plugins.waterbomb.surfaces import Surface
from foldmill_plugins.waterbomb.topology import Topology

Floats = NDArray[np.float64]

FEW = 600
"""Bases that are searched at once."""


def halved(surface: Surface, topology: Topology) -> Topology | None:
    """Return the topology with half as many bases each way; None where it is small enough.

    Along a closed v the number of strips stays even.
    """
    if topology.n_u * topology.n_v <= FEW or min(topology.n_u, topology.n_v) < 8:
        return None
    n_v = topology.n_v // 2
    return closed_topology(surface, topology.n_u // 2, n_v + n_v % 2 * topology.is_v_closed)


def transferred(
    surface: Surface, coarse: Topology, before: Floats, after: Floats, fine: Topology, base: Floats
) -> Floats:
    """Return the fine base mesh (V, 3), moved as the coarse one was: from before to after."""
    moved = base.copy()
    own = np.einsum("nij,nj->ni", np.linalg.inv(_frames(surface, coarse)), after - before)
    frames = _frames(surface, fine)
    for sign in (-1, 0, 1):
        here, there = fine.slides == sign, coarse.slides == sign
        share = _interpolated(coarse, there, own[there], fine, here)
        moved[here] += np.einsum("nij,nj->ni", frames[here], share)
    return moved


def _frames(surface: Surface, topology: Topology) -> Floats:
    """Return (V, 3, 3) the columns P_u Δu, P_v Δv, L n at every vertex's place in the grid."""
    jet = surface.jet(*grid_of(surface, topology))
    du, dv = surface.steps(topology.n_u, topology.n_v)
    normal = jet.cross / np.linalg.norm(jet.cross, axis=1, keepdims=True)
    frames: Floats = np.stack(
        [jet.u * du, jet.v * dv, normal * cell_sizes(jet, du, dv)[:, None]], axis=2
    )
    return frames


def _interpolated(
    coarse: Topology,
    there: NDArray[np.bool_],
    values: Floats,
    fine: Topology,
    here: NDArray[np.bool_],
) -> Floats:
    """Return values (n, 3) of one class at the fine vertices, linear along u, then along v."""
    row, k = coarse.j[there], coarse.k[there] / (2 * coarse.n_u)
    rows = np.unique(row)
    at = fine.k[here] / (2 * fine.n_u)
    places = np.unique(at)
    period = 1.0 if coarse.is_u_closed else None
    table = np.stack(
        [
            np.column_stack(
                [
                    np.interp(places, k[row == r], values[row == r, c], period=period)
                    for c in range(3)
                ]
            )
            for r in rows
        ]
    )
    half = 0.5 * (coarse.is_centre[there][0])
    high = (fine.j[here] + half) / fine.n_v * coarse.n_v - half
    return _between_rows(table, rows, high, np.searchsorted(places, at), coarse)


def _between_rows(
    table: Floats, rows: NDArray[np.intp], high: Floats, column: NDArray[np.intp], coarse: Topology
) -> Floats:
    """Return the table's (rows, columns, 3) values between rows; a closed v goes round."""
    if coarse.is_v_closed:
        low = np.floor(high).astype(int)
        one, two, share = low % len(rows), (low + 1) % len(rows), high - low
    else:
        low = np.clip(np.floor(high).astype(int), 0, max(len(rows) - 2, 0))
        one, two = low, np.minimum(low + 1, len(rows) - 1)
        share = np.clip(high - low, 0.0, 1.0)
    out: Floats = table[one, column] * (1 - share)[:, None] + table[two, column] * share[:, None]
    return out
