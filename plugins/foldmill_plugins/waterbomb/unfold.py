"""Lay a developable mesh flat: facet by facet from the middle, then all lengths at once.

Laying facet beside facet adds up what rounding and the search left over (a torus of 550 bases:
1e-12 of an edge); two least-squares steps on the lengths of all edges take it away.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.planar import edge_faces, face_sides
from foldmill_plugins.waterbomb.linear import Factorised
from foldmill_plugins.waterbomb.topology import Topology

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

STEPS = 3
MANY = 10_000
"""Numbers beyond which a few rounds without factors do as well: what is left is local."""
ROUNDS = 50
"""Rounds: of 50,000 bases 4e-10 of an edge becomes 5e-12."""
RIGID = 1e-9
"""Weight of staying put, for the three motions that change no length."""
EXACT = 1e-14
"""Share by which lengths may differ for another step to be of no use."""


def unfold(topology: Topology, points: Floats) -> Floats:
    """Return the flat places (V, 2) of an opened topology's vertices, in the same unit.

    points : (V, 3) of a developable mesh. The first and the last column lie as far apart as they
    can along x, the first one on the left.
    """
    flat = refined(topology.edges, points, laid_out(topology.faces, points))
    return _upright(topology, flat)


def laid_out(faces: Indices, points: Floats) -> Floats:
    """Return flat places (V, 2), facet beside facet, from the middle one outwards.

    Each facet is laid beside a whole facet, not upon two placed vertices: so what is left of angles
    adds up along the way and does not multiply.
    """
    beside = edge_faces(face_sides(faces)[0], faces)[:, 1].reshape(-1, 3)
    shape = points[faces]
    laid = np.zeros((len(faces), 3, 2))
    front = np.array([len(faces) // 2])
    laid[front] = _alone(shape[front])
    done = np.zeros(len(faces), bool)
    done[front] = True
    order = [front]
    while len(front):
        front, parent, side = _next(beside, done, front)
        child_side = (beside[front] == parent[:, None]).argmax(axis=1)
        ends = laid[parent[:, None], (side[:, None] + [[1, 0]]) % 3]
        laid[front] = _beside(shape[front], child_side, ends)
        order.append(front)
    flat = np.zeros((len(points), 2))
    last = np.concatenate(order)[::-1]  # the first one laid has the last word
    flat[faces[last].ravel()] = laid[last].reshape(-1, 2)
    return flat


def _next(
    beside: Indices, done: NDArray[np.bool_], front: Indices
) -> tuple[Indices, Indices, Indices]:
    """Return the faces beside the front that are not done, and mark them done.

    With each comes the face of the front it is laid beside, and across which side of that.
    """
    near = beside[front]
    rows, sides = np.nonzero((near >= 0) & ~done[near])
    fresh, at = np.unique(near[rows, sides], return_index=True)
    done[fresh] = True
    return fresh, front[rows[at]], sides[at]


def _alone(corners: Floats) -> Floats:
    """Return triangles (n, 3, 3) in the plane (n, 3, 2), counter-clockwise, the first side on x."""
    side, own = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    length = np.linalg.norm(side, axis=1)
    out = np.zeros((len(corners), 3, 2))
    out[:, 1, 0] = length
    out[:, 2, 0] = np.einsum("ij,ij->i", own, side) / length
    out[:, 2, 1] = np.linalg.norm(np.cross(side, own), axis=1) / length
    return out


def _beside(corners: Floats, side: Indices, ends: Floats) -> Floats:
    """Return triangles (n, 3, 3) laid flat (n, 3, 2) with a side where ends (n, 2, 2) are."""
    rows = np.arange(len(corners))[:, None]
    turn = (side[:, None] + np.arange(3)) % 3
    local = _alone(corners[rows, turn])
    along = ends[:, 1] - ends[:, 0]
    unit = along / np.linalg.norm(along, axis=1, keepdims=True)
    left = np.column_stack([-unit[:, 1], unit[:, 0]])
    placed: Floats = ends[:, :1] + local[:, :, :1] * unit[:, None] + local[:, :, 1:] * left[:, None]
    out: Floats = np.zeros_like(placed)
    out[rows, turn] = placed
    return out


def refined(edges: Indices, points: Floats, flat: Floats) -> Floats:
    """Return the flat places whose edge lengths are nearest to those in space, by least squares."""
    a, b = edges.T
    wanted = np.linalg.norm(points[a] - points[b], axis=1)
    solver = Factorised()
    for _ in range(STEPS):
        across = flat[a] - flat[b]
        length = np.linalg.norm(across, axis=1)
        change = (length - wanted) / wanted
        if np.abs(change).max() <= EXACT:
            break
        slope = _slope(a, b, across / (length * wanted)[:, None], len(flat))
        if flat.size > MANY:
            return flat - _by_rounds(slope, change).reshape(-1, 2)
        normal = (slope.T @ slope).tocsc()
        weight = RIGID * float(normal.diagonal().mean())
        step = solver.solve(normal, weight, slope.T @ change)
        if step is None:
            break
        flat = flat - step.reshape(-1, 2)
    return flat


def _by_rounds(slope: Any, change: Floats) -> Floats:
    from scipy.sparse.linalg import lsmr

    found: Floats = lsmr(slope, change, atol=0.0, btol=0.0, conlim=0.0, maxiter=ROUNDS)[0]
    return found


def _slope(a: Indices, b: Indices, unit: Floats, count: int) -> Any:
    """Return the derivatives (E, 2V) of relative lengths by the flat places."""
    from scipy.sparse import csr_matrix

    columns = np.column_stack([2 * a, 2 * a + 1, 2 * b, 2 * b + 1])
    values = np.column_stack([unit, -unit])
    ends = 4 * np.arange(len(a) + 1)
    return csr_matrix((values.ravel(), columns.ravel(), ends), shape=(len(a), 2 * count))


def _upright(topology: Topology, flat: Floats) -> Floats:
    """Turn the flat places so that the middle of the last column lies to the right of the first."""
    ring = ~topology.is_centre
    middles = [flat[ring & (topology.k == k)].mean(axis=0) for k in (0, 2 * topology.n_u)]
    x, y = middles[1] - middles[0]
    size = np.hypot(x, y)
    c, s = (x / size, y / size) if size > 0 else (1.0, 0.0)
    turned: Floats = (flat - middles[0]) @ np.array([[c, -s], [s, c]])
    return turned
