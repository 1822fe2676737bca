"""Does each vertex fold flat by itself, with the mountains and valleys it has?

An angle that is no larger than its neighbours, between a mountain and a valley, is *crimped*: its
two creases go, and the angles about it become one, larger by it folded to and fro. A vertex folds
flat exactly if this ends with two creases of one kind between equal angles (Bern and Hayes 1996;
Demaine and O'Rourke, Geometric Folding Algorithms, 12.2). Layers of one vertex only: whether they
fit between those of others is another, harder question.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.depths import settled
from foldmill_plugins.waterbomb.hinge import Creases
from foldmill_plugins.waterbomb.kawasaki import SIGNS, angles
from foldmill_plugins.waterbomb.params import WaterbombParams

Floats = NDArray[np.float64]

ALIKE = 1e-7
"""rad. Angles closer than this are alike: searches end at 2e-12, forms of reports at less."""


def report(params: WaterbombParams) -> dict[str, Any]:
    """Report how far the tessellation is flat-foldable vertex by vertex, with its fit if it is on.

    Raises ImpossibleGeometry where there is no base mesh.
    """
    build = settled(params)
    return foldability(build, build.developed.points)


def foldability(build: Build, points: Floats) -> dict[str, Any]:
    """Return which inner vertices of a mesh (V, 3) keep Kawasaki's rule, and which fold flat."""
    centre, around = build.topology.stars
    sectors = angles(points, centre, around)
    missed = np.abs(sectors @ SIGNS)
    is_mountain = _mountains(build, points)
    folds = np.array(
        [folds_flat(one, two) for one, two in zip(sectors, is_mountain, strict=True)], bool
    )
    count = max(len(centre), 1)
    return {
        "vertices": len(centre),
        "kawasaki_deg": float(np.degrees(missed.max(initial=0.0))),
        "kawasaki_share": float(np.count_nonzero(missed <= ALIKE) / count),
        "folds_flat_share": float(np.count_nonzero(folds) / count),
        "not_flat": [int(vertex) for vertex in centre[~folds]],
    }


def _mountains(build: Build, points: Floats) -> NDArray[np.bool_]:
    """Tell which of the six creases of every inner vertex are folded as mountains, (m, 6)."""
    creases = Creases.of(build.topology, build.side)
    count = len(points)
    keys = creases.quads[:, :2].min(axis=1) * count + creases.quads[:, :2].max(axis=1)
    centre, around = build.topology.stars
    wanted = np.minimum(centre[:, None], around) * count + np.maximum(centre[:, None], around)
    order = np.argsort(keys)
    at = order[np.searchsorted(keys[order], wanted)]
    is_mountain: NDArray[np.bool_] = (creases.signs * creases.folds(points) > 0)[at]
    return is_mountain


def folds_flat(sectors: Floats, is_mountain: NDArray[np.bool_]) -> bool:
    """Tell whether a vertex folds flat: crease n lies before angle n (k,) rad; k even.

    Crimps in any order lead to the same answer.
    """
    left, kinds = [float(each) for each in sectors], [bool(each) for each in is_mountain]
    while len(left) > 2:
        at = _crimpable(left, kinds)
        if at is None:
            return False
        # Turned so that the crimped angle is the second one: the creases about it go.
        order = np.roll(np.arange(len(left)), 1 - at)
        left, kinds = [left[n] for n in order], [kinds[n] for n in order]
        left = [left[0] - left[1] + left[2], *left[3:]]
        kinds = [kinds[0], *kinds[3:]]
    return kinds[0] == kinds[1] and abs(left[0] - left[1]) <= ALIKE


def _crimpable(left: list[float], kinds: list[bool]) -> int | None:
    """Return an angle that can be crimped, the smallest of them, or None."""
    count = len(left)
    for at in sorted(range(count), key=left.__getitem__):
        around = min(left[at - 1], left[(at + 1) % count])
        if left[at] <= around + ALIKE and kinds[at] != kinds[(at + 1) % count]:
            return at
    return None
