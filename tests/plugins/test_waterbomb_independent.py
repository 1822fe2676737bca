"""Figures of waterbomb tessellations found a second time, from the thesis' formulas alone.

Nothing of the family is used but the form that it returns: surfaces are written down anew (Table
6.2), the nearest point is found by looking closer and closer, and angles by the law of cosines.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from foldmill import Assignment, Fold
from foldmill_plugins.waterbomb import DESIGN

Floats = NDArray[np.float64]
PI = float(np.pi)

SURFACES: dict[str, tuple[Callable[[Any, Any], tuple[Any, ...]], tuple[float, ...]]] = {
    "catenoid": (
        lambda u, v: (np.cosh(v / 2.5) * np.cos(u), np.cosh(v / 2.5) * np.sin(u), v),
        (0, 2 * PI, -PI, PI),
    ),
    "cylinder": (lambda u, v: (np.cos(u), np.sin(u), v), (0, 2 * PI, -PI, PI)),
    "hyperbolic-paraboloid": (lambda u, v: (u, v, u * v), (-1, 1, -1, 1)),
    "moebius": (
        lambda u, v: (
            (1 + v / 2 * np.cos(u / 2)) * np.cos(u),
            (1 + v / 2 * np.cos(u / 2)) * np.sin(u),
            v / 2 * np.sin(u / 2),
        ),
        (0, 2 * PI, -1, 1),
    ),
}
"""x, y, z of (u, v), and the least and greatest u and v."""
DIAGONALS = {
    "catenoid": 8.266256,
    "cylinder": 6.890458,
    "hyperbolic-paraboloid": 3.464102,
    "moebius": 3.852671,
}
"""Of the targets' bounding boxes: sampled finely, once and for all."""


def at(kind: str, u: Floats, v: Floats) -> Floats:
    return np.stack(np.broadcast_arrays(*SURFACES[kind][0](u, v)), axis=-1)


def distances(kind: str, points: Floats) -> Floats:
    """Distances of points (n, 3): the best of a grid, then of ever smaller ones around it."""
    low_u, high_u, low_v, high_v = SURFACES[kind][1]
    u, v = (each.ravel() for each in np.meshgrid(np.linspace(low_u, high_u, 181),
                                                 np.linspace(low_v, high_v, 91)))  # fmt: skip
    seeds = np.array([((at(kind, u, v) - point) ** 2).sum(axis=1).argmin() for point in points])
    best_u, best_v = u[seeds], v[seeds]
    reach_u, reach_v = (high_u - low_u) / 180, (high_v - low_v) / 90
    around = np.linspace(-1, 1, 9)
    for _ in range(40):
        try_u = (best_u[:, None, None] + reach_u * around[:, None]).clip(low_u, high_u)
        try_v = (best_v[:, None, None] + reach_v * around).clip(low_v, high_v)
        try_u, try_v = np.broadcast_arrays(try_u, try_v)
        far = np.linalg.norm(at(kind, try_u, try_v) - points[:, None, None], axis=-1)
        pick = far.reshape(len(points), -1).argmin(axis=1)
        rows = np.arange(len(points))
        best_u = try_u.reshape(len(points), -1)[rows, pick]
        best_v = try_v.reshape(len(points), -1)[rows, pick]
        reach_u, reach_v = reach_u * 0.6, reach_v * 0.6
    nearest: Floats = np.linalg.norm(at(kind, best_u, best_v) - points, axis=1)
    return nearest


def form(kind: str, n_u: int, n_v: int, **values: Any) -> tuple[Fold, Floats]:
    """A design, and its form in the target's own units: the vertices of a seam count once."""
    fold = DESIGN.run(
        DESIGN.validate({"surface": {"kind": kind}, "n_u": n_u, "n_v": n_v, **values})
    )
    assert fold.folded is not None
    points: Floats = np.asarray(fold.folded.vertices) / fold.meta["mm_per_unit"]
    return fold, points


