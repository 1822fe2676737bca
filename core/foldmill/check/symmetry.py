"""Is a form as symmetric as it is said to be? Whoever takes a shortcut by symmetry asks here first.

The axis is z. The half wedge lies between the two planes through the axis at the azimuths 0 and
180/N degrees, or between their far halves, where every signed radius is negative.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.design import Symmetry
from foldmill.tolerances import SYMMETRY

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def half_wedge_decides(symmetry: Symmetry, vertices: Floats, faces: Indices) -> bool:
    """Tell whether a form is one-sided and its half wedge, mirrored and turned, is all of it.

    vertices : (V, 3) mm; faces : (F, 3).
    """
    if not symmetry.one_sided or fault(symmetry, vertices, faces):
        return False
    order, wedge = symmetry.order, vertices[faces[symmetry.wedge]]
    return _is_between_planes(wedge, order, _slack(vertices)) and _covers(
        vertices, faces, _copies(wedge, order)
    )


def fault(symmetry: Symmetry, vertices: Floats, faces: Indices) -> str:
    """Return what is untrue of a stated symmetry, as a clause for people, or nothing.

    vertices : (V, 3) mm; faces : (F, 3). ``one_sided`` is not looked at.
    """
    order, wedge = symmetry.order, np.asarray(symmetry.wedge)
    if order < 1 or not len(wedge) or ((wedge < 0) | (wedge >= len(faces))).any():
        return "the symmetry names no order, or faces that are not there"
    if 2 * order * len(wedge) != len(faces) or len(np.unique(wedge)) != len(wedge):
        return (
            f"a half wedge of {len(wedge)} faces, mirrored and turned {order} times, is not the "
            f"whole form of {len(faces)} faces"
        )
    if order > 1 and not _covers(vertices, faces, _turned(vertices[faces], order, 1)):
        return f"turned by 360°/{order} about the z axis, the form is another"
    return ""


def _slack(vertices: Floats) -> float:
    return SYMMETRY * float(np.ptp(vertices, axis=0).max())


def _is_between_planes(corners: Floats, order: int, slack: float) -> bool:
    theta = np.pi / order
    x, y = corners[..., 0], corners[..., 1]
    inside = np.stack([y, x * np.sin(theta) - y * np.cos(theta)])
    return bool((inside >= -slack).all() or (inside <= slack).all())


def _copies(corners: Floats, order: int) -> Floats:
    """Return triangles (k, 3, 3) mirrored about y = 0, and both turned N times about z."""
    every = np.concatenate([corners, corners * np.array([1.0, -1.0, 1.0])])
    return np.concatenate([_turned(every, order, turn) for turn in range(order)])


def _turned(corners: Floats, order: int, turn: int) -> Floats:
    cos, sin = np.cos(2 * np.pi * turn / order), np.sin(2 * np.pi * turn / order)
    out: Floats = corners @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return out


def _covers(vertices: Floats, faces: Indices, triangles: Floats) -> bool:
    """Tell whether triangles (F, 3, 3) are the faces of the form, each once, in any order."""
    from scipy.spatial import cKDTree

    slack = _slack(vertices)
    tree = cKDTree(vertices)
    spots = _spots(tree, len(vertices), slack)
    far, nearest = tree.query(triangles.reshape(-1, 3))
    if len(triangles) != len(faces) or far.max() > slack:
        return False
    return bool(np.array_equal(_listed(spots[nearest].reshape(-1, 3)), _listed(spots[faces])))


def _spots(tree: object, count: int, slack: float) -> Indices:
    """Return a number (V,) for every place where vertices are: alike for those that coincide."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs = tree.query_pairs(2 * slack, output_type="ndarray")  # type: ignore[attr-defined]
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    labels: Indices = connected_components(links, directed=False)[1].astype(np.intp)
    return labels


def _listed(triangles: Indices) -> Indices:
    corners = np.sort(triangles, axis=1)
    ordered: Indices = corners[np.lexsort(corners.T)]
    return ordered
