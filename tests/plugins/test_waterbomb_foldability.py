"""Waterbomb tessellations whose every vertex folds flat by itself."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from foldmill import Assignment
from foldmill.check.developability import angle_sums
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.build import E_TOTAL, Build
from foldmill_plugins.waterbomb.crimp import foldability, folds_flat
from foldmill_plugins.waterbomb.kawasaki import FlatFoldable, angles
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.presets import PRESETS


def on(kind: str, n_u: int, n_v: int, **values: Any) -> WaterbombParams:
    return DESIGN.validate({"surface": {"kind": kind}, "n_u": n_u, "n_v": n_v, **values})


def stacks(sectors: list[float], is_mountain: list[bool]) -> bool:
    """Tell whether some order of the layers folds a vertex flat: all orders are tried."""
    count = len(sectors)
    places = np.concatenate([[0.0], np.cumsum(np.array(sectors) * (-1) ** np.arange(count))])
    if abs(places[-1]) > 1e-9:
        return False
    spans = [sorted((places[n], places[n + 1])) for n in range(count)]
    return any(
        _turns_rightly(order, is_mountain) and not _cuts(order, places, spans)
        for order in itertools.permutations(range(count))
    )


def _turns_rightly(order: tuple[int, ...], is_mountain: list[bool]) -> bool:
    """Crease n joins layers n − 1 and n; every other layer lies face down."""
    for n, mountain in enumerate(is_mountain):
        goes_up = mountain == (n % 2 == 0)
        if (order[n] > order[n - 1]) != goes_up:
            return False
    return True


def _cuts(order: tuple[int, ...], places: np.ndarray, spans: list[list[float]]) -> bool:
    count = len(spans)
    for n in range(count):
        low, high = sorted((order[n - 1], order[n]))
        for other in range(count):
            inside = spans[other][0] + 1e-9 < places[n] < spans[other][1] - 1e-9
            if inside and low < order[other] < high:
                return True
        for other in range(n % 2, n, 2):  # creases that open to the same side
            if abs(places[n] - places[other]) < 1e-9:
                below, above = sorted((order[other - 1], order[other]))
                if low < below < high < above or below < low < above < high:
                    return True
    return False


def vertices(count: int, creases: int, seed: int) -> list[tuple[list[float], list[bool]]]:
    """Vertices that keep Kawasaki's rule, some angles alike, with mountains and valleys."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        half = [rng.integers(1, 6, creases // 2).astype(float) for _ in range(2)]
        if rng.random() < 0.5:
            half = [each + rng.random(creases // 2) for each in half]
        both = np.zeros(creases)
        both[::2], both[1::2] = (np.pi * each / each.sum() for each in half)
        found.append((both.tolist(), (rng.random(creases) < 0.5).tolist()))
    return found


@pytest.mark.parametrize("creases", [4, 6])
def test_crimps_find_what_trying_all_orders_of_layers_finds(creases: int) -> None:
    cases = vertices(250, creases, seed=creases)
    slow = [stacks(*case) for case in cases]
    assert [folds_flat(np.array(a), np.array(b)) for a, b in cases] == slow
    assert 10 < sum(slow) < 240


def test_a_vertex_that_misses_the_rule_does_not_fold_flat() -> None:
    kinds = np.array([True, True, False, True])
    assert folds_flat(np.array([2.0, 1.0, np.pi - 2, np.pi - 1])[[1, 0, 3, 2]], kinds) == stacks(
        [1.0, 2.0, np.pi - 1, np.pi - 2], kinds.tolist()
    )
    assert not folds_flat(np.array([1.0, 2.0, np.pi - 1 + 1e-3, np.pi - 2 - 1e-3]), kinds)
    assert not folds_flat(np.full(6, np.pi / 3), np.ones(6, bool))


def test_angles_round_a_vertex_add_up_to_its_angle_sum() -> None:
    build = Build(on("moebius", 8, 3))
    centre, around = build.topology.stars
    sums = angle_sums(build.base, build.topology.faces)[centre]
    assert angles(build.base, centre, around).sum(axis=1) == pytest.approx(sums, abs=1e-12)


@pytest.mark.parametrize("boundary", ["free", "fixed"])
def test_the_slopes_of_alternating_sums_are_theirs(boundary: str) -> None:
    build = Build(on("hyperbolic-paraboloid", 4, 3, boundary=boundary))
    conditions, points = FlatFoldable(build.stars), build.base
    residual, jacobian = conditions.linearised(points)
    assert residual == pytest.approx(conditions.residual(points), abs=1e-14)
    assert jacobian.shape[0] == 2 * len(build.stars.centre)
    step = 1e-6 * np.random.default_rng(2).normal(size=jacobian.shape[1])
    ahead, behind = (conditions.residual(conditions.moved(points, way * step)) for way in (1, -1))
    assert np.abs((ahead - behind) / 2 - jacobian @ step).max() < 1e-8 * np.abs(step).max()


@pytest.mark.parametrize("name", ["hyperbolic-paraboloid", "moebius"])
def test_a_search_for_a_flat_foldable_form_ends_in_one(name: str) -> None:
    plain = PRESETS[name]
    before = DESIGN.report("foldability", plain)
    assert before["folds_flat_share"] < 0.1
    params = plain.model_copy(update={"flat_foldable": True})
    fold = DESIGN.run(params)
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.meta["convergence"]["iterations"] <= 10
    assert fold.meta["convergence"]["alpha_min_deg"][-1] == pytest.approx(360, abs=1e-9)
    after = DESIGN.report("foldability", params)
    assert after["kawasaki_deg"] <= E_TOTAL
    assert after["kawasaki_share"] == after["folds_flat_share"] == 1
    assert after["not_flat"] == []


def test_every_other_angle_of_the_flat_sheet_adds_up_to_a_straight_one() -> None:
    fold = DESIGN.run(on("hyperbolic-paraboloid", 6, 6, flat_foldable=True))
    pattern = fold.pattern
    inner = set(range(len(pattern.vertices))) - set(
        pattern.edges[pattern.assignments == Assignment.B].ravel().tolist()
    )
    for vertex in inner:
        ends = pattern.edges[(pattern.edges == vertex).any(axis=1)].sum(axis=1) - vertex
        x, y = (pattern.vertices[ends] - pattern.vertices[vertex]).T
        turns = np.sort(np.arctan2(y, x))
        gaps = np.diff([*turns, turns[0] + 2 * np.pi])
        assert gaps[::2].sum() == pytest.approx(np.pi, abs=1e-7)


@pytest.mark.parametrize("name", ["catenoid-8x6", "cylinder", "vase"])
def test_round_an_axis_every_vertex_folds_flat_without_being_asked(name: str) -> None:
    told = DESIGN.report("foldability", PRESETS[name])
    assert told["kawasaki_deg"] < 1e-9
    assert told["folds_flat_share"] == 1
    asked = PRESETS[name].model_copy(update={"flat_foldable": True})
    assert np.array_equal(Build(asked).developed.points, Build(PRESETS[name]).developed.points)


def test_a_fit_keeps_a_form_flat_foldable() -> None:
    params = on("moebius", 22, 3, flat_foldable=True, fit={"on": True, "iterations": 8})
    build = Build(params)
    told = foldability(build, build.developed.points)
    assert build.fit is not None
    assert build.fit.objectives[-1] < build.fit.objectives[0]
    assert told["kawasaki_deg"] <= E_TOTAL
    assert told["folds_flat_share"] > 0.9
