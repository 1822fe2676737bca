"""Does a flap pass through the form? A quick screen over many flaps at once.

The two halves of a flap lie upon each other, and the form maps to itself when it is turned by one
wedge; so one half of one flap against everything else decides. The rule for two triangles is that
of ``foldmill.check.intersection``, which has the last word on the flap that is chosen.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill.check.triangles import cut_lengths, triangle_normals
from foldmill.tolerances import PENETRATION
from foldmill.vectors import least, most
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.corners import Corners

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BLOCK = 256
"""Flaps looked at in one go."""


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Everything a flap must keep clear of, apart from its own kind."""

    order: int
    """N."""
    triangles: Floats
    """(F, 3, 3) mm."""
    eps: float
    """mm by which two triangles must pass through each other."""
    is_mirrored: bool = True
    """Whether all of it maps to itself in the symmetry planes; false once a flap is placed."""

    @classmethod
    def of(cls, order: int, triangles: Floats) -> Surroundings:
        """Return a surface without flaps."""
        eps = PENETRATION * float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
        return cls(order, triangles, eps)

    def beside(self, blank: Blank, spots: Floats) -> Surroundings:
        """Return all this and a blank's flaps with corners (k, 3) in every wedge."""
        flap = flap_points(blank, spots[None])[0][flap_faces(blank)]
        turned = np.concatenate([_turned(flap, self.order, k) for k in range(self.order)])
        triangles = np.concatenate([self.triangles, turned])
        return replace(self, triangles=triangles, is_mirrored=False)


def flap_faces(blank: Blank) -> Indices:
    """Return the triangles (2k, 3) of half a flap, by the rows of ``flap_points``.

    (A p_i t_i), (t_i p_i p_{i+2}), (t_i p_{i+2} t_{i+2}) … (t p B), as in thesis Fig. 4.7.
    """
    k, size = len(blank.points), len(blank.chain)
    faces: list[tuple[int, int, int]] = []
    before = 0
    for j in range(k):
        faces.append((before, j + 1, size + j))
        if j + 2 < size:
            faces.append((size + j, j + 1, j + 2))
        before = size + j
    return np.array(faces, np.intp)


def flap_points(blank: Blank, spots: Floats) -> Floats:
    """Return A, the points, B if any, and the corners (S, k, 3) in space: (S, n, 3) mm."""
    fixed = np.broadcast_to(blank.spatial, (len(spots), *blank.spatial.shape))
    return np.concatenate([fixed, spots], axis=1)


def depths(blank: Blank, corners: Corners, around: Surroundings) -> Floats:
    """Return by how much (S,) each flap passes through things, mm along their cuts; 0 is free.

    A flap whose corners do not exist is infinitely deep.
    """
    found = np.full(len(corners.t), np.inf)
    there = np.flatnonzero(corners.exists)
    for start in range(0, len(there), BLOCK):
        rows = there[start : start + BLOCK]
        points = flap_points(blank, corners.spots[rows])
        found[rows] = _among_others(blank, points, around) + _among_its_kind(blank, points, around)
    return found


def _among_others(blank: Blank, points: Floats, around: Surroundings) -> Floats:
    """Return the depths of flaps (S, n, 3) in what surrounds them."""
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    is_near = (around.triangles.min(axis=1) <= high).all(axis=1)
    is_near &= (around.triangles.max(axis=1) >= low).all(axis=1)
    near, faces, eps = around.triangles[is_near], flap_faces(blank), around.eps
    if not len(near):
        return np.zeros(len(points))
    normals, offsets = _planes(near)
    above = points @ normals.T - offsets
    one, two, three = (above[:, faces[:, k]] for k in range(3))  # (S, m, F)
    lowest = np.minimum(np.minimum(one, two), three)
    highest = np.maximum(np.maximum(one, two), three)
    s, m, f = np.nonzero((lowest < -eps) & (highest > eps))
    return _summed(len(points), s, cut_lengths(points[s[:, None], faces[m]], near[f], eps))


def _among_its_kind(blank: Blank, points: Floats, around: Surroundings) -> Floats:
    """Return the depths of flaps (S, n, 3) in their copies in the other wedges, and themselves."""
    faces = flap_faces(blank)
    flaps = points[:, faces]  # (S, m, 3, 3)
    turns = range(around.order // 2 + 1)
    others = np.stack([_turned(flaps, around.order, turn) for turn in turns])
    low, high = _boxes(flaps)
    other_low, other_high = _boxes(others)
    meets = np.broadcast_to(
        _strangers(faces, len(turns))[:, None], (*others.shape[:3], len(faces))
    ).copy()  # (turns, S, m, m)
    for axis in range(3):
        meets &= other_low[:, :, None, :, axis] <= high[:, :, None, axis]
        meets &= other_high[:, :, None, :, axis] >= low[:, :, None, axis]
    k, s, a, b = np.nonzero(meets)
    return _summed(len(points), s, cut_lengths(flaps[s, a], others[k, s, b], around.eps))


def _boxes(triangles: Floats) -> tuple[Floats, Floats]:
    """Return the lower and the upper corners (..., 3) of the boxes about triangles (..., 3, 3)."""
    corners = np.swapaxes(triangles, -1, -2)
    return least(corners), most(corners)


def _strangers(faces: Indices, turns: int) -> NDArray[np.bool_]:
    """Tell (turns, m, m) which facets of a flap to hold against which of a turned one.

    Among the flap's own, turned by nothing, each pair once, and only what shares no edge.
    """
    shared = (faces[:, None, :, None] == faces[None, :, None, :]).sum(axis=(2, 3))
    apart = np.ones((turns, len(faces), len(faces)), bool)
    apart[0] = np.triu(shared < 2, 1)
    return apart


def _turned(points: Floats, order: int, turns: int) -> Floats:
    angle = 2 * np.pi * turns / order
    cos, sin = np.cos(angle), np.sin(angle)
    turned: Floats = points @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return turned


def _summed(count: int, rows: Indices, lengths: Floats) -> Floats:
    total = np.zeros(count)
    np.add.at(total, rows, lengths)
    return total


def _planes(triangles: Floats) -> tuple[Floats, Floats]:
    normals = triangle_normals(triangles)
    return normals, np.einsum("ni,ni->n", normals, triangles[:, 0])
