"""The limit rule against the forms themselves, solved with hardly any angle between the planes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import pytest
from six_crease_oracle import random_design

from foldmill import ImpossibleGeometry, InvalidParameters
from foldmill.axisymmetric import along_arc, flattened, rosette, strip, tube
from foldmill.axisymmetric.points import LinePoint
from foldmill.axisymmetric.rosette import HalfWedge, Rosette
from foldmill.folded import fold_angles
from foldmill_plugins.six_crease import solve

THIN = 1e-6
"""rad between the planes: so near the limit, and still far above rounding."""
Case = tuple[Rosette, Mapping[int, int], np.ndarray, np.ndarray]
"""A form, its branches, its points (m, 2) at the limit, its vertices (V, 3) just before it."""


def rotational(seed: int) -> Case | None:
    rng = np.random.default_rng(seed)
    n, last = int(rng.integers(3, 14)), int(rng.integers(4, 9))
    a = [0.0, float(rng.uniform(20, 60))]
    for _ in range(last - 1):
        a.append(max(a[-1] * rng.uniform(0.8, 1.2), a[-2]) + float(rng.uniform(4, 40)))
    points = {
        i: LinePoint(a=a[i], branch=1 if rng.random() < 0.5 else -1) for i in range(1, last + 1)
    }
    try:
        solved = strip.solve(n, float(rng.uniform(5, 175)), points)
    except (ImpossibleGeometry, InvalidParameters):
        return None
    branches = {i: point.branch for i, point in points.items() if i >= 2}
    rose = rosette.assemble(HalfWedge.of(solved))
    limit, thin = along_arc.meridians(solved, branches, np.array([0.0, THIN]))
    return rose, branches, limit, rose.turned(_in_space(thin, 0), THIN)


def six_crease(seed: int) -> Case | None:
    params = random_design(seed)
    try:
        half = tube.half_wedge(params.n, solve.flat(params), solve.meridian(params))
    except ImpossibleGeometry:
        return None
    limit, thin = solve.meridians(params, np.array([0.0, THIN]))
    branches = {i - 1: point.branch for i, point in params.points.items() if i >= 3}
    whole = tube.assemble(half)
    return whole, branches, limit, whole.turned(_in_space(thin, 1), THIN)


def _in_space(meridian: np.ndarray, on_l2: int) -> np.ndarray:
    azimuth = np.where(np.arange(len(meridian)) % 2 == on_l2, THIN, 0.0)
    r, z = meridian.T
    return np.column_stack([r * np.cos(azimuth), r * np.sin(azimuth), z])


def forms(kind: str, seeds: range) -> Iterator[Case]:
    made = ({"rotational": rotational, "six-crease": six_crease}[kind](seed) for seed in seeds)
    yield from (case for case in made if case is not None)


def one_wedge(whole: Rosette) -> np.ndarray:
    """Return the creases at the inner vertices of the second wedge, each kind once."""
    inner = (whole.edge_faces >= 0).all(axis=1)
    return np.flatnonzero(inner & (whole.turn[whole.edges] == 1).all(axis=1))


@pytest.mark.parametrize("kind", ["rotational", "six-crease"])
def test_a_crease_ends_folded_as_the_branches_say_and_to_the_side_that_depth_says(
    kind: str,
) -> None:
    creases = folded = 0
    for whole, branches, limit, thin in forms(kind, range(200)):
        rule = flattened.ends_folded(whole, branches)
        signs = flattened.folded_signs(whole, limit)
        angles = fold_angles(thin, whole.edges, whole.faces, whole.edge_faces)
        for edge in one_wedge(whole).tolist():
            assert rule[edge] == (abs(angles[edge]) > 90)
            assert not rule[edge] or signs[edge] == np.sign(angles[edge])
            creases, folded = creases + 1, folded + bool(rule[edge])
    assert creases >= 1000
    assert 200 < folded < creases - 200


@pytest.mark.parametrize("kind", ["rotational", "six-crease"])
def test_beside_the_border_and_on_the_axis_nothing_is_said(kind: str) -> None:
    whole, branches, limit, _ = next(forms(kind, range(50)))
    border = (whole.edge_faces < 0).any(axis=1)
    assert not flattened.ends_folded(whole, branches)[border].any()
    assert not flattened.folded_signs(whole, limit)[border].any()
    on_axis = limit * [0.0, 1.0]
    assert not flattened.folded_signs(whole, on_axis).any()
