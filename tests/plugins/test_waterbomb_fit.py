"""Waterbomb tessellations brought closer to their targets, without folding wrongly or clashing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill import Fold, InvalidParameters
from foldmill.check import check
from foldmill.folded import fold_angles
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.barrier import altitudes
from foldmill_plugins.waterbomb.build import E_TOTAL, Build
from foldmill_plugins.waterbomb.closeness import measures, mesh_distances, target_samples
from foldmill_plugins.waterbomb.contact import Clashes, Contacts
from foldmill_plugins.waterbomb.distance import Target
from foldmill_plugins.waterbomb.hinge import Creases
from foldmill_plugins.waterbomb.nearness import Nearness
from foldmill_plugins.waterbomb.objective import Objective
from foldmill_plugins.waterbomb.params import WaterbombParams
from foldmill_plugins.waterbomb.surfaces import TABLE
from foldmill_plugins.waterbomb.unknowns import Unknowns

GOALS = {
    "catenoid": 0.70 * 2.60e-2,
    "cylinder": 0.45 * 1.59e-2,
    "moebius": 0.40 * 1.40e-2,
}
"""d that a fit must reach: shares of the thesis' own. The benchmark has all seven."""
SMALL = {
    "catenoid": (8, 6),
    "torus": (36, 6),
    "vase": (12, 6),
    "hyperbolic-paraboloid": (5, 4),
    "moebius": (12, 3),
}
KINDS = pytest.mark.parametrize("kind", list(SMALL))


def small(kind: str, **values: Any) -> WaterbombParams:
    n_u, n_v = SMALL[kind]
    return DESIGN.validate({"surface": {"kind": kind}, "n_u": n_u, "n_v": n_v, **values})


def fitting(params: WaterbombParams, **values: Any) -> WaterbombParams:
    return DESIGN.validate({**params.model_dump(), "fit": {"on": True, **values}})


def objective_of(build: Build, unknowns: Unknowns) -> Objective:
    return Objective.of(
        build.surface, build.topology, build.side, unknowns, build.plain.points, build.params.fit
    )


def noisy(points: np.ndarray, size: float, seed: int = 1) -> np.ndarray:
    moved: np.ndarray = points + size * np.random.default_rng(seed).normal(size=points.shape)
    return moved


@KINDS
def test_folds_are_those_of_the_form_and_their_slopes_are_theirs(kind: str) -> None:
    build = Build(small(kind))
    creases, points = Creases.of(build.topology, build.side), build.plain.points
    faces = build.topology.faces
    edges = build.topology.edges[build.topology.assignments != 0]
    around = np.array(
        [[_face_with(faces, a, b), _face_with(faces, b, a)] for a, b in edges], np.intp
    )
    signed = -fold_angles(points, edges, faces, around)  # mountains are negative there
    assert np.degrees(creases.folds(points)) == pytest.approx(creases.signs * signed, abs=1e-9)
    step = noisy(0 * points, 1e-6)
    change = (creases.folds(points + step) - creases.folds(points - step)) / 2
    told = np.einsum("nkc,nkc->n", creases.slopes(points), step[creases.quads])
    assert np.abs(change - told).max() < 1e-11


def _face_with(faces: np.ndarray, a: int, b: int) -> int:
    """Return the face that has the side from a to b."""
    sides = (faces == a) & (np.roll(faces, -1, axis=1) == b)
    return int(np.flatnonzero(sides.any(axis=1))[0])


def test_altitudes_are_twice_the_area_over_the_longest_side() -> None:
    build = Build(small("vase"))
    points, faces = build.plain.points, build.topology.faces
    heights, slopes, corners = altitudes(points, faces)
    a, b, c = points[faces].transpose(1, 0, 2)
    longest = np.max([np.linalg.norm(x - y, axis=1) for x, y in ((a, b), (b, c), (c, a))], axis=0)
    assert heights == pytest.approx(np.linalg.norm(np.cross(b - a, c - a), axis=1) / longest)
    step = noisy(0 * points, 1e-7)
    change = (altitudes(points + step, faces)[0] - altitudes(points - step, faces)[0]) / 2
    assert np.abs(change - np.einsum("nkc,nkc->n", slopes, step[corners])).max() < 1e-12


