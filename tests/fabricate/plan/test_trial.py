"""A test cut lies in the waste, is as long as it should be, and is proved like every program."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import pytest
from fabricate.bench import small_job, small_plan

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Face, Plan, ProgramFile
from foldmill_fabricate.plan.trial import LENGTH, trial
from foldmill_fabricate.trials import trial_program
from foldmill_fabricate.verify.interpreter import interpret
from foldmill_fabricate.verify.trial import prove_trial

KNIFE = "generic-hpgl-drag-knife"


@pytest.mark.parametrize("slug", ["generic-hpgl-600", KNIFE])
def test_test_cuts_keep_clear_of_the_part_the_holes_and_each_other(
    slug: str, tmp_path: Path
) -> None:
    import shapely
    from shapely import affinity

    job = small_job(tmp_path, small_plan(slug))
    plan = job.plan
    place = plan.placement
    square = affinity.rotate(shapely.box(0, 0, 120, 120), place.angle, origin=(0, 0))
    laid = affinity.translate(square, place.dx, place.dy)
    ways = []
    for work in plan.passes:
        for setup in work.setups:
            for attempt in range(1 + (setup.number == 1)):
                made = trial(plan, job.pattern, work.face, setup, attempt)
                (stroke,) = made.passes[0].setups[0].operations[0].strokes
                ways.append(shapely.LineString(stroke.points))
                assert trial_program(job, work.face, setup, attempt)
    for k, way in enumerate(ways):
        assert way.length == pytest.approx(LENGTH)
        assert way.distance(laid) > plan.material.part_clearance
        assert all(way.distance(shapely.Point(h.x, h.y)) > h.diameter / 2 for h in plan.holes)
        assert all(way.distance(other) >= 3.0 for other in ways[:k])


def test_a_test_cut_on_the_part_is_refused(tmp_path: Path) -> None:
    job = small_job(tmp_path)
    setup = job.plan.passes[0].setups[0]
    made = trial(job.plan, job.pattern, Face.FRONT, setup)
    middle = (130.0, 120.0), (150.0, 120.0)
    own = made.passes[0].setups[0]
    operation = own.operations[0]
    stroke = replace(operation.strokes[0], points=middle)
    moved = operation.model_copy(update={"strokes": (stroke,)})
    work = made.passes[0].model_copy(
        update={"setups": (own.model_copy(update={"operations": (moved,)}),)}
    )
    bad = made.model_copy(update={"passes": (work,)})
    from foldmill_fabricate.formats import hpgl

    data = hpgl.program(bad, [1])
    bad = bad.model_copy(update={"programs": (_file("t.hpgl", data),)})
    findings = prove_trial(bad, job.plan, job.pattern, "t.hpgl", data, None)
    assert {finding.code for finding in findings} == {"test-cut-place"}


def test_a_test_cut_whose_program_was_changed_is_refused(tmp_path: Path) -> None:
    job = small_job(tmp_path)
    setup = job.plan.passes[0].setups[1]
    data = trial_program(job, Face.FRONT, setup)
    made = trial(job.plan, job.pattern, Face.FRONT, setup)
    assert len(interpret(data).runs) == 1
    name = "t.hpgl"
    recorded = made.model_copy(update={"programs": (_file(name, data, setup.number),)})
    assert not prove_trial(recorded, job.plan, job.pattern, name, data, None)
    x, y = interpret(data).runs[0].points[1]
    longer = data.replace(f"PD{x:.0f},{y:.0f}".encode(), f"PD{x + 80:.0f},{y:.0f}".encode())
    assert longer != data
    codes = {f.code for f in prove_trial(recorded, job.plan, job.pattern, name, longer, None)}
    assert "edited" in codes
    assert len(codes) > 1


def _file(name: str, data: bytes, setup: int = 1) -> ProgramFile:
    digest = hashlib.sha256(data).hexdigest()
    return ProgramFile(name=name, face=Face.FRONT, setups=(setup,), sha256=digest)


def test_a_sheet_without_waste_says_where_to_try_instead() -> None:
    plan = small_plan()
    tight: Plan = plan.model_copy(
        update={
            "sheet": plan.sheet.model_copy(update={"width": 125.0, "height": 125.0}),
            "placement": plan.placement.model_copy(update={"dx": 2.0, "dy": 2.0, "angle": 0.0}),
        }
    )
    from fabricate.verify import knife_job

    with pytest.raises(CannotPlan, match="no room in the waste for a test cut of 20 mm"):
        trial(tight, knife_job.fold().pattern, Face.FRONT, plan.passes[0].setups[0])
