"""The base mesh: every vertex of the tessellation placed on or beside the target.

The thesis' paragraph on how a base is made (Fig. 6.4) is lost; this construction has its topology
and reproduces its distances. A ring vertex slides along v towards the centre whose mid it is, a
centre leaves the target along its normal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill import ImpossibleGeometry
from foldmill_plugins.waterbomb.poles import require_normals
from foldmill_plugins.waterbomb.surfaces import Jet, Surface
from foldmill_plugins.waterbomb.topology import Topology

Floats = NDArray[np.float64]

DEGENERATE = 1e-9
"""Share of the form's size below which a length in the base mesh is none."""
TINY = np.finfo(float).tiny


@dataclass(frozen=True)
class Offsets:
    """How far vertices leave the grid; each a number, or one for every vertex (V,)."""

    depth: float | Floats
    """Offset of a centre along the normal, in cells, to the side of the pits."""
    slide: float | Floats
    """Slide of a ring vertex along v, in Δv."""
    lift: float = 0.0
    """Offset of a ring vertex along the normal, in cells, away from the pits."""
    side: int = 1
    """1 where the centres are on the side from which P_u × P_v points away, else -1."""
    is_rim_inside: bool = True
    """Whether the first and the last ring stay within the target's rectangle."""


def closed_topology(surface: Surface, n_u: int, n_v: int) -> Topology:
    """Return the graph of a surface's tessellation.

    Along v it closes only for an even number of strips, as each is shifted against the next.
    Raises ImpossibleGeometry for fewer than 2 bases along a closed u, and for a target that is said
    to close and does not.
    """
    if surface.is_u_periodic and n_u < 2:
        raise ImpossibleGeometry(
            f"n_u: a {surface.name} that closes along u needs at least 2 bases there, better 3, "
            f"not {n_u}: a base would be its own neighbour on both sides."
        )
    _require_closing(surface)
    closes = surface.is_v_periodic and n_v % 2 == 0
    return Topology(n_u, n_v, surface.is_u_periodic, closes)


def _require_closing(surface: Surface) -> None:
    share = np.linspace(0, 1, 17)
    u, v = (low + share * (high - low) for low, high in (surface.u, surface.v))
    size = float(np.ptp(surface.points(np.repeat(u, 17), np.tile(v, 17)), axis=0).max())
    for name, is_periodic, ends in (
        ("u", surface.is_u_periodic, [(0 * v + end, v) for end in surface.u]),
        ("v", surface.is_v_periodic, [(u, 0 * u + end) for end in surface.v]),
    ):
        one, two = (surface.points(*end) for end in ends)
        gap = float(np.abs(one - two).max())
        if is_periodic and not gap <= DEGENERATE * size:
            raise ImpossibleGeometry(
                f"The target {surface.name} does not close along {name}: its ends are {gap:.3g} "
                f"of its units apart. Choose another range of {name}, or say that it is open."
            )


def parameters(surface: Surface, topology: Topology, offsets: Offsets) -> tuple[Floats, Floats]:
    """Return u and v (V,) at which each vertex is placed."""
    du, dv = surface.steps(topology.n_u, topology.n_v)
    row = topology.j + 0.5 * topology.is_centre
    u: Floats = surface.u[0] + topology.k * np.float64(du / 2)
    slides = topology.slides.astype(np.float64)
    if offsets.is_rim_inside and not topology.is_v_closed:
        ring = ~topology.is_centre
        slides[ring & (topology.j == 0)] += 1
        slides[ring & (topology.j == topology.n_v)] -= 1
    v: Floats = surface.v[0] + (row + slides * offsets.slide) * dv
    return u, v


def cell_sizes(jet: Jet, du: float, dv: float) -> Floats:
    """Return (n,) the side of a square as large as the quad at each point."""
    sizes: Floats = np.sqrt(np.linalg.norm(jet.cross, axis=1) * du * dv)
    return sizes


def base_mesh(surface: Surface, topology: Topology, offsets: Offsets) -> Floats:
    """Return the vertices (V, 3) of the base mesh.

    Raises ImpossibleGeometry where the target has no finite point, no normal, or an edge or a facet
    vanishes, and where a rim that slides beyond the target's range comes to a pole there.
    """
    u, v = parameters(surface, topology, offsets)
    with np.errstate(all="ignore"):
        jet = surface.jet(u, v)
    finite = np.isfinite(np.hstack([jet.p, jet.u, jet.v])).all(axis=1)
    _refuse(surface, ~finite, u, v, "has no finite point")
    du, dv = surface.steps(topology.n_u, topology.n_v)
    area: Floats = np.linalg.norm(jet.cross, axis=1)
    size = float(np.ptp(jet.p, axis=0).max())
    shrinks = area * (du * dv) <= (DEGENERATE * size) ** 2
    _refuse(surface, shrinks, u, v, "has no normal: it shrinks to a point or a line")
    away = np.where(topology.is_centre, -np.asarray(offsets.depth), offsets.lift)
    height = offsets.side * away * cell_sizes(jet, du, dv)
    points: Floats = jet.p + (height / area)[:, None] * jet.cross
    _require_area(surface, topology, points, u, v)
    if v.min() < surface.v[0] - DEGENERATE * dv or v.max() > surface.v[1] + DEGENERATE * dv:
        require_normals(surface, v=(float(v.min()), float(v.max())))
    return points


def _require_area(
    surface: Surface, topology: Topology, points: Floats, u: Floats, v: Floats
) -> None:
    size = float(np.ptp(points, axis=0).max())
    a, b, c = points[topology.faces].transpose(1, 0, 2)
    longest = np.linalg.norm(np.stack([b - a, c - b, a - c]), axis=2).max(axis=0)
    altitude = np.linalg.norm(np.cross(b - a, c - a), axis=1) / np.maximum(longest, TINY)
    thin = np.zeros(len(points), bool)
    thin[topology.faces[altitude <= DEGENERATE * size].ravel()] = True
    _refuse(surface, thin, u, v, "gives a facet without area: its corners lie on one line")


def _refuse(surface: Surface, faults: ArrayLike, u: Floats, v: Floats, said: str) -> None:
    where = np.flatnonzero(faults)
    if len(where):
        at = where[0]
        raise ImpossibleGeometry(
            f"At u = {u[at]:.6g}, v = {v[at]:.6g} (and {len(where) - 1} more places) the target "
            f"{surface.name} {said}. Choose a range of u and v without that place."
        )