def once(fold: Fold, points: Floats) -> Floats:
    assert fold.folded is not None
    again = {max(pair) for pair in np.asarray(fold.folded.seams).tolist()}
    return np.array([point for k, point in enumerate(points) if k not in again])


@pytest.mark.parametrize(
    ("kind", "n_u", "n_v"),
    [("catenoid", 8, 6), ("hyperbolic-paraboloid", 5, 4), ("moebius", 12, 3)],
)
def test_a_fitted_form_is_as_near_to_its_target_as_it_says(kind: str, n_u: int, n_v: int) -> None:
    plain, fitted = (form(kind, n_u, n_v, fit={"on": on, "iterations": 8}) for on in (False, True))
    found = []
    for fold, points in (plain, fitted):
        away = distances(kind, once(fold, points)) / DIAGONALS[kind]
        assert fold.meta["distance"]["mean"] == pytest.approx(away.mean(), rel=1e-5)
        assert fold.meta["distance"]["largest"] == pytest.approx(away.max(), rel=1e-5)
        found.append(float(away.mean()))
    assert found[1] < 0.95 * found[0]


@pytest.mark.parametrize("kind", list(SURFACES))
def test_the_diagonal_is_that_of_the_target_s_box(kind: str) -> None:
    low_u, high_u, low_v, high_v = SURFACES[kind][1]
    u, v = np.meshgrid(np.linspace(low_u, high_u, 2001), np.linspace(low_v, high_v, 401))
    box = np.ptp(at(kind, u, v).reshape(-1, 3), axis=0)
    assert float(np.linalg.norm(box)) == pytest.approx(DIAGONALS[kind], rel=1e-5)


def alternate_sums(fold: Fold, points: Floats) -> Floats:
    """Degrees that every other angle round each inner vertex adds up to, in space: (m, 2).

    An inner vertex is one that facets go round; their angles come from the lengths of their sides.
    """
    assert fold.folded is not None
    alias = {max(pair): min(pair) for pair in np.asarray(fold.folded.seams).tolist()}
    opposite: dict[int, dict[int, tuple[int, float]]] = defaultdict(dict)
    for face in np.asarray(fold.pattern.faces).tolist():
        a, b, c = (alias.get(corner, corner) for corner in face)
        for at_, after, before in ((a, b, c), (b, c, a), (c, a, b)):
            x, y, z = (
                float(np.linalg.norm(points[p] - points[q]))
                for p, q in ((at_, after), (at_, before), (after, before))
            )
            angle = np.degrees(np.arccos((x * x + y * y - z * z) / (2 * x * y)))
            opposite[at_][after] = (before, float(angle))
    sums = []
    for turns in opposite.values():
        if set(turns) == {before for before, _ in turns.values()}:  # a ring, not a fan
            here, ring = next(iter(turns)), []
            for _ in turns:
                here, angle = turns[here]
                ring.append(angle)
            sums.append((sum(ring[::2]), sum(ring[1::2])))
    return np.array(sums)


@pytest.mark.parametrize(
    ("kind", "n_u", "n_v"), [("hyperbolic-paraboloid", 6, 6), ("moebius", 12, 3)]
)
def test_every_other_angle_makes_a_straight_one_where_that_is_asked_and_only_there(
    kind: str, n_u: int, n_v: int
) -> None:
    plain, asked = (form(kind, n_u, n_v, flat_foldable=on) for on in (False, True))
    pattern = asked[0].pattern
    rim = np.unique(pattern.edges[pattern.assignments == Assignment.B])
    before, after = alternate_sums(*plain), alternate_sums(*asked)
    assert len(after) == len(before) == len(pattern.vertices) - len(rim)
    assert before.sum(axis=1) == pytest.approx(360, abs=1e-6)
    assert np.abs(before - 180).max() > 0.1
    assert after == pytest.approx(180, abs=1e-6)
