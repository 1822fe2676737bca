"""Two facets pass through each other, or they do not; touching is allowed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

from foldmill import Fold, FoldmillError, Symmetry
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.points import LinePoint
from foldmill.check import penetration
from foldmill.check.intersection import penetrations
from foldmill.check.symmetry import half_wedge_decides

NO_EDGES = np.zeros((0, 2), np.intp)
PAIR = np.array([[0, 1, 2], [3, 4, 5]])


def penetrate(one: ArrayLike, two: ArrayLike) -> bool:
    corners = np.vstack([np.asarray(one, np.float64), np.asarray(two, np.float64)])
    return bool(len(penetrations(corners, NO_EDGES, PAIR)))


FLOOR = [[0, 0, 0], [10, 0, 0], [0, 10, 0]]


@pytest.mark.parametrize(
    ("other", "verdict"),
    [
        ([[2, 2, -1], [2, 2, 1], [3, 4, 1]], True),
        ([[2, 2, 0], [2, 2, 1], [3, 4, 1]], False),  # stands on it with a corner
        ([[2, 2, 0], [4, 2, 0], [3, 3, 5]], False),  # stands on it with a side
        ([[1, 1, 0], [4, 1, 0], [1, 4, 0]], False),  # lies upon it
        ([[20, 2, -1], [20, 2, 1], [23, 4, 1]], False),  # beside it
        ([[0, 0, 0], [5, 5, 5], [5, 5, -5]], True),  # through it from a shared corner
        ([[0, 0, 0], [-5, 5, 5], [-5, 5, -5]], False),  # away from a shared corner
        ([[1, 1, 1], [1, 1, 1], [1, 1, -1]], False),  # of no area
    ],
)
def test_touching_is_not_penetration(other: ArrayLike, verdict: bool) -> None:
    assert penetrate(FLOOR, other) is verdict
    assert penetrate(other, FLOOR) is verdict


def test_a_sheet_that_passes_a_facet_exactly_along_a_crease_penetrates_it() -> None:
    tent = [[2, 2, 0], [4, 2, 0], [3, 2, 3], [3, 2.5, -3]]
    vertices = np.array([*FLOOR, *tent], float)
    edges = np.array([[3, 4], [4, 5], [5, 3], [3, 6], [6, 4]])
    faces = np.array([[0, 1, 2], [3, 4, 5], [4, 3, 6]])
    assert penetrations(vertices, edges, faces).tolist() == [[0, 1], [0, 2]]
    vertices[6, 2] = 3  # both sides of the crease on top: the tent only stands on the floor
    assert not len(penetrations(vertices, edges, faces))


def test_verdicts_agree_with_whole_number_arithmetic() -> None:
    rng = np.random.default_rng(11)
    verdicts = []
    for _ in range(400):
        corners = rng.integers(-20, 21, (2, 3, 3))
        exact = _pierces(*corners.tolist())
        if exact is not None:
            verdicts.append(exact)
            assert penetrate(corners[0], corners[1]) is exact
    assert 100 < sum(verdicts) < len(verdicts) - 100


def _pierces(one: list[list[int]], two: list[list[int]]) -> bool | None:
    """Tell whether an edge of one triangle goes through the other; None where that is a tie."""
    hit = False
    for triangle, other in ((one, two), (two, one)):
        for k in range(3):
            p, q = other[k - 1], other[k]
            a, b, c = triangle
            ends = [_volume(a, b, c, p), _volume(a, b, c, q)]
            round_ = [_volume(p, q, triangle[j - 1], triangle[j]) for j in range(3)]
            if 0 in ends or 0 in round_:
                return None
            crosses = (ends[0] > 0) != (ends[1] > 0)
            hit |= crosses and len({value > 0 for value in round_}) == 1
    return hit


def _volume(a: list[int], b: list[int], c: list[int], d: list[int]) -> int:
    u, v, w = ([p[k] - d[k] for k in range(3)] for p in (a, b, c))
    return (
        u[0] * (v[1] * w[2] - v[2] * w[1])
        - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
    )


def forms(seed: int, count: int) -> list[Fold]:
    """Return random rotational forms, folded anywhere between flat and closed."""
    rng = np.random.default_rng(seed)
    made: list[Fold] = []
    while len(made) < count:
        steps = rng.uniform(0.2, 1.5, int(rng.integers(2, 11)))
        a = [sum(steps[i % 2 : i + 1 : 2]) * 50 for i in range(len(steps))]
        points = {
            i: LinePoint(a=float(each), branch=int(rng.choice([-1, 1])))  # type: ignore[arg-type]
            for i, each in enumerate(a, start=1)
        }
        try:
            solved = strip.solve(int(rng.integers(3, 9)), float(rng.uniform(0, 180)), points)
        except FoldmillError:
            continue
        half = rosette.HalfWedge.of(solved)
        made.append(rosette.fold(rosette.assemble(half), wedge_decides=True))
    return made


def test_half_a_wedge_decides_for_the_whole_form_where_no_radius_changes_its_sign() -> None:
    verdicts = []
    for fold in forms(seed=5, count=300):
        assert fold.symmetry is not None
        assert fold.folded is not None
        if not fold.symmetry.one_sided:
            continue
        pattern, solid = fold.pattern, fold.folded.vertices
        whole = penetrations(solid, pattern.edges, pattern.faces)
        wedge = penetrations(solid, pattern.edges, pattern.faces[fold.symmetry.wedge])
        verdicts.append(bool(len(whole)))
        assert bool(len(wedge)) is bool(len(whole))
        assert penetration(fold).figures["penetrations"] == len(whole)
    assert 20 < sum(verdicts) < len(verdicts) - 20


def test_where_radii_change_their_sign_all_facets_are_looked_at() -> None:
    free_wedges = 0
    for fold in forms(seed=6, count=60):
        assert fold.symmetry is not None
        assert fold.folded is not None
        if fold.symmetry.one_sided:
            continue
        wedge = fold.pattern.faces[fold.symmetry.wedge]
        free_wedges += not len(penetrations(fold.folded.vertices, fold.pattern.edges, wedge))
        (finding,) = penetration(fold).findings
        assert finding.code == "penetration"
    assert free_wedges > 5


def crossing() -> Fold:
    """Return a form with 48 penetrations that is symmetric and one-sided."""
    points = {i: LinePoint(a=a) for i, a in enumerate((40, 90, 140, 141, 200, 201), start=1)}
    half = rosette.HalfWedge.of(strip.solve(6, 30, points))
    return rosette.fold(rosette.assemble(half), wedge_decides=True)


CLAIMS = {
    "of no half wedge": Symmetry(1, np.array([], np.intp), True),
    "of too few faces": Symmetry(6, np.array([0, 1, 2]), True),
    "of another order": Symmetry(3, np.arange(10), True),
    "of one wedge whole": Symmetry(1, np.arange(30), True),
    "of the same face over and over": Symmetry(6, np.zeros(5, np.intp), True),
    "of faces from two wedges": Symmetry(6, np.array([0, 1, 2, 3, 14]), True),
    "of faces that are not there": Symmetry(6, np.array([0, 1, 2, 3, 600]), True),
    "of one side": Symmetry(6, np.arange(5), True),
    "of no order": Symmetry(0, np.arange(5), True),
}


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_symmetry_is_not_believed(claim: str) -> None:
    fold = crossing()
    lying = replace(fold, symmetry=CLAIMS[claim])
    assert penetration(fold).figures["penetrations"] == 48
    assert penetration(lying).figures["penetrations"] == 48


@pytest.mark.parametrize("change", ["shifted", "turned", "one vertex moved", "one-sided by name"])
def test_the_half_wedge_decides_only_for_what_is_symmetric_about_the_axis(change: str) -> None:
    for fold in forms(seed=8, count=20):
        assert fold.folded is not None
        assert fold.symmetry is not None
        solid, symmetry, faces = fold.folded.vertices.copy(), fold.symmetry, fold.pattern.faces
        assert half_wedge_decides(symmetry, solid, faces) is symmetry.one_sided
        if change == "shifted":
            solid += [1, 0, 0]
        elif change == "turned":
            solid = solid @ np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]])
        elif change == "one vertex moved":
            solid[-1] += [0, 0, 1e-4]
        elif symmetry.one_sided:
            continue
        assert not half_wedge_decides(replace(symmetry, one_sided=True), solid, faces)


def test_a_form_rounded_to_six_decimals_keeps_its_symmetry() -> None:
    for fold in forms(seed=9, count=20):
        assert fold.folded is not None
        assert fold.symmetry is not None
        rounded = np.round(fold.folded.vertices, 6)
        kept = half_wedge_decides(fold.symmetry, rounded, fold.pattern.faces)
        assert kept is fold.symmetry.one_sided
