"""A field of depths that makes a target's folded metric flat: K_f = 0 by Brioschi's formula.

Solved on a coarse grid of nodes for s = log c² with Gauss–Newton; the smoothest field close to a
wanted depth is preferred, as flatness alone leaves the boundary values open.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.base import cell_sizes
from foldmill_plugins.waterbomb.metric import Start, grid_of, start_of
from foldmill_plugins.waterbomb.surfaces import Surface
from foldmill_plugins.waterbomb.topology import Topology

Floats = NDArray[np.float64]

NODES = 21
"""Nodes along u and along v; a multiple of 3, for derivatives by threes."""
SMOOTH, NEAR = 3e-3, 3e-4
"""Weights of smoothness and of nearness to the wanted depth beside flatness."""
ROUNDS = 40
ENOUGH = 1e-3
"""Share of the cost that a step must win for the next one to be worth while."""
PROBE = 1e-6
"""Step of the derivatives by differences: the square root of rounding, for values about 1."""
LEAST_TOTAL = 0.05
"""rad. Total curvature below which a target is flat, so that its share means nothing."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """The metric of a target on a grid of nodes (a, b): u along the first axis."""

    u: Floats
    v: Floats
    E: Floats
    F: Floats
    G: Floats
    cell: Floats
    """(a, b) side of a square as large as a cell."""
    du: float
    dv: float
    closes: tuple[bool, bool]
    """Whether the grid goes on at its end along u, along v: its last node is left out."""

    @property
    def steps(self) -> tuple[float, float]:
        """Distance of nodes along u and v."""
        return float(self.u[1] - self.u[0]), float(self.v[1] - self.v[0])


def flat_metric(surface: Surface, topology: Topology, depth: float) -> Start:
    """Return the start whose folded metric is as flat as can be; depth : wanted c, in cells."""
    nodes = _nodes(surface, topology)
    wanted = 2 * np.log(depth * nodes.cell)
    field = _solve(nodes, wanted)
    u, v = grid_of(surface, topology)
    c = np.exp(_interpolated(nodes, field, u, v) / 2)
    return start_of(surface, topology, c, left_over(nodes, field))


def left_over(nodes: Nodes, field: Floats) -> float:
    """Return ∫|K_f| dA_f as a share of the target's own ∫|K| dA; 0 for a flat target."""
    own = np.abs(_curvature(nodes, np.full_like(field, -np.inf))).sum()
    rest = np.abs(_curvature(nodes, field)).sum()
    return float(rest / max(own, LEAST_TOTAL))


def _nodes(surface: Surface, topology: Topology) -> Nodes:
    closes = (topology.is_u_closed, topology.is_v_closed)
    u = np.linspace(*surface.u, NODES, endpoint=not closes[0])
    v = np.linspace(*surface.v, NODES, endpoint=not closes[1])
    grid = np.meshgrid(u, v, indexing="ij")
    jet = surface.jet(grid[0].ravel(), grid[1].ravel())
    du, dv = surface.steps(topology.n_u, topology.n_v)
    shape = (NODES, NODES)
    E, F, G = (
        np.einsum("ij,ij->i", a, b).reshape(shape)
        for a, b in ((jet.u, jet.u), (jet.u, jet.v), (jet.v, jet.v))
    )
    return Nodes(u, v, E, F, G, cell_sizes(jet, du, dv).reshape(shape), du, dv, closes)


def _derivative(values: Floats, step: float, axis: int, *, closes: bool) -> Floats:
    """Return central differences at inner nodes (all along a closed axis), one-sided at ends."""
    if closes:
        out: Floats = (np.roll(values, -1, axis) - np.roll(values, 1, axis)) / (2 * step)
        return out
    slope: Floats = np.gradient(values, step, axis=axis)
    return slope


def _second(values: Floats, step: float, axis: int) -> Floats:
    out: Floats = (np.roll(values, -1, axis) - 2 * values + np.roll(values, 1, axis)) / step**2
    return out


def _curvature(nodes: Nodes, field: Floats) -> Floats:
    """Return K_f dA_f per node by Brioschi's formula, 0 on an open end of the grid."""
    depth = np.exp(field)
    E, F, G = nodes.E + 4 * depth / nodes.du**2, nodes.F, nodes.G + 3 * depth / nodes.dv**2
    (su, sv), (cu, cv) = nodes.steps, nodes.closes
    Eu, Fu, Gu = (_derivative(each, su, 0, closes=cu) for each in (E, F, G))
    Ev, Fv, Gv = (_derivative(each, sv, 1, closes=cv) for each in (E, F, G))
    Fuv = _derivative(Fu, sv, 1, closes=cv)
    top = -_second(E, sv, 1) / 2 + Fuv - _second(G, su, 0) / 2
    one = (
        top * (E * G - F * F)
        - Eu / 2 * ((Fv - Gu / 2) * G - F * Gv / 2)
        + (Fu - Ev / 2) * ((Fv - Gu / 2) * F - E * Gv / 2)
    )
    two = -Ev / 2 * (Ev / 2 * G - F * Gu / 2) + Gu / 2 * (Ev / 2 * F - E * Gu / 2)
    area = E * G - F * F
    total: Floats = (one - two) / area**1.5 * su * sv
    return np.where(_is_inner(nodes), total, 0.0)