@pytest.mark.parametrize("name", list(TABLE))
def test_the_arrow_from_its_foot_is_the_slope_of_half_the_squared_distance(name: str) -> None:
    target = Target.of(TABLE[name])
    rng = np.random.default_rng(5)
    feet = target.samples[rng.integers(len(target.samples), size=60)]
    points = feet + 0.1 * rng.normal(size=feet.shape)
    nearness = Nearness.of(target, points)
    assert np.linalg.norm(nearness.away, axis=1) == pytest.approx(target.distances(points))
    step = 1e-5 * rng.normal(size=points.shape)
    change = (target.distances(points + step) ** 2 - target.distances(points - step) ** 2) / 4
    told = np.einsum("ni,ni->n", nearness.away, step)
    assert np.median(np.abs(change - told)) < 1e-10
    left = np.einsum("nij,nj->ni", nearness.off, nearness.away) - nearness.away
    assert np.abs(left).max() < 1e-5  # a foot that can follow is square below its vertex


@KINDS
def test_the_objective_falls_as_its_derivatives_say(kind: str) -> None:
    build = Build(fitting(small(kind), altitude=0.6, lowest=60.0, highest=100.0))
    objective = objective_of(build, build.unknowns)
    size = build.unknowns.basis.shape[1]
    shift = 0.02 * objective.edge * np.random.default_rng(3).normal(size=size)
    conditions = build.unknowns.conditions
    points = conditions.moved(build.plain.points, shift)
    rows, slopes = objective.linearised(points)
    assert objective.value(points) == pytest.approx(float(rows @ rows))
    step = 1e-6 * np.random.default_rng(4).normal(size=size)
    ahead, behind = (objective.value(conditions.moved(points, way * step)) for way in (1, -1))
    assert (ahead - behind) / 2 == pytest.approx(2 * float(rows @ (slopes @ step)), rel=2e-3)


@pytest.mark.parametrize("kind", ["catenoid", "torus"])
def test_one_part_of_each_kind_stands_for_all_the_others(kind: str) -> None:
    build = Build(fitting(small(kind), altitude=0.6, lowest=60.0, highest=100.0))
    few = objective_of(build, build.unknowns)
    free = np.ones(len(build.topology.k), bool)
    all_ = objective_of(build, Unknowns.of(build.stars, free))
    assert len(few.creases.quads) < len(all_.creases.quads) / 4
    conditions = build.unknowns.conditions
    size = build.unknowns.basis.shape[1]
    points = conditions.moved(build.plain.points, 0.02 * np.random.default_rng(6).normal(size=size))
    assert few.value(points) == pytest.approx(all_.value(points), rel=1e-9)
    gradients = [each.linearised(points) for each in (few, all_)]
    reduced, whole = (slopes.T @ rows for rows, slopes in gradients)
    assert reduced == pytest.approx(build.unknowns.basis.T @ whole, abs=1e-9)


@pytest.mark.parametrize("name", list(GOALS))
def test_a_fit_comes_as_close_as_it_should_and_folds_as_a_waterbomb(name: str) -> None:
    plain = DESIGN.presets[name]
    fold = DESIGN.run(fitting(plain))
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.meta["status"]["e_total_deg"] <= E_TOTAL
    assert fold.meta["distance"]["mean"] <= GOALS[name]
    assert not check(fold).has_errors
    folds = np.abs(fold.pattern.fold_angles[fold.pattern.assignments != 0])
    assert folds.min() >= 15
    assert folds.max() <= 170
    _keeps_its_shape(fold, Build(plain))


