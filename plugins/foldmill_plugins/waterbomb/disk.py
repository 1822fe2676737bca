"""A triangle mesh laid over a square: is it a disk, where are its corners, where does each go?

The map is harmonic with cotangent weights (Pinkall and Polthier 1993); where those turn a triangle
over, with equal ones, which never do over a convex border (Tutte 1963).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import ImpossibleGeometry

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FEWEST_FACES = 50
APART = 0.1
"""Share of the border by which corners are apart at least."""
SHARP = np.pi / 6
"""rad. A border that turns by less at four places has no corners of its own."""
THIN = 1e-12
"""Area in the square below which a triangle has none."""


@dataclass(frozen=True, eq=False)
class Disk:
    """A triangle mesh that is a disk: one piece, one side, one border."""

    points: Floats
    """(V, 3)"""
    faces: Indices
    """(F, 3) counter-clockwise."""
    border: Indices
    """(n,) the vertices of the border, counter-clockwise."""

    @classmethod
    def of(cls, points: Floats, faces: Indices) -> Disk:
        """Return the mesh as a disk; raises ImpossibleGeometry with what it is instead."""
        if len(faces) < FEWEST_FACES:
            _refuse(f"has {len(faces)} triangles: too coarse, give at least {FEWEST_FACES}")
        sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
        uses = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)[1]
        if uses.max() > 2:
            _refuse(f"has {np.count_nonzero(uses > 2)} edges with more than two triangles")
        _require_one_piece(points, faces)
        _require_one_side(sides)
        border = _border(sides, len(points))
        chi = len(np.unique(faces)) - len(uses) + len(faces)
        if chi != 1:
            _refuse("has a handle; a disk has none")
        return cls(points, faces, border)

    def over_square(self) -> Floats:
        """Return u and v (V, 2) of the vertices, the border upon that of [-1, 1]²."""
        uv = np.zeros((len(self.points), 2))
        uv[self.border] = self._rim()
        for weights in (self._cotangents(), np.ones((len(self.faces), 3))):
            found = self._harmonic(uv, weights)
            areas = _areas(found[self.faces])
            if areas.min() > THIN:
                return found
        _refuse(
            f"is too coarse at its border: {np.count_nonzero(areas <= THIN)} triangles have all "
            "their corners on one side of it"
        )
        raise AssertionError

    def _rim(self) -> Floats:
        """Return the places (n, 2) of the border's vertices, each side by its lengths."""
        corners = self._corners()
        rolled = np.roll(np.arange(len(self.border)), -corners[0])
        border = self.points[self.border[rolled]]
        steps = np.linalg.norm(np.diff(np.vstack([border, border[:1]]), axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        stops = [*(corners - corners[0]), len(border)]
        side = np.interp(along[:-1], along[stops], np.arange(5.0))
        square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]], float)
        out = np.zeros((len(border), 2))
        for axis in range(2):
            out[rolled, axis] = np.interp(side, np.arange(5.0), square[:, axis])
        return out

    def _corners(self) -> Indices:
        """Return where on the border its four corners are: the sharpest, or at the quarters."""
        sharp, along = self._turns(), self._along()
        chosen: list[int] = []
        for k in np.argsort(-sharp, kind="stable"):
            gaps = np.abs(along[chosen] - along[k])
            if not len(gaps) or np.minimum(gaps, 1 - gaps).min() >= APART:
                chosen.append(int(k))
            if len(chosen) == 4:
                break
        if len(chosen) < 4 or sharp[chosen[3]] < SHARP:
            places = (along[chosen[0]] + np.arange(4) / 4) % 1
            gaps = np.abs(along[:, None] - places)
            chosen = [int(k) for k in np.minimum(gaps, 1 - gaps).argmin(axis=0)]
        if len(set(chosen)) < 4:
            _refuse("has too few edges on its border for four corners")
        return np.array(sorted(chosen), np.intp)

    def _turns(self) -> Floats:
        """Return by how much the border turns inwards at each of its vertices, rad."""
        inner = np.zeros(len(self.points))
        np.add.at(inner, self.faces, _angles(self.points[self.faces]))
        turns: Floats = np.pi - inner[self.border]
        return turns

    def _along(self) -> Floats:
        """Return how far along the border each of its vertices is, as a share."""
        border = self.points[self.border]
        steps = np.linalg.norm(border - np.roll(border, 1, axis=0), axis=1)
        steps[0] = 0.0
        whole = steps.sum() + float(np.linalg.norm(border[0] - border[-1]))
        along: Floats = np.cumsum(steps) / whole
        return along

    def _cotangents(self) -> Floats:
        """Return the weight (F, 3) of the side opposite to each corner."""
        cotangents: Floats = 1 / np.tan(_angles(self.points[self.faces]))
        return cotangents

    def _harmonic(self, uv: Floats, weights: Floats) -> Floats:
        from scipy.sparse import coo_matrix, diags
        from scipy.sparse.linalg import splu

        count = len(self.points)
        a, b = np.roll(self.faces, -1, axis=1).ravel(), np.roll(self.faces, -2, axis=1).ravel()
        half: Any = coo_matrix((weights.ravel(), (a, b)), shape=(count, count))
        both = (half + half.T).tocsr()
        laplace = (diags(np.asarray(both.sum(axis=1)).ravel()) - both).tocsr()
        free = np.setdiff1d(np.unique(self.faces), self.border)
        if not len(free):
            _refuse("has no vertex inside its border: too coarse")
        out = uv.copy()
        right = -laplace[free][:, self.border] @ uv[self.border]
        out[free] = splu(laplace[free][:, free].tocsc()).solve(right)
        return out


