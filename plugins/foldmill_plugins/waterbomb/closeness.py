"""More than one measure of closeness, so that none can be gamed: d(A, T) counts vertices only.

Beside it the facets are sampled, the way back from the target to the form is measured, the largest
distances are told, and the ratio of the longest to the shortest edge shows slivers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.depths import settled
from foldmill_plugins.waterbomb.distance import Target
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.topology import Indices

Floats = NDArray[np.float64]

BLOCK = 200
"""Places of the target looked at in one go."""
INNER = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4], [2, 2, 2]]) / 6
"""Barycentric middles of the four like parts of a triangle."""


def report(params: WaterbombParams) -> dict[str, Any]:
    """Report distances as shares of the diagonal of the target's bounding box.

    Raises ImpossibleGeometry where there is no base mesh.
    """
    build = settled(params)
    return measures(build, build.developed.points)


def measures(build: Build, points: Floats) -> dict[str, Any]:
    """Return every measure of a mesh (V, 3) over a build's topology."""
    target, faces = Target.of(build.surface), build.topology.faces
    size = target.diagonal
    vertices = target.distances(points) / size
    spots, weights = facet_samples(points, faces)
    facets = target.distances(spots) / size
    places, areas = target_samples(target)
    back = mesh_distances(places, points[faces]) / size
    edges = np.linalg.norm(np.diff(points[build.topology.edges], axis=1)[:, 0], axis=1)
    return {
        "vertices_mean": float(vertices.mean()),
        "vertices_largest": float(vertices.max()),
        "facets_mean": float(np.average(facets, weights=weights)),
        "facets_largest": float(facets.max()),
        "reverse_mean": float(np.average(back, weights=areas)),
        "reverse_largest": float(back.max()),
        "edge_ratio": float(edges.max() / edges.min()),
    }


def facet_samples(points: Floats, faces: Indices) -> tuple[Floats, Floats]:
    """Return four places of every facet (4F, 3), and the area that each stands for (4F,)."""
    corners = points[faces]
    spots = np.einsum("sk,fkc->fsc", INNER, corners).reshape(-1, 3)
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return spots, np.repeat(np.linalg.norm(doubled, axis=1) / 8, 4)


def target_samples(target: Target, along: int = 40) -> tuple[Floats, Floats]:
    """Return places of the target (along², 3) in a grid of middles, and their areas."""
    surface = target.surface
    share = (np.arange(along) + 0.5) / along
    u, v = (low + share * (high - low) for low, high in (surface.u, surface.v))
    jet = surface.jet(np.repeat(u, along), np.tile(v, along))
    return jet.p, np.linalg.norm(jet.cross, axis=1)


def mesh_distances(places: Floats, triangles: Floats) -> Floats:
    """Return the distance (n,) of places (n, 3) from the nearest of triangles (F, 3, 3).

    A triangle can only be the nearest where its middle is nearer than the nearest middle and the
    largest reach of a triangle together.
    """
    from scipy.spatial import cKDTree

    middles = triangles.mean(axis=1)
    reach = np.linalg.norm(triangles - middles[:, None], axis=2).max(axis=1)
    tree = cKDTree(middles)
    limit = np.asarray(tree.query(places)[0]) + float(reach.max())
    out = np.zeros(len(places))
    for start in range(0, len(places), BLOCK):
        rows = np.arange(start, min(start + BLOCK, len(places)))
        near = tree.query_ball_point(places[rows], limit[rows], return_sorted=True)
        counts = np.array([len(each) for each in near])
        own = np.repeat(rows, counts)
        gaps = _gaps(places[own], triangles[np.concatenate(near).astype(np.intp)])
        out[rows] = np.minimum.reduceat(gaps, np.concatenate([[0], np.cumsum(counts)[:-1]]))
    return out


def _gaps(places: Floats, triangles: Floats) -> Floats:
    """Return the distance (n,) of each place (n, 3) from its triangle (n, 3, 3)."""
    sides = triangles[:, [1, 2, 0]] - triangles
    normal = np.cross(sides[:, 0], sides[:, 1])
    square = np.maximum((normal**2).sum(axis=1), np.finfo(float).tiny)
    rise = places[:, None] - triangles
    inside = (np.einsum("nkc,nkc->nk", np.cross(normal[:, None], sides), rise) >= 0).all(axis=1)
    height = np.abs(np.einsum("nc,nc->n", normal, rise[:, 0])) / np.sqrt(square)
    length = np.maximum((sides**2).sum(axis=2), np.finfo(float).tiny)
    share = np.clip(np.einsum("nkc,nkc->nk", rise, sides) / length, 0.0, 1.0)
    rims = np.linalg.norm(rise - share[:, :, None] * sides, axis=2).min(axis=1)
    found: Floats = np.where(inside, height, rims)
    return found