def _is_inner(nodes: Nodes) -> NDArray[np.bool_]:
    inner = np.ones_like(nodes.E, bool)
    if not nodes.closes[0]:
        inner[[0, -1]] = False
    if not nodes.closes[1]:
        inner[:, [0, -1]] = False
    return inner


def _solve(nodes: Nodes, wanted: Floats) -> Floats:
    """Return the field s (a, b) that minimises curvature, roughness and distance from wanted."""
    from scipy.sparse import identity, vstack
    from scipy.sparse.linalg import spsolve

    one = identity(wanted.size, format="csc")
    plain = vstack([SMOOTH * _roughness(nodes), NEAR * one]).tocsr()
    field, damping = wanted.copy(), 1e-6
    value, cost = _objective(nodes, plain, field, wanted)
    for _ in range(ROUNDS):
        whole = vstack([_slopes(nodes, field), plain]).tocsc()
        normal, right = (whole.T @ whole).tocsc(), whole.T @ value
        step = spsolve(normal + damping * one, right).reshape(field.shape)
        trial = field - np.clip(step, -1.0, 1.0)
        moved, after = _objective(nodes, plain, trial, wanted)
        if after < cost:
            gained = 1 - after / cost
            field, value, cost, damping = trial, moved, after, max(damping / 10, 1e-9)
            if gained < ENOUGH:
                break
        else:
            damping *= 10
    return field


def _objective(nodes: Nodes, plain: Any, field: Floats, wanted: Floats) -> tuple[Floats, float]:
    rest = plain @ (field - wanted).ravel()
    value = np.concatenate([_curvature(nodes, field).ravel(), rest])
    return value, float(value @ value)


def _roughness(nodes: Nodes) -> Any:
    """Return the matrix of second differences of a field, along u and along v."""
    from scipy.sparse import diags, identity, kron, vstack

    def along(count: int, *, closes: bool) -> Any:
        rows = diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(count - 2, count)).tolil()
        if not closes:
            return rows.tocsr()
        ring = diags([-2.0, 1.0, 1.0], [0, 1, -1], shape=(count, count)).tolil()
        ring[0, -1] = ring[-1, 0] = 1.0
        return ring.tocsr()

    one, two = (identity(NODES, format="csr") for _ in range(2))
    return vstack(
        [
            kron(along(NODES, closes=nodes.closes[0]), one),
            kron(two, along(NODES, closes=nodes.closes[1])),
        ]
    ).tocsr()


def _slopes(nodes: Nodes, field: Floats) -> Any:
    """Return the derivatives (n, n) of K_f dA_f by s, by differences.

    A node's value depends on itself and its neighbours, so that every third node moves at once.
    """
    from scipy.sparse import coo_matrix

    a, b = np.indices(field.shape)
    here = _curvature(nodes, field)
    rows, columns, values = [], [], []
    for one in range(3):
        for two in range(3):
            moved = field + PROBE * ((a % 3 == one) & (b % 3 == two))
            change = (_curvature(nodes, moved) - here) / PROBE
            near_a, near_b = a + (one - a + 1) % 3 - 1, b + (two - b + 1) % 3 - 1
            rows.append((a * NODES + b).ravel())
            columns.append((near_a % NODES * NODES + near_b % NODES).ravel())
            values.append(change.ravel())
    size = (field.size, field.size)
    entries = (np.concatenate(rows), np.concatenate(columns))
    return coo_matrix((np.concatenate(values), entries), shape=size)


def _interpolated(nodes: Nodes, field: Floats, u: Floats, v: Floats) -> Floats:
    """Return the field at places (n,) by bicubic splines; a closed axis is repeated at its ends."""
    from scipy.interpolate import RectBivariateSpline

    (su, sv), (cu, cv) = nodes.steps, nodes.closes
    du, dv = 3 * cu, 3 * cv
    wide = np.pad(field, ((du, du), (0, 0)), mode="wrap") if cu else field
    wide = np.pad(wide, ((0, 0), (dv, dv)), mode="wrap") if cv else wide
    along_u = nodes.u[0] + su * np.arange(-du, NODES + du)
    along_v = nodes.v[0] + sv * np.arange(-dv, NODES + dv)
    out: Floats = RectBivariateSpline(along_u, along_v, wide).ev(u, v)
    return out