def _require_one_piece(points: Floats, faces: Indices) -> None:
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    ends = (np.repeat(faces[:, 0], 2), faces[:, 1:].ravel())
    joined = coo_matrix((np.ones(len(ends[0])), ends), shape=(len(points), len(points)))
    labels = connected_components(joined, directed=False)[1]
    pieces = len(np.unique(labels[faces]))
    if pieces > 1:
        _refuse(f"is in {pieces} pieces")


def _require_one_side(sides: Indices) -> None:
    uses = np.unique(sides, axis=0, return_counts=True)[1]
    if uses.max() > 1:
        _refuse(
            f"has no two sides: across {np.count_nonzero(uses > 1)} edges its triangles turn "
            "against each other"
        )


def _border(sides: Indices, count: int) -> Indices:
    """Return the one border as a loop of vertices."""
    keys, back = sides[:, 0] * count + sides[:, 1], sides[:, 1] * count + sides[:, 0]
    open_ = sides[~np.isin(keys, back)]
    if not len(open_):
        _refuse("is closed: it has no border; cut it open")
    after = dict(open_.tolist())
    if len(after) < len(open_):
        _refuse("touches itself at a point of its border")
    loop = [int(open_[0, 0])]
    while after[loop[-1]] != loop[0]:
        loop.append(after[loop[-1]])
    if len(loop) < len(open_):
        loops = _loops(after)
        _refuse(f"has {loops} borders; a disk has one. Close its {loops - 1} hole(s)")
    return np.array(loop, np.intp)


def _loops(after: dict[int, int]) -> int:
    left, count = set(after), 0
    while left:
        at = min(left)
        while at in left:
            left.remove(at)
            at = after[at]
        count += 1
    return count


def _angles(corners: Floats) -> Floats:
    """Return the angles (F, 3) of triangles (F, 3, 3), rad."""
    one = np.roll(corners, -1, axis=1) - corners
    two = np.roll(corners, -2, axis=1) - corners
    sine = np.linalg.norm(np.cross(one, two), axis=2)
    angles: Floats = np.arctan2(sine, (one * two).sum(axis=2))
    return angles


def _areas(corners: Floats) -> Floats:
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas: Floats = (one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]) / 2
    return areas


def _refuse(said: str) -> None:
    raise ImpossibleGeometry(f"The mesh cannot be laid over a square, as it {said}.")
