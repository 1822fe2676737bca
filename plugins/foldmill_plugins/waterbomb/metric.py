"""How deep the bases of a start are, and how far slid: so that the folded metric is flat.

A planar cell w × h with a centre at depth c, slid by ζ h, is developable exactly if
c² = (h/2 + ζh)(3ζh − h/2), and unfolds to a lattice of √(w² + 4c²) by √(h² + 3c²). So a target with
the metric E, F, G folds from the metric E + 4c²/Δu², F, G + 3c²/Δv², which must be flat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.base import Offsets, cell_sizes, parameters
from foldmill_plugins.waterbomb.surfaces import Jet, Surface
from foldmill_plugins.waterbomb.topology import Topology

Floats = NDArray[np.float64]

DEEPEST = 0.95
"""Largest depth, in heights of a cell, that a start is given. At 1 the mids of a strip meet."""


@dataclass(frozen=True, eq=False)
class Start:
    """Depth and slide of every vertex, and what they promise."""

    depth: Floats
    """(V,) in cells."""
    slide: Floats
    """(V,) in Δv."""
    deepest: float
    """Greatest c / h that flatness asks for; a base cannot be deeper than 1."""
    left: float
    """Share of the target's curvature that no depth takes away."""

    @property
    def is_feasible(self) -> bool:
        """Whether the depths are possible and take the curvature away."""
        return self.deepest < 1 and self.left < MOST_LEFT


MOST_LEFT = 0.05
"""Share of the curvature that may be left: the search makes up for the rest."""


def slide_of(depth: Floats | float) -> Floats:
    """Return ζ of the exact unit from c / h: (2 √(1 + 3 (c/h)²) − 1) / 6."""
    slide: Floats = (2 * np.sqrt(1 + 3 * np.square(depth)) - 1) / 6
    return slide


def flat_period(w: float, h: float, c: float) -> tuple[float, float]:
    """Return width and height to which an exact unit w × h of depth c unfolds."""
    return float(np.hypot(w, 2 * c)), float(np.sqrt(h * h + 3 * c * c))


def grid_of(surface: Surface, topology: Topology) -> tuple[Floats, Floats]:
    """Return u and v (V,) of the vertices before they slide."""
    return parameters(surface, topology, Offsets(0.0, 0.0))


def start_of(surface: Surface, topology: Topology, depths: Floats, left: float) -> Start:
    """Return the start with the given c (V,) at the vertices' places in the grid.

    Where the target has no such metric, nothing is promised.
    """
    jet = surface.jet(*grid_of(surface, topology))
    du, dv = surface.steps(topology.n_u, topology.n_v)
    h = np.linalg.norm(jet.v, axis=1) * dv
    with np.errstate(all="ignore"):
        ratio = depths / h
        sizes = h / cell_sizes(jet, du, dv)
    if not np.isfinite(ratio).all() or not np.isfinite(sizes).all():
        nothing = np.full(len(h), DEEPEST)
        return Start(nothing, slide_of(nothing), np.inf, 1.0)
    kept = np.minimum(ratio, DEEPEST)
    return Start(kept * sizes, slide_of(kept), float(ratio.max()), left)


def closed_form(surface: Surface, topology: Topology, depth: float) -> Start:
    """Return the start of a surface of revolution: each strip unfolds to the same width W.

    W² = w² + 4c² with the cells' width w; depth : c of the widest cell, in cells.
    """
    du, dv = surface.steps(topology.n_u, topology.n_v)
    v = np.linspace(*surface.v, 40 * topology.n_v + 1)
    jet = surface.jet(np.full_like(v, surface.u[0]), v)
    widest = _widths(jet, du).argmax()
    c0 = depth * cell_sizes(jet, du, dv)[widest]
    whole = _widths(jet, du)[widest] ** 2 + 4 * c0**2
    here = surface.jet(*grid_of(surface, topology))
    c = np.sqrt(np.maximum(whole - _widths(here, du) ** 2, 0.0)) / 2
    return start_of(surface, topology, c, 0.0)


def crowding(surface: Surface, topology: Topology, start: Start, side: int) -> float:
    """Return the greatest depth of a centre, in heights of its cell as they are at that depth.

    A target that curves along v towards the pits leaves less room there; from about 1 on, the mids
    of a base pass each other. side : 1 where centres are displaced against P_u × P_v.
    """
    u, v = grid_of(surface, topology)
    jet = surface.jet(u[topology.is_centre], v[topology.is_centre])
    du, dv = surface.steps(topology.n_u, topology.n_v)
    depth = start.depth[topology.is_centre] * cell_sizes(jet, du, dv)
    square = np.einsum("ij,ij->i", jet.v, jet.v)
    with np.errstate(all="ignore"):
        bend = np.einsum("ij,ij->i", jet.vv, jet.cross) / np.linalg.norm(jet.cross, axis=1)
        room = np.sqrt(square) * dv * (1 + side * depth * bend / square)
    return float((depth / room).max()) if room.min() > 0 else float("inf")


def _widths(jet: Jet, du: float) -> Floats:
    widths: Floats = np.linalg.norm(jet.u, axis=1) * du
    return widths
