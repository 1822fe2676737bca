"""Where no edge is long enough ties lie on short ones: in their middle, and one is told so."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import shapely
from stools import machine, material, through_cut

from foldmill import CreasePattern, Fold
from foldmill.finding import Severity
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Plan, Tie
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify

SEEDS = range(8)


def part(rim: np.ndarray, creased: bool = False) -> Fold:
    """Return a part with this rim; if wished a valley across it from its first vertex."""
    count = len(rim)
    edges = [(k, (k + 1) % count) for k in range(count)]
    letters = ["B"] * count
    if creased:
        edges, letters = [*edges, (0, count // 2)], [*letters, "V"]
    return Fold(CreasePattern.from_lines(rim.tolist(), edges, letters))


@cache
def stepped(seed: int) -> Fold:
    """Return a part with steps of 2.2 to 9 mm all round, alternately out and in."""
    random = np.random.default_rng(seed)
    lengths = random.uniform(2.2, 9.0, 90)
    turns = np.concatenate([[0.0], np.cumsum(lengths)[:-1]]) / lengths.sum() * 2 * np.pi
    radii = 75.0 + np.where(np.arange(90) % 2, random.uniform(1.0, 4.0, 90), 0.0)
    return part(np.column_stack([radii * np.cos(turns), radii * np.sin(turns)]), creased=True)


def disc(facets: int, radius: float) -> Fold:
    turns = np.linspace(0, 2 * np.pi, facets, endpoint=False)
    return part(radius * np.column_stack([np.cos(turns), np.sin(turns)]), creased=True)


@cache
def half_stepped() -> Fold:
    """Return a part of 160 × 120 mm whose upper side alone is stepped."""
    top = [(160.0 - 4 * k, 120.0 + 3 * (k % 2)) for k in range(41)]
    return part(np.array([(0.0, 0.0), (160.0, 0.0), *top]))


def planned(fold: Fold) -> Plan:
    return make(fold, material(), machine())


def errors(plan: Plan, fold: Fold) -> set[str]:
    found = verify(plan, fold.pattern, hpgl.write(plan, fold)).findings
    return {finding.code for finding in found if finding.severity is Severity.ERROR}


def rim_of(plan: Plan, fold: Fold) -> shapely.LinearRing:
    angle = np.radians(plan.placement.angle)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    spots = fold.pattern.vertices @ turn + (plan.placement.dx, plan.placement.dy)
    return shapely.LinearRing(spots[fold.pattern.outline()[0]])


@pytest.mark.parametrize("seed", SEEDS)
def test_a_stepped_part_hangs_on_ties_in_the_middle_of_its_steps(seed: int) -> None:
    fold = stepped(seed)
    plan = planned(fold)
    cut, rim = through_cut(plan.material), np.array(rim_of(plan, fold).coords)
    middles, lengths = (rim[1:] + rim[:-1]) / 2, np.hypot(*np.diff(rim, axis=0).T)
    assert len(plan.ties) >= max(3, int(lengths.sum() / cut.tie_pitch))
    for tie in plan.ties:
        apart = np.hypot(*(middles - (tie.x, tie.y)).T)
        assert apart.min() < 1e-6
        assert lengths[np.argmin(apart)] >= 3 * tie.width
    assert [f.code for f in plan.findings if f.code.startswith("ties")] == ["ties-near-corners"]
    assert not errors(plan, fold)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_tie_shifted_along_its_step_is_found(seed: int) -> None:
    fold = stepped(seed)
    plan = planned(fold)
    rim, first = rim_of(plan, fold), plan.ties[0]
    place = rim.project(shapely.Point(first.x, first.y))
    near = rim.interpolate(place + 0.3)
    moved = Tie(x=near.x, y=near.y, width=first.width)
    wrong = plan.model_copy(update={"ties": (moved, *plan.ties[1:])})
    assert "tie-corner" in errors(wrong, fold)


def test_a_short_step_takes_no_tie_where_a_long_edge_is_near() -> None:
    fold = half_stepped()
    plan = planned(fold)
    left, _, right, high = rim_of(plan, fold).bounds
    quarter = through_cut(plan.material).tie_pitch / 4
    upper = [tie.x for tie in plan.ties if tie.y > high - 3.5]
    assert len(plan.ties) > len(upper) >= 1
    assert left + quarter / 2 < min(upper) <= max(upper) < right - quarter / 2
    assert not errors(plan, fold)


def test_a_tie_of_a_step_beside_a_long_edge_is_found() -> None:
    fold = half_stepped()
    plan = planned(fold)
    _, _, right, high = rim_of(plan, fold).bounds
    at = next(k for k, tie in enumerate(plan.ties) if tie.y > high - 3.5)
    beside = Tie(x=right - 2, y=high - 1.5, width=plan.ties[at].width)
    ties = (*plan.ties[:at], beside, *plan.ties[at + 1 :])
    assert "tie-corner" in errors(plan.model_copy(update={"ties": ties}), fold)


@pytest.mark.parametrize("facets", [60, 240, 900])
def test_a_round_part_hangs_on_ties_across_its_gentle_bends(facets: int) -> None:
    fold = disc(facets, 80.0)
    plan = planned(fold)
    cut = through_cut(plan.material)
    assert len(plan.ties) >= int(2 * np.pi * 80 / cut.tie_pitch)
    codes = {f.code for f in plan.findings}
    assert ("ties-across-bends" in codes) == (facets > 60 and 900 / facets < 4)
    assert not errors(plan, fold)


def test_a_rim_of_steps_no_longer_than_a_tie_is_refused_with_what_is_needed() -> None:
    turns = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    radii = 80.0 + np.where(np.arange(400) % 2, 0.9, 0.0)
    fold = part(np.column_stack([radii * np.cos(turns), radii * np.sin(turns)]))
    with pytest.raises(CannotPlan, match=r"room for 0 ties.*in the middle of edges of 1.8 mm"):
        planned(fold)