def _keeps_its_shape(fold: Fold, before: Build) -> None:
    """No slivers, and the way back from the target is no longer than it was."""
    assert fold.folded is not None
    solid = fold.folded.vertices / fold.meta["mm_per_unit"]
    ends = solid[fold.pattern.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert lengths.max() <= 10 * lengths.min()
    places, areas = target_samples(Target.of(before.surface))
    was = before.developed.points[before.topology.faces]
    back, back_then = (
        np.average(mesh_distances(places, each), weights=areas)
        for each in (solid[fold.pattern.faces], was)
    )
    assert back <= 1.4 * back_then


def test_the_same_fit_gives_the_same_form_to_the_last_bit() -> None:
    for kind in ("catenoid", "moebius"):
        params = fitting(small(kind), iterations=6)
        assert np.array_equal(Build(params).developed.points, Build(params).developed.points)


@KINDS
def test_a_fit_brings_any_form_closer(kind: str) -> None:
    params = fitting(small(kind), iterations=12)
    told = DESIGN.report("fit", params)
    assert told["d_ratio"] < 0.95
    assert told["e_total_deg"] <= E_TOTAL
    values = told["objective"]
    assert values[-1] < values[0]
    assert told["iterations"] == len(values) - 1


def test_a_fixed_boundary_stays_and_no_steps_change_nothing() -> None:
    build = Build(fitting(small("moebius", boundary="fixed"), boundary="fixed", iterations=6))
    rim = ~build.topology.is_interior
    assert np.array_equal(build.developed.points[rim], build.plain.points[rim])
    assert not np.array_equal(build.developed.points, build.plain.points)
    off = Build(small("moebius"))
    assert off.fit is None
    assert off.developed is off.plain


def test_bounds_on_folds_are_kept() -> None:
    for low, high in ((10.0, 165.0), (40.0, 120.0)):
        told = DESIGN.report("fit", fitting(small("catenoid"), lowest=low, highest=high))
        least, greatest = told["folds_after_deg"]
        assert least >= low - 2
        assert greatest <= high + 2


def test_facets_that_meet_are_kept_apart_and_the_fit_goes_on() -> None:
    values = {"tangential": 0.05, "altitude": 0.25}
    build = Build(fitting(DESIGN.presets["moebius"], **values))
    assert build.fit is not None
    assert build.fit.refused > 0
    clashes = Clashes.of(build.topology, is_symmetric=False)
    assert len(clashes.pairs(build.developed.points)) == 0
    after = measures(build, build.developed.points)["vertices_mean"]
    assert after < 0.6 * measures(build, build.plain.points)["vertices_mean"]


@pytest.mark.parametrize("seed", range(5))
def test_a_plane_parts_triangles_that_do_not_penetrate(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(6, 3))
    points[3:, 2] += 2 - points[3:, 2].min() + points[:3, 2].max()
    faces = np.array([[0, 1, 2], [3, 4, 5]])
    apart = Contacts.of(points, faces, np.array([[0, 1]]))
    assert apart.heights(points).min() > 1
    assert np.linalg.norm(apart.arrows, axis=1) == pytest.approx(1)
    joined = np.vstack([points[:5], points[2]])
    joined = np.where(np.arange(6)[:, None] == 5, joined[2], joined)
    touching = Contacts.of(joined, np.array([[0, 1, 2], [3, 4, 2]]), np.array([[0, 1]]))
    assert len(touching.upper) == 2
    assert touching.heights(joined).min() >= 0


def test_a_step_against_the_plane_is_seen_before_triangles_cross() -> None:
    flat = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    points = np.vstack([flat, flat + np.array([0.1, 0.1, 0.3])])
    contacts = Contacts.of(points, np.arange(6).reshape(2, 3), np.array([[0, 1]]))
    pushed = points - np.repeat([[0.0, 0, 0], [0, 0, 0.5]], 3, axis=0)
    assert contacts.heights(points) == pytest.approx([0.3])
    assert contacts.heights(pushed) == pytest.approx([-0.2])


def test_bounds_that_leave_no_room_are_refused() -> None:
    with pytest.raises(InvalidParameters, match="folds need room of 30"):
        DESIGN.validate({"fit": {"lowest": 90.0, "highest": 100.0}})
