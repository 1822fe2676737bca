"""Six-crease tubes fold flat along the arc: how far, why not farther, through what angles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from six_crease_oracle import random_design

from foldmill import Fold, ImpossibleGeometry, InvalidParameters
from foldmill.check.intersection import penetrations
from foldmill.dihedral import dihedral_angles
from foldmill.motion import Motion
from foldmill_plugins.six_crease import DESIGN, solve
from foldmill_plugins.six_crease.along_arc import find_reach, folding_rate
from foldmill_plugins.six_crease.params import SixCreaseParams

FLAT_FOLDING = pytest.mark.parametrize("name", list(DESIGN.presets)[:7])


def run(name: str, **values: Any) -> tuple[Fold, Motion]:
    fold = DESIGN.run(DESIGN.preset(name).model_dump() | values)
    return fold, fold.motions["along-arc"]


@FLAT_FOLDING
def test_a_shape_folds_flat_without_passing_through_itself(name: str) -> None:
    fold, motion = run(name)
    assert (motion.reach, motion.reason) == (1, "")
    assert fold.symmetry is not None
    wedge = fold.pattern.faces[fold.symmetry.wedge]
    for t in np.linspace(0, 0.98, 99):
        places = motion.at(float(t))
        assert not len(penetrations(places, fold.pattern.edges, wedge)), t
        used = places[np.unique(wedge)]
        assert used[:, 0].min() >= -1e-9 * np.abs(places).max()


@pytest.mark.parametrize("t", [0.0, 0.03, 0.5, 0.97])
@FLAT_FOLDING
def test_the_whole_sheet_is_as_free_as_one_half_wedge_on_the_way(name: str, t: float) -> None:
    fold, motion = run(name)
    assert not len(penetrations(motion.at(t), fold.pattern.edges, fold.pattern.faces))


@FLAT_FOLDING
def test_at_full_folding_rate_everything_lies_in_one_plane(name: str) -> None:
    _, motion = run(name)
    assert np.abs(motion.at(1.0)[:, 1]).max() == 0


@pytest.mark.parametrize("tab", [0.0, 3.0])
@FLAT_FOLDING
def test_no_edge_changes_its_length_on_the_way(name: str, tab: float) -> None:
    fold, motion = run(name, tab=tab)
    assert fold.folded is not None
    assert np.array_equal(motion.at(0.0), fold.folded.vertices)
    for places in motion.frames(20):
        ends = places[fold.pattern.edges]
        change = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - fold.pattern.edge_lengths
        assert np.abs(change).max() <= 1e-12 * fold.pattern.size


def test_the_seam_opens_and_the_radius_of_point_one_stays() -> None:
    fold, motion = run("vase")
    assert fold.folded is not None
    seams = fold.folded.seams
    gaps = [
        float(np.linalg.norm(np.diff(motion.at(t)[seams], axis=1), axis=2).min())
        for t in (0.0, 0.1, 0.3)
    ]
    assert gaps[0] < 1e-12 < 1 < gaps[1] < gaps[2]
    first = int(np.flatnonzero((fold.pattern.vertices == 0).all(axis=1))[0])
    radii = [np.hypot(*places[first, :2]) for places in motion.frames(10)]
    assert np.ptp(radii) <= 1e-13


@pytest.mark.parametrize("tab", [0.0, 2.0])
def test_the_interrupted_vase_stops_where_a_radius_reaches_zero(tab: float) -> None:
    fold, motion = run("vase-interrupted", tab=tab)
    assert motion.reach == pytest.approx(0.05167, abs=1e-5)
    assert motion.reason.startswith("At a folding rate of 5.167 % point 7 reaches the axis")
    assert fold.meta["along-arc"] == {"folding_rate": 100 * motion.reach, "stops": motion.reason}
    radius = [abs(np.hypot(*places[:, :2].T)).min() for places in motion.frames(4)]
    assert radius == sorted(radius, reverse=True)
    assert radius[-1] < 1e-5
    with pytest.raises(InvalidParameters, match=r"goes from t = 0 to 0\.0516.*reaches the axis"):
        motion.at(0.06)


LOST = (745, 1963, 3061, 3336, 5526, 5707)
"""The only ones of 6,000 random designs in which a point loses its place on the way."""

SAID = {"": "", "crosses": "reaches the axis", "has no place": "loses its place"}


def test_the_reach_is_where_the_plain_solver_first_fails() -> None:
    """Step through the motions of random tubes one by one, and find the fault by hand."""
    stopped = {"has no place": 0, "crosses": 0, "": 0}
    for seed in (*range(400), *LOST):
        params = random_design(seed)
        if fault_at(params, 0.0):
            continue
        reach, reason = find_reach(params)
        rates = np.linspace(0, 1, 41)
        fault, t = next(
            ((fault, t) for t in rates if (fault := fault_at(params, float(t)))), ("", 1.0)
        )
        if fault:
            assert t - 1 / 40 - 1e-9 <= reach <= t
        else:
            assert reach == 1
        assert SAID[fault] in reason
        stopped[fault] += 1
    assert min(stopped.values()) >= 4, stopped


@pytest.mark.parametrize("seed", LOST)
def test_a_point_without_a_place_stops_the_motion_by_name(seed: int) -> None:
    params = random_design(seed)
    reach, reason = find_reach(params)
    i = int(reason.split("point ")[1].split()[0])
    assert f"point {i} loses its place: point {i - 1} comes {params.w:.6g} mm from" in reason
    assert not fault_at(params, reach)
    with pytest.raises(ImpossibleGeometry, match=f"Point {i} has no place"):
        solve.meridian(params, solve.wedge_angle(params) * (1 - reach - 1e-6))


def fault_at(params: SixCreaseParams, t: float) -> str:
    try:
        places = solve.meridian(params, solve.wedge_angle(params) * (1 - t))
    except ImpossibleGeometry:
        return "has no place"
    return "crosses" if places[:, 0].min() < 0 else ""


def test_where_the_next_step_is_not_determined_the_motion_does_not_begin() -> None:
    points = {i: {"y": y} for i, y in enumerate((0, 0, 30, 40), start=1)}
    points[3]["gamma"] = 120
    length = 10 / np.tan(np.pi / 6)
    fold = DESIGN.run({"n": 6, "L": length, "phi": 90, "beta": 90, "points": points})
    motion = fold.motions["along-arc"]
    assert motion.reach == 0
    assert "point 3 can turn freely about point 1" in motion.reason
    assert fold.folded is not None
    assert np.array_equal(motion.at(0.0), fold.folded.vertices)


def test_a_tube_that_crosses_its_axis_does_not_move() -> None:
    params = DESIGN.preset("cup")
    points = {i: {"y": point.y, "branch": 1} for i, point in params.points.items()}
    for beta in range(0, 360, 10):
        values = params.model_dump() | {"beta": beta, "points": points}
        try:
            places = solve.meridian(DESIGN.validate(values))
        except ImpossibleGeometry:
            continue
        if places[:, 0].min() < -1 and places[:, 0].max() > 1:
            break
    else:
        pytest.fail("no crossing tube among them")
    motion = DESIGN.run(values).motions["along-arc"]
    assert motion.reach == 0
    assert "on both sides of its axis from the start" in motion.reason


def test_the_folding_rate_is_that_of_the_thesis() -> None:
    params = DESIGN.preset("vase")
    assert [folding_rate(params, theta) for theta in (18, 9, 0)] == [0, 50, 100]


@pytest.mark.parametrize("i", [5, 6])
def test_the_dihedral_angles_of_a_vertex_go_from_the_form_to_flat(i: int) -> None:
    fold, motion = run("candlestick")
    vertex = inner_vertex(fold, i)
    times = np.linspace(0, 1, 26)
    table = dihedral_angles(fold, motion, vertex, times)
    assert table.angles.shape == (26, 6)
    start = 180 - np.abs(fold.pattern.fold_angles[table.edges])
    assert np.abs(table.angles[0] - start).max() < 1e-9
    # The vertex mirrors itself: angles one and four are on the line, the others come in pairs.
    assert np.abs(table.angles[:, [1, 2]] - table.angles[:, [5, 4]]).max() < 1e-9
    flat = np.minimum(table.angles[-1], 180 - table.angles[-1])
    assert flat.max() < 1e-5
    assert np.abs(np.diff(table.angles, axis=0)).max() < 40


def inner_vertex(fold: Fold, i: int) -> int:
    """Return p_i of the wedge at x = 0."""
    params = DESIGN.preset("candlestick")
    spot = solve.flat(params)[i - 1]
    gaps = np.linalg.norm(np.abs(fold.pattern.vertices) - np.abs(spot), axis=1)
    return int(gaps.argmin())
