"""Tubes of six-crease bases: their shapes, their second solver, their mirrors, their refusals."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from six_crease_oracle import by_spheres, random_design

from foldmill import Assignment, Fold, ImpossibleGeometry, InvalidParameters
from foldmill.axisymmetric import tube
from foldmill.check import check
from foldmill.check.intersection import penetrations
from foldmill_plugins.six_crease import DESIGN, freedoms, solve
from foldmill_plugins.six_crease.params import HeightPoint, SixCreaseParams, points_of

SHAPES = pytest.mark.parametrize("name", DESIGN.presets)
DESIGNS = 2100


def space(fold: Fold) -> np.ndarray:
    assert fold.folded is not None
    return fold.folded.vertices


def solvable(count: int) -> Iterator[tuple[SixCreaseParams, np.ndarray]]:
    """Yield the first random designs that have a form, and its P_1 … P_T."""
    seed = 0
    while count:
        params = random_design(seed)
        seed += 1
        try:
            yield params, solve.meridian(params)
        except ImpossibleGeometry:
            continue
        count -= 1


def changed(params: SixCreaseParams, **values: Any) -> SixCreaseParams:
    return DESIGN.validate(params.model_dump() | values)


@pytest.mark.parametrize("block", range(3))
def test_spheres_and_planes_find_the_same_points_and_miss_the_same_ones(block: int) -> None:
    worst, found, missed = 0.0, 0, 0
    for seed in range(block * DESIGNS // 3, (block + 1) * DESIGNS // 3):
        params = random_design(seed)
        slow = by_spheres(params)
        if isinstance(slow, int):
            with pytest.raises(ImpossibleGeometry, match=f"^Point {slow} has no place"):
                solve.meridian(params)
            missed += 1
            continue
        quick = solve.meridian(params)
        worst = max(worst, float(np.abs(quick - slow).max() / np.abs(quick).max()))
        found += 1
    assert worst <= 1e-12
    assert found >= 340
    assert missed >= 100


def test_many_forms_at_once_are_the_forms_one_by_one() -> None:
    for params, places in solvable(60):
        theta = solve.wedge_angle(params)
        several = solve.meridians(params, np.array([theta, theta / 2, theta]))
        size = np.abs(places).max()
        assert np.abs(several[[0, 2]] - places).max() <= 1e-12 * size
        if np.isfinite(several[1]).all():
            assert np.abs(several[1] - solve.meridian(params, theta / 2)).max() <= 1e-12 * size
        else:
            with pytest.raises(ImpossibleGeometry):
                solve.meridian(params, theta / 2)


@pytest.mark.parametrize("block", range(4))
def test_a_tube_upside_down_has_the_other_angles_and_branches(block: int) -> None:
    for params, places in list(solvable(200))[block::4]:
        points = {
            i: HeightPoint(y=point.y, branch=1 if point.branch < 0 else -1)
            for i, point in params.points.items()
        }
        mirror = params.model_copy(
            update={"phi": 180 - params.phi, "beta": 180 - params.beta, "points": points}
        )
        error = np.abs(solve.meridian(mirror) - places * [1, -1]).max()
        assert error <= 1e-11 * np.abs(places).max()


def test_only_the_radius_of_point_one_shapes_the_tube() -> None:
    rng = np.random.default_rng(5)
    for params, places in solvable(200):
        radius = params.L * np.sin(np.radians(params.phi))
        phi = float(rng.uniform(10, 170))
        other = changed(params, phi=phi, L=radius / np.sin(np.radians(phi)))
        moved = solve.meridian(other)
        shift = moved[0, 1] - places[0, 1]
        error = np.abs(moved - places - [0, shift]).max()
        assert error <= 1e-11 * np.abs(places).max()


def test_the_branch_is_the_mountain_or_valley_of_its_crease() -> None:
    creases = 0
    for params, places in solvable(80):
        whole = tube.assemble(tube.half_wedge(params.n, solve.flat(params), places))
        for (a, b), angle in zip(whole.edge_origins.tolist(), whole.fold_angles, strict=True):
            if b - a == 2 and 1e-3 < abs(angle) < 180 - 1e-3:
                assert np.sign(angle) == params.points[b + 1].branch * np.sign(places[b - 1, 0])
                creases += 1
    assert creases > 1000


@SHAPES
def test_a_shape_folds_from_one_sheet_and_closes_its_seam(name: str) -> None:
    fold = DESIGN.run(DESIGN.preset(name))
    report = check(fold)
    assert not report.findings
    assert float(report.figures["isometry"]) <= 1e-12
    assert float(report.figures["angle_sum_rad"]) <= 1e-11
    assert float(report.figures["folded_angle_sum_rad"]) <= 1e-11
    assert fold.folded is not None
    assert len(fold.folded.seams) == 4
    ends = space(fold)[fold.folded.seams]
    assert np.abs(ends[:, 0] - ends[:, 1]).max() <= 1e-15 * 20 * fold.folded.size
    across = fold.pattern.vertices[fold.folded.seams]
    assert np.abs(across[:, 1] - across[:, 0]) == pytest.approx(np.full((4, 2), [200.0, 0.0]))
    assert fold.pattern.count(Assignment.U) == 0
    assert not len(penetrations(space(fold), fold.pattern.edges, fold.pattern.faces))


@SHAPES
def test_the_front_of_the_sheet_is_the_outside_of_the_tube(name: str) -> None:
    """A ray from the axis leaves the tube at the last facet it meets, through its front."""
    fold = DESIGN.run(DESIGN.preset(name))
    corners = space(fold)[fold.pattern.faces]
    low, high = space(fold)[:, 2].min(), space(fold)[:, 2].max()
    for share, azimuth in ((0.4, 0.1), (0.5, 0.2), (0.6, 1.3)):
        ray = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        start = np.array([0.0, 0.0, low + share * (high - low)])
        distance, face = last_hit(corners, start, ray)
        a, b, c = corners[face]
        assert distance > 0
        assert np.cross(b - a, c - a) @ ray > 0


def last_hit(corners: np.ndarray, start: np.ndarray, ray: np.ndarray) -> tuple[float, int]:
    """Return how far along a ray the last triangle (F, 3, 3) lies, and which it is."""
    hits = []
    for face, (a, b, c) in enumerate(corners):
        u, v, far = np.linalg.solve(np.column_stack([b - a, c - a, -ray]), start - a)
        if u >= 0 and v >= 0 and u + v <= 1:
            hits.append((float(far), face))
    return max(hits)


def test_a_tube_made_upside_down_looks_the_same_from_outside() -> None:
    params = DESIGN.preset("rugby")
    points = {i: {"y": point.y, "branch": -point.branch} for i, point in params.points.items()}
    upright = DESIGN.run(params)
    turned = DESIGN.run(
        changed(params, phi=180 - params.phi, beta=180 - params.beta, points=points)
    )
    for kind in (Assignment.M, Assignment.V):
        assert upright.pattern.count(kind) == turned.pattern.count(kind)
    assert np.abs(upright.pattern.vertices[:, 0] + turned.pattern.vertices[:, 0]).max() < 1e-12


@pytest.mark.parametrize("last", [4, 5, 6, 9])
@pytest.mark.parametrize("n", [3, 6, 10])
def test_degrees_of_freedom_are_those_that_the_hinges_leave(n: int, last: int) -> None:
    params = some_design(n, last)
    fold = DESIGN.run(params)
    assert fold.folded is not None
    vertices, edges, seams = space(fold), fold.pattern.edges, fold.folded.seams
    assert fold.meta["freedoms"]["open sheet"] == freedoms.of_sheet(n, last)
    assert freedoms.of_sheet(n, last) == 3 * len(vertices) - len(edges) - 6
    assert freedoms.of_sheet(n, last) == 3 * len(vertices) - 6 - rank(vertices, edges)
    glued = np.arange(len(vertices))
    glued[seams[:, 1]] = seams[:, 0]
    kept, number = np.unique(glued, return_inverse=True)
    tube_edges = np.unique(np.sort(number[edges], axis=1), axis=0)
    assert fold.meta["freedoms"]["glued tube"] == freedoms.of_tube(n)
    assert freedoms.of_tube(n) == 3 * len(kept) - len(tube_edges) - 6
    assert freedoms.of_tube(n) == 3 * len(kept) - 6 - rank(vertices[kept], tube_edges)


def some_design(n: int, last: int) -> SixCreaseParams:
    """Return the first random design of its size that has a form."""
    rng = np.random.default_rng(n + 100 * last)
    while True:
        y = 10 * np.cumsum(rng.uniform(0.2, 1.5, last))
        points = {i: {"y": float(y[i - 1])} for i in range(1, last + 1)}
        values = {"n": n, "L": 8 * rng.random(), "phi": 90, "beta": 360 * rng.random()}
        params = DESIGN.validate(values | {"points": points})
        try:
            solve.meridian(params)
        except ImpossibleGeometry:
            continue
        return params


def rank(vertices: np.ndarray, edges: np.ndarray) -> int:
    """Return how many edge lengths can change independently."""
    matrix = np.zeros((len(edges), len(vertices), 3))
    rows, (a, b) = np.arange(len(edges)), edges.T
    step = vertices[a] - vertices[b]
    step /= np.linalg.norm(step, axis=1, keepdims=True)
    matrix[rows, a], matrix[rows, b] = step, -step
    return int(np.linalg.matrix_rank(matrix.reshape(len(edges), -1)))


def test_the_thesis_counts_43_for_ten_wedges_and_nine_points() -> None:
    assert (freedoms.of_sheet(10, 9), freedoms.of_tube(10)) == (43, 34)


def test_l_at_its_bound_leaves_point_two_one_place() -> None:
    params = DESIGN.preset("ball")
    bound = solve.longest(params)
    assert bound == pytest.approx(
        np.hypot(10, 6.5) / np.sin(np.pi / 10) / np.sin(np.radians(146.9)), rel=1e-14
    )
    theta = np.array([solve.wedge_angle(params)])
    one, two = (
        solve.meridians(changed(params, L=bound, beta=beta), theta)[0, 1] for beta in (0, 90)
    )
    assert np.abs(one - two).max() < 1e-5


def test_where_the_circles_are_one_gamma_is_the_direction() -> None:
    values = {"n": 6, "w": 10, "L": 10 / np.tan(np.pi / 6), "phi": 90, "beta": 90}
    points = {i: {"y": y} for i, y in enumerate((0, 0, 30, 40), start=1)}
    with_gamma = points | {3: {"y": 30, "gamma": 120}}
    places = solve.meridian(DESIGN.validate(values | {"points": with_gamma}))
    assert places[2] - places[0] == pytest.approx([-15, 30 * np.sqrt(3) / 2])


FOUR: dict[int, dict[str, Any]] = {i: {"y": 5.0 * i} for i in (1, 2, 3, 4)}
NINE = DESIGN.preset("vase").model_dump()["points"]


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"tab": -1}, "tab must be at least 0"),
        ({"tab": 1e-9}, "A glue tab 1e-09 mm wide holds nothing; make it wider"),
        ({"w": 10001}, "w must be at most 10000"),
        ({"L": 10001}, "L must be at most 10000"),
        ({"beta": 361}, "beta must be at most 360"),
        ({"points": FOUR | {4: {"y": 1e5}}}, r"points\.4\.y must be at most 10000 mm"),
        ({"taper": 76}, "taper must be at most 75"),
        ({"points": {}}, "points: a tube needs points 1 to 4 .* not 0 of them"),
        (
            {"points": {i: FOUR[i] for i in (1, 2, 4)}},
            r"points: the points must be numbered 1, 2, 3 …, not \[1, 2, 4\]",
        ),
        ({"points": FOUR | {3: {"y": 15, "branch": 2}}}, r"points\.3\.branch must be -1 or 1"),
        ({"points": FOUR | {3: {"branch": 1}}}, r"points\.3\.y is missing"),
    ],
)
def test_wrong_parameters_are_refused_by_name(values: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InvalidParameters, match=sentence):
        DESIGN.run(values)


def test_a_tab_without_room_is_refused_with_the_room_there_is() -> None:
    values = {"tab": 9, "points": NINE, "L": 22.1, "phi": 92.9, "beta": 63.7}
    said = (
        r"A glue tab 9 mm wide does not fit at the seam edge that is 10\.6 mm long: with a "
        r"taper of 30° it must be narrower than 7\.752 mm"
    )
    with pytest.raises(ImpossibleGeometry, match=said):
        DESIGN.run(values)


@pytest.mark.parametrize("branches", ["", "+-+", "+-+-+-+-", "+-+-+-0"])
def test_branches_written_in_a_row_must_be_one_for_each_point_from_three_on(branches: str) -> None:
    with pytest.raises(InvalidParameters, match="9 points need 7 branches, each"):
        points_of("0 5 24.5 25.9 33.8 36.5 49.7 57.5 67.1", branches)
