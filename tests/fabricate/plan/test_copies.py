"""Several copies of a part on one blank: where they lie, and in which order they are made."""

from __future__ import annotations

from itertools import groupby

import numpy as np
import pytest
import shapely
import stools
from fabricate.plan.test_make import square

from foldmill import CreasePattern, Fold
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.passes import Plan, Role, Stroke
from foldmill_fabricate.plan import make
from foldmill_fabricate.plan.lines import visited
from foldmill_fabricate.sheet import flipped, placed


def kite(long: float, wide: float) -> Fold:
    """A kite with a mountain, two valleys and a mountain from its middle: nowhere symmetric."""
    points = [(0, 0), (0.7 * long, -0.4 * wide), (long, 0.1 * wide), (0.6 * long, 0.6 * wide)]
    spots = [*points, (0.55 * long, 0.1 * wide)]
    lines = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]
    return Fold(CreasePattern.from_lines(spots, lines, "BBBBMVMV"))


def planned(fold: Fold, **options: object) -> Plan:
    return make(fold, stools.material(), stools.machine(), **options)  # type: ignore[arg-type]


def parts(plan: Plan, fold: Fold) -> list[shapely.Polygon]:
    rim = fold.pattern.vertices[fold.pattern.outline()[0]]
    return [shapely.Polygon(placed(rim, place)) for place in plan.placements]


def strokes(plan: Plan, role: Role) -> list[Stroke]:
    return [
        stroke
        for work in plan.passes
        for setup in work.setups
        for operation in setup.operations
        if operation.role is role
        for stroke in operation.strokes
    ]


@pytest.mark.parametrize("seed", range(8))
def test_random_copies_keep_their_distances_and_holes_stay_in_the_waste(seed: int) -> None:
    rng = np.random.default_rng(seed)
    long, wide = rng.uniform(60, 140, 2).tolist()
    fold, count = kite(long, wide), int(rng.integers(2, 8))
    blank = (float(rng.uniform(420, 570)), float(rng.uniform(420, 570)))
    flip = ("left-right", "end-over-end")[seed % 2]
    plan = planned(fold, copies=count, blank=blank, flip=flip, carrier=(600, 600))
    assert plan.quantity == len(plan.placements) == count
    own, clear = parts(plan, fold), plan.material.part_clearance
    assert len({place.angle for place in plan.placements}) == 1
    for k, part in enumerate(own):
        assert min((part.distance(other) for other in own[:k]), default=clear) >= clear - 1e-6
        x0, y0, x1, y1 = part.bounds
        assert min(x0, y0, blank[0] - x1, blank[1] - y1) >= clear - 1e-6
    holes = [(hole.x, hole.y) for hole in plan.holes]
    assert len(holes) == 4
    everything = shapely.union_all(own)
    for x, y in [*holes, *flipped(holes, plan.flip).tolist()]:
        away = everything.distance(shapely.Point(x, y)) - plan.holes[0].diameter / 2
        assert away >= plan.material.holes.part_clearance - 1e-6
    for stroke in strokes(plan, Role.WITNESS):
        assert everything.distance(shapely.LineString(stroke.points)) > 0


def test_each_copy_has_the_strokes_of_a_single_part() -> None:
    fold = square("MVMV", 90)
    one, four = planned(fold), planned(fold, grid=(2, 2))
    for role in (Role.SCORE, Role.CUT_OUTER):
        alone = sorted(lengths(strokes(one, role)))
        for piece in range(1, 5):
            own = [stroke for stroke in strokes(four, role) if stroke.piece == piece]
            assert sorted(lengths(own)) == pytest.approx(alone)
    assert len(four.ties) == 4 * len(one.ties)
    score, cut = one.material.score.repeats, one.material.cut.repeats
    part = score * sum(lengths(strokes(one, Role.SCORE)))
    part += cut * sum(lengths(strokes(one, Role.CUT_OUTER)))
    assert four.figures.drawn - one.figures.drawn == pytest.approx(3 * part)


def lengths(of: list[Stroke]) -> list[float]:
    return [float(np.hypot(*np.diff(stroke.points, axis=0).T).sum()) for stroke in of]


def test_a_copy_is_finished_before_the_next_is_begun() -> None:
    plan = planned(square("MVMV", 90), copies=6, relief="all")
    for work in plan.passes:
        for setup in work.setups:
            for operation in setup.operations:
                runs = [piece for piece, _ in groupby(s.piece for s in operation.strokes)]
                if operation.role in {Role.HOLE, Role.WITNESS}:
                    assert runs == [0]
                else:
                    assert sorted(runs) == [1, 2, 3, 4, 5, 6]
    assert len(plan.reliefs) == 6


def test_copies_are_visited_to_and_fro_from_the_nearest_corner() -> None:
    middles = np.array([(x, y) for y in (0, 10, 20) for x in (0, 10)], float)
    assert visited(middles, np.array([-5.0, -5.0])) == [0, 1, 3, 2, 4, 5]
    assert visited(middles, np.array([12.0, 25.0]))[0] == 5
    rng = np.random.default_rng(5)
    for start in rng.uniform(-20, 40, (20, 2)):
        assert sorted(visited(middles, start)) == list(range(6))


def test_the_grid_that_is_asked_for_is_laid_in_rows_from_the_lower_left() -> None:
    spots = [(p.dx, p.dy) for p in planned(square("MVMV", 90), grid=(3, 2)).placements]
    assert len({x for x, _ in spots}) == 3
    assert len({y for _, y in spots}) == 2
    assert spots == sorted(spots, key=lambda spot: (spot[1], spot[0]))


def test_a_long_roll_takes_copies_in_one_column() -> None:
    plan = planned(square("MVMV", 200), copies=3, blank=(240, 700), carrier=(600, 800))
    assert len({place.dx for place in plan.placements}) == 1


def test_a_plan_of_one_part_says_nothing_of_copies() -> None:
    plan = planned(square("MVMV"))
    said = plan.model_dump_json()
    assert "copies" not in said
    assert "quantity" not in said
    assert '"piece"' not in said
    assert Plan.model_validate_json(said) == plan
    several = planned(square("MVMV"), copies=2)
    assert Plan.model_validate_json(several.model_dump_json()) == several


def test_grids_and_copies_that_contradict_each_other_are_refused() -> None:
    with pytest.raises(CannotPlan, match="holds 6 copies, and 4 are wanted"):
        planned(square("MVMV"), copies=4, grid=(3, 2))
    with pytest.raises(CannotPlan, match="one copy at least"):
        planned(square("MVMV"), copies=0)


@pytest.mark.parametrize("count", [9, 30])
def test_too_many_copies_are_refused_with_how_many_would_fit(count: int) -> None:
    fold = square("MVMV", 120)
    with pytest.raises(DoesNotFit, match=r"mm are missing; 9 would fit\.") as caught:
        planned(fold, copies=count + 1, blank=(370, 370))
    assert "The smallest blank that works for" in str(caught.value)
    assert planned(fold, copies=9, blank=(370, 370)).quantity == 9
