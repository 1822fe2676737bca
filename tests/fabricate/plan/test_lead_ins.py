"""Lead-ins lie in the waste, one before each set-up, and holes are round enough for their pins."""

from __future__ import annotations

import math
from itertools import combinations, pairwise

import pytest
import shapely
import stools
from fabricate.verify import knife_job

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.formats import hpgl, svg
from foldmill_fabricate.jobsheet import words
from foldmill_fabricate.passes import Plan, Role
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify

OFFSETS = (0.25, 0.9)


def stool_plan(offset: float) -> Plan:
    return make(stools.stool(), stools.material(), knife_job.knife(offset))


def lead_ins(plan: Plan) -> list[tuple[tuple[float, float], ...]]:
    return [setup.lead_in for side in plan.passes for setup in side.setups]


@pytest.mark.parametrize("offset", OFFSETS)
def test_each_set_up_begins_in_the_waste_clear_of_everything(offset: float) -> None:
    plan, fold = stool_plan(offset), stools.stool()
    ways = [shapely.LineString(way) for way in lead_ins(plan)]
    assert len(ways) == 4
    turn = shapely.affinity.rotate
    part = turn(
        shapely.Polygon(fold.pattern.vertices[fold.pattern.outline()[0]]),
        plan.placement.angle,
        origin=(0, 0),
    )
    part = shapely.affinity.translate(part, plan.placement.dx, plan.placement.dy)
    room = plan.material.part_clearance + offset
    inner = shapely.box(0, 0, plan.sheet.width, plan.sheet.height).buffer(-room)
    marks = [shapely.Point(h.x, h.y).buffer(h.diameter / 2) for h in plan.holes]
    marks += [
        shapely.LineString(stroke.points)
        for setup in plan.passes[0].setups
        for operation in setup.operations
        if operation.role is Role.WITNESS
        for stroke in operation.strokes
    ]
    for way in ways:
        assert inner.covers(way)
        assert way.distance(part) >= room
        assert all(way.distance(mark) >= room for mark in marks)
    assert all(one.distance(two) > 2 * offset for one, two in combinations(ways, 2))


@pytest.mark.parametrize("offset", OFFSETS)
def test_its_two_legs_are_eight_offsets_long_and_square_to_each_other(offset: float) -> None:
    for a, b, c in lead_ins(stool_plan(offset)):
        assert math.dist(a, b) == pytest.approx(8 * offset) == math.dist(b, c)
        assert math.dist(a, c) == pytest.approx(8 * offset * math.sqrt(2))


def test_a_machine_that_makes_up_for_its_blade_gets_no_lead_in() -> None:
    assert lead_ins(stools.stool_plan()) == [()] * 4


def test_a_pen_has_no_offset_whatever_its_machine_knows_of_blades() -> None:
    plan = make(stools.stool(), stools.material(), knife_job.knife(0.9, trails=False))
    assert lead_ins(plan) == [()] * 4
    assert verify(plan, stools.stool().pattern, hpgl.write(plan, stools.stool())).ok


def test_a_sheet_without_room_for_it_is_refused_in_a_sentence() -> None:
    with pytest.raises(CannotPlan, match=r"no place in the waste for the lead-in of set-up 1"):
        make(knife_job.fold(), stools.material(), knife_job.knife(), blank=(122.0, 122.0))


@pytest.mark.parametrize("offset", OFFSETS)
def test_a_pin_fits_into_a_hole_and_the_blade_settles_on_its_facets(offset: float) -> None:
    plan = stool_plan(offset)
    (holes,) = plan.passes[0].setups[0].operations
    for hole in plan.holes:
        rim = next(s for s in holes.strokes if math.dist(s.points[0], (hole.x, hole.y)) < 4)
        polygon = shapely.Polygon(rim.points)
        pin = shapely.Point(hole.x, hole.y).buffer(hole.diameter / 2 - 0.03, quad_segs=64)
        assert polygon.covers(pin)
        shortest = min(math.dist(a, b) for a, b in pairwise(rim.points))
        assert shortest >= min(2 * offset, 0.5)
        if offset > 0.8:  # 2.5 mm are less than three offsets: facets outside the circle
            assert polygon.exterior.distance(shapely.Point(hole.x, hole.y)) >= 2.5 - 1e-9
            assert len(rim.points) == 10


def test_drawings_for_other_peoples_software_keep_the_tips_lines() -> None:
    ours, theirs = stool_plan(0.25), stools.stool_plan()
    assert svg.write(ours, stools.stool()) == svg.write(theirs, stools.stool())
    assert hpgl.write(ours, stools.stool()) != hpgl.write(theirs, stools.stool())


def test_the_job_sheet_says_that_the_programs_lead_the_holder() -> None:
    said = " ".join(words.warnings(stool_plan(0.9), stools.stool().pattern))
    assert "lead the knife's holder, not its tip" in said
    assert "trails 0.9 mm behind" in said
    other = " ".join(words.warnings(stools.stool_plan(), stools.stool().pattern))
    assert "holder" not in other
