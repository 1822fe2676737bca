"""The batch of a strip family says of each row what generate and check say of it."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from foldmill import Design, InvalidParameters, Outcome, Outcomes
from foldmill.axisymmetric.points import LinePoint
from foldmill.axisymmetric.rows import Rows, alike
from foldmill.configurations import one_by_one, outcomes, with_values
from foldmill_plugins.rotational import DESIGN as BOWL
from foldmill_plugins.rotational import RotationalParams
from foldmill_plugins.six_crease import DESIGN as TUBE
from foldmill_plugins.six_crease import batch, solve

Columns = dict[str, NDArray[np.float64]]
CANDLESTICK = TUBE.preset("candlestick")


def assert_alike(one: Outcomes, two: Outcomes) -> None:
    assert np.array_equal(one.codes, two.codes)
    assert np.array_equal(one.at, two.at)
    for name in {*one.figures, *two.figures}:
        nothing = np.full(len(one), np.nan)
        here, there = (each.figures.get(name, nothing) for each in (one, two))
        assert np.allclose(here, there, rtol=0, atol=1e-9, equal_nan=True), name


def assert_true(design: Design[Any], base: Any, columns: Columns) -> Outcomes:
    found = outcomes(design, base, columns)
    assert_alike(found, one_by_one(design, base, columns))
    return found


def seen(found: list[Outcomes]) -> set[int]:
    return {int(code) for each in found for code in each.codes}


def tubes(name: str, count: int) -> list[Columns]:
    """Return columns about a preset: its two dimensions of form, and then its points as well."""
    rng, base = np.random.default_rng(len(name)), TUBE.preset(name)
    beta = base.beta + rng.normal(0, 40, count)
    wide = {"beta": beta, "L": base.L + rng.uniform(-10, 20, count)}
    wide["phi"] = np.where(rng.random(count) < 0.2, 90.0, rng.uniform(-5, 185, count))
    points = {f"points.{i}.y": base.points[i].y + rng.uniform(-4, 4, count) for i in (1, 3, 6)}
    points |= {f"points.{i}.branch": rng.choice([-1.0, 1.0], count) for i in (1, 4)}
    size = {
        "n": rng.integers(2, 20, count).astype(float),
        "w": base.w * rng.uniform(0.8, 1.3, count),
    }
    return [wide, {**points, "beta": base.beta + rng.normal(0, 5, count)}, size]


@pytest.mark.parametrize("name", ["candlestick", "vase", "cup", "bud"])
def test_many_tubes_are_what_each_one_is(name: str) -> None:
    found = [assert_true(TUBE, TUBE.preset(name), columns) for columns in tubes(name, 30)]
    assert {Outcome.FREE, Outcome.NO_CANDIDATE, Outcome.CROSSES_AXIS, Outcome.REFUSED} <= seen(
        found
    )


def test_tubes_that_penetrate_on_one_side_of_the_axis_are_found() -> None:
    rng, base = np.random.default_rng(3), TUBE.preset("cup")
    signs = {f"points.{i}.branch": rng.choice([-1.0, 1.0], 20_000) for i in range(3, 10)}
    columns = {**signs, "beta": rng.uniform(0, 360, 20_000)}
    found = outcomes(TUBE, base, columns)
    some = np.flatnonzero(found.codes == Outcome.PENETRATES)[:40]
    assert len(some) == 40
    true = one_by_one(TUBE, base, {name: column[some] for name, column in columns.items()})
    assert (true.codes == Outcome.PENETRATES).all()


def bowls(name: str, count: int) -> list[Columns]:
    rng, base = np.random.default_rng(len(name)), BOWL.preset(name)
    special = rng.choice([0.0, 90.0, 180.0], count)
    phi = np.where(rng.random(count) < 0.3, special, rng.uniform(0, 180, count))
    phi[:2] = -1.0, 181.0
    places = {f"points.{i}.a": base.points[i].a + rng.uniform(-15, 15, count) for i in (1, 3, 4)}
    signs = {f"points.{i}.branch": rng.choice([-1.0, 1.0], count) for i in base.points}
    return [{"phi": phi}, {**places, "phi": phi}, {**signs, "n": rng.integers(2, 20, count) + 0.0}]


@pytest.mark.parametrize("name", BOWL.presets)
def test_many_bowls_are_what_each_one_is(name: str) -> None:
    found = [assert_true(BOWL, BOWL.preset(name), columns) for columns in bowls(name, 25)]
    assert {Outcome.FREE, Outcome.PENETRATES, Outcome.CROSSES_AXIS, Outcome.REFUSED} <= seen(found)


def test_only_the_radius_of_the_first_point_shapes_a_tube() -> None:
    rng = np.random.default_rng(1)
    r = np.repeat(rng.uniform(1, 30, 40), 3)
    lean = np.repeat(rng.uniform(20, 80, 40), 3)
    phi = np.where(np.arange(120) % 3 == 0, lean, np.where(np.arange(120) % 3 == 1, 180 - lean, 90))
    beta = np.repeat(rng.uniform(250, 330, 40), 3)
    columns = {"L": r / np.sin(np.radians(phi)), "phi": phi, "beta": beta}
    found = outcomes(TUBE, CANDLESTICK, columns)
    assert len(set(found.codes.tolist())) >= 3
    for k in (1, 2):
        assert np.array_equal(found.codes[::3], found.codes[k::3])
        height = found.figures["height_mm"]
        assert np.array_equal(height[::3], height[k::3], equal_nan=True)
    task = batch.prepare(Rows(CANDLESTICK, columns))
    assert task is not None
    assert task.shape is not None
    assert len(alike(task.shape)[0]) == 40


def test_the_mirror_image_of_a_tube_meets_the_same_end() -> None:
    rng = np.random.default_rng(2)
    columns = {"L": rng.uniform(0, 45, 3000), "beta": rng.uniform(0, 360, 3000)}
    flipped = {f"points.{i}.branch": -float(p.branch) for i, p in CANDLESTICK.points.items()}
    image = with_values(TUBE, CANDLESTICK, {**flipped, "phi": 180 - CANDLESTICK.phi})
    found = outcomes(TUBE, CANDLESTICK, columns)
    assert len(set(found.codes.tolist())) >= 3
    assert_alike(found, outcomes(TUBE, image, {**columns, "beta": 180 - columns["beta"]}))


def test_at_the_longest_first_radius_the_bound_is_that_of_generate() -> None:
    longest = solve.longest(CANDLESTICK)
    near = [np.nextafter(longest, 0), longest, np.nextafter(longest, 99), longest * (1 + 1e-8)]
    found = assert_true(TUBE, CANDLESTICK, {"L": np.array(near)})
    assert (found.codes[-1], found.at[-1]) == (Outcome.NO_CANDIDATE, 2)
    assert found.at[1] != 2


def test_tubes_with_tabs_are_judged_with_their_tabs() -> None:
    base = with_values(TUBE, CANDLESTICK, {"tab": 3.0})
    found = assert_true(TUBE, base, {"w": np.array([10.0, 9.5])})
    assert found.figures["sheet_x_mm"][0] > 2 * 10 * 10.0
    assert_true(TUBE, CANDLESTICK, {"tab": np.array([0.0, 3.0, -1.0, 50.0])})


def test_slivers_are_left_to_generate() -> None:
    assert_true(TUBE, CANDLESTICK, {"points.3.y": np.array([1e-6, 3e-6, 1e-4, 1e-2])})
    assert_true(BOWL, BOWL.preset("bowl-n8"), {"points.3.a": 40 + np.array([-1e-9, 1e-9, 1e-4])})


def test_a_bowl_whose_points_turn_freely_needs_their_direction() -> None:
    upright = 110 / np.cos(np.pi / 8)
    places = {1: (110.0, None), 2: (upright, None), 3: (172.48, None), 4: (200.0, None)}
    points = {i: LinePoint(a=a, gamma=gamma) for i, (a, gamma) in places.items()}
    base = RotationalParams(n=8, points=points)
    found = assert_true(BOWL, base, {"phi": np.array([60.0, 89.0, 90.0])})
    assert found.codes[2] == Outcome.REFUSED
    columns = {"phi": np.full(2, 90.0), "points.3.gamma": np.array([-108.2, 0.0])}
    assert (assert_true(BOWL, base, columns).codes != Outcome.REFUSED).all()


@pytest.mark.parametrize(("design", "name"), [(TUBE, "points.10.y"), (BOWL, "theta")])
def test_a_column_of_no_parameter_is_refused(design: Design[Any], name: str) -> None:
    assert design.batch is not None
    with pytest.raises(InvalidParameters, match="There is no parameter"):
        design.batch(design.params(), {name: np.zeros(3)})


@pytest.mark.parametrize("design", [TUBE, BOWL])
def test_a_batch_travels_to_other_processes(design: Design[Any]) -> None:
    columns = {"phi": np.array([30.0, 60.0, 200.0])}
    carried = pickle.loads(pickle.dumps(design.batch))
    assert_alike(carried(design.params(), columns), outcomes(design, design.params(), columns))


def test_no_rows_are_no_outcomes() -> None:
    columns: Mapping[str, Any] = {"phi": np.zeros(0)}
    assert len(outcomes(TUBE, CANDLESTICK, columns)) == 0
    assert len(outcomes(BOWL, BOWL.params(), columns)) == 0
