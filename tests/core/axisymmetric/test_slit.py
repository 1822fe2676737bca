"""A rosette that is slit along one line: closed it is the rosette, and it opens along the arc."""

from __future__ import annotations

import numpy as np
import pytest
from slit_forms import FREE, PRESETS, form, space

from foldmill import Fold, ImpossibleGeometry, InvalidParameters
from foldmill.check import check
from foldmill.check.motion import scan
from foldmill.folded import fold_angles
from foldmill.motion import Motion
from foldmill_plugins.rotational import DESIGN, RotationalParams

EVERY = pytest.mark.parametrize("name", PRESETS)
FOLDS_FLAT = pytest.mark.parametrize("name", FREE)


def arc_of(name: str) -> tuple[Fold, Motion]:
    fold = form(name, slit=True)
    return fold, fold.motions["along-arc"]


def radii_of_bank(fold: Fold, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the two outermost bank vertices as seen from above, (2,) each."""
    assert fold.folded is not None
    first, second = fold.folded.seams[-1]
    return places[first, :2], places[second, :2]


@EVERY
def test_closed_it_is_the_form_without_a_slit(name: str) -> None:
    whole, cut = form(name, slit=False), form(name, slit=True)
    assert np.array_equal(space(whole)[whole.pattern.faces], space(cut)[cut.pattern.faces])
    assert np.array_equal(
        whole.pattern.vertices[whole.pattern.faces], cut.pattern.vertices[cut.pattern.faces]
    )
    assert not check(cut).findings


@EVERY
def test_the_banks_lie_upon_each_other_in_the_pattern_and_in_space(name: str) -> None:
    fold = form(name, slit=True)
    assert fold.folded is not None
    pairs = fold.folded.seams
    for spots in (fold.pattern.vertices, fold.folded.vertices):
        assert np.array_equal(spots[pairs[:, 0]], spots[pairs[:, 1]])
    away = np.hypot(*fold.pattern.vertices[pairs[:, 0]].T)
    points = DESIGN.preset(name).points
    assert away == pytest.approx([points[i].a for i in sorted(points) if i % 2 == 0])


@EVERY
def test_a_slit_costs_its_creases_and_adds_its_points(name: str) -> None:
    """Euler: both sheets are discs; the slit has T // 2 edges, each of them twice."""
    whole, cut = form(name, slit=False).pattern, form(name, slit=True).pattern
    more = len(DESIGN.preset(name).points) // 2
    assert len(cut.vertices) == len(whole.vertices) + more
    assert len(cut.edges) == len(whole.edges) + more
    assert len(cut.faces) == len(whole.faces)
    for pattern in (whole, cut):
        assert len(pattern.vertices) - len(pattern.edges) + len(pattern.faces) == 1
    assert len(cut.outline()) == 1
    assert cut.letters().count("B") == whole.letters().count("B") + 2 * more
    same = len(whole.edges) - more
    assert sum(cut.letters().count(letter) for letter in "MVF") == same - whole.letters().count("B")


@EVERY
def test_no_edge_changes_its_length_on_the_way(name: str) -> None:
    fold, motion = arc_of(name)
    assert np.array_equal(motion.at(0.0), space(fold))
    for places in motion.frames(40):
        ends = places[fold.pattern.edges]
        change = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - fold.pattern.edge_lengths
        assert np.abs(change).max() <= 1e-12 * fold.pattern.size


@EVERY
def test_the_motion_begins_where_the_form_is(name: str) -> None:
    fold, motion = arc_of(name)
    step = np.abs(motion.at(1e-9) - space(fold)).max()
    assert step < 1e-4 * fold.pattern.size


@EVERY
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_the_slit_opens_by_twice_n_times_what_the_planes_close(name: str, share: float) -> None:
    fold, motion = arc_of(name)
    t = share * motion.reach
    params = DESIGN.preset(name)
    theta = np.pi / params.n
    one, two = radii_of_bank(fold, motion.at(t))
    gap = np.arctan2(one[0] * two[1] - one[1] * two[0], one @ two)
    opened = 2 * params.n * (theta - theta * (1 - t))
    assert (-gap) % (2 * np.pi) == pytest.approx(opened % (2 * np.pi), abs=1e-9)


@EVERY
def test_the_open_form_is_its_own_mirror_image(name: str) -> None:
    """The middle of the opened sheet is a plane through the axis; the banks change places."""
    fold, motion = arc_of(name)
    assert fold.folded is not None
    places = motion.at(0.6 * motion.reach)
    first, second = fold.folded.seams.T
    angle = np.arctan2(*(places[first[-1], :2] + places[second[-1], :2])[::-1])
    turned = places[:, :2] @ np.array(
        [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    )
    upright = np.column_stack([turned, places[:, 2]])
    mirrored = upright * [1, -1, 1]
    gaps = np.linalg.norm(upright[:, None] - mirrored[None], axis=2)
    assert gaps.min(axis=1).max() < 1e-9 * fold.pattern.size
    assert gaps[first, second].max() < 1e-9 * fold.pattern.size


@FOLDS_FLAT
def test_at_the_end_everything_lies_in_one_plane_and_folded_creases_follow_the_limit_rule(
    name: str,
) -> None:
    """Zigzag crease (i-1, i) ends folded where the branches of i and i + 1 are alike."""
    fold, motion = arc_of(name)
    places = motion.at(1.0)
    assert np.abs(places[:, 1]).max() == 0
    pattern, points = fold.pattern, DESIGN.preset(name).points
    angles = np.abs(fold_angles(places, pattern.edges, pattern.faces, pattern.edge_faces))
    assert np.minimum(angles, 180 - angles).max() < 1e-5
    away = np.hypot(*pattern.vertices.T)
    for i in range(2, len(points)):
        ends = np.sort(away[pattern.edges], axis=1)
        own = np.isclose(ends, sorted((points[i - 1].a, points[i].a))).all(axis=1)
        inner = own & (pattern.edge_faces >= 0).all(axis=1)
        is_folded = points[i + 1].branch == points[i].branch
        assert inner.any()
        assert angles[inner] == pytest.approx(180.0 if is_folded else 0.0, abs=1e-5)


@EVERY
def test_the_way_is_free_as_far_as_it_goes(name: str) -> None:
    fold, motion = arc_of(name)
    seen = scan(fold, motion, 24)
    assert seen.is_free
    assert seen.free_until == motion.reach


def test_where_a_radius_reaches_the_axis_the_motion_stops_and_says_so() -> None:
    fold, motion = arc_of("bowl-n8")
    assert motion.reach == pytest.approx(0.22058, abs=1e-5)
    assert motion.reason.startswith("At a folding rate of 22.06 % point 5 reaches the axis")
    assert fold.meta["along-arc"] == {"folding_rate": 100 * motion.reach, "stops": motion.reason}
    away = np.hypot(*motion.at(motion.reach)[:, :2].T)
    inner = np.hypot(*fold.pattern.vertices.T) > 1
    assert away[inner].min() < 1e-4
    with pytest.raises(InvalidParameters, match=r"goes from t = 0 to 0\.2205.*reaches the axis"):
        motion.at(0.23)


def test_a_form_on_both_sides_of_its_axis_does_not_move() -> None:
    for seed in range(200):
        params = random_params(seed)
        fold = DESIGN.run(params)
        assert fold.symmetry is not None
        if not fold.symmetry.one_sided:
            break
    else:
        pytest.fail("no crossing form among them")
    motion = fold.motions["along-arc"]
    assert motion.reach == 0
    assert "on both sides of its axis from the start" in motion.reason


def test_where_a_point_can_turn_freely_the_way_is_not_determined() -> None:
    points = {i: {"a": a} for i, a in enumerate((40, 40 / np.cos(np.pi / 6), 70, 90), start=1)}
    points[3]["gamma"] = 120.0
    fold = DESIGN.run({"n": 6, "phi": 90, "points": points, "slit": True})
    motion = fold.motions["along-arc"]
    assert motion.reach == 0
    assert "point 3 can turn freely about point 1" in motion.reason
    assert np.array_equal(motion.at(0.0), space(fold))


def random_params(seed: int) -> RotationalParams:
    chance = np.random.default_rng(seed)
    count = int(chance.integers(2, 8))
    a: list[float] = [0.0]
    for i in range(1, count + 1):
        low = max(a[max(i - 2, 0)], 0.7 * a[-1])
        a.append(low + float(chance.uniform(8, 40)))
    points = {i: {"a": a[i], "branch": int(chance.choice((-1, 1)))} for i in range(1, len(a))}
    phi = float(chance.uniform(20, 160))
    return DESIGN.validate(
        {"n": int(chance.integers(3, 15)), "phi": phi, "points": points, "slit": True}
    )


def place_by_spheres(params: RotationalParams, theta: float) -> np.ndarray:
    """Solve the strip slowly: the points of a plane at two distances from two points before.

    Among the two places, the one whose triangle bends to the side that the branch names.
    """
    n, points = params.n, params.points
    axes = [np.array([np.cos(t), np.sin(t)]) for t in (np.pi / n, 0.0)]
    flat = [np.zeros(2)] + [points[i].a * axes[i % 2] for i in sorted(points)]
    planes = [np.array([np.cos(t), np.sin(t), 0.0]) for t in (theta, 0.0)]
    up, tilt = np.array([0.0, 0.0, 1.0]), np.radians(params.phi)
    spots = [np.zeros(3), points[1].a * (np.sin(tilt) * planes[1] + np.cos(tilt) * up)]
    for i in range(2, len(flat)):
        out = planes[i % 2]
        one, two = spots[i - 2], spots[i - 1]
        r = np.linalg.norm(flat[i] - flat[i - 2])
        far = float(np.linalg.norm(flat[i] - flat[i - 1]))
        base = np.array([one @ out, one[2]])
        foot = np.array([two @ out, two[2]])
        beside = float(np.linalg.norm(two - foot[0] * out - foot[1] * up))
        q = foot - base
        across = np.array([-q[1], q[0]]) / np.linalg.norm(q)
        along = (r**2 - (far**2 - beside**2) + q @ q) / (2 * np.linalg.norm(q))
        rise = np.sqrt(max(r**2 - along**2, 0.0))
        spot = base + along * q / np.linalg.norm(q) + points[i].branch * rise * across
        spots.append(spot[0] * out + spot[1] * up)
    return np.array(spots)


def test_a_slow_solver_in_space_finds_the_same_way() -> None:
    looked_at = 0
    for seed in range(120):
        params = random_params(seed)
        fold = DESIGN.run(params)
        motion = fold.motions["along-arc"]
        for share in (0.2, 0.7, 0.95):
            t = share * motion.reach
            if not t:
                continue
            slow = place_by_spheres(params, np.pi / params.n * (1 - t))
            places = motion.at(t)
            gaps = np.linalg.norm(slow[:, None] - places[None], axis=2).min(axis=1)
            assert gaps.max() < 1e-6 * fold.pattern.size, (seed, t)
            looked_at += 1
    assert looked_at > 150


def test_a_slit_can_be_asked_of_any_form_that_exists() -> None:
    for seed in range(30):
        params = random_params(seed)
        try:
            whole = DESIGN.run(params.model_dump() | {"slit": False})
        except ImpossibleGeometry:
            continue
        cut = DESIGN.run(params)
        codes = {finding.code for finding in check(cut).findings}
        assert codes == {finding.code for finding in check(whole).findings}, seed
