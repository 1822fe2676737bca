"""What is found in HP-GL is found in GP-GL and G-code: every way of spoiling a job, told anew."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from fabricate.verify import knife_job, square_job
from fabricate.verify.corrupt_programs import PROGRAMS
from fabricate.verify.knife_job import KNIFE_JOBS
from fabricate.verify.square_job import ONE_TOOL, PENS, Job
from fabricate.verify.test_corruptions import errors, sentence, verified
from fabricate.verify.tongues import SUFFIXES, TONGUES, machine, renamed, told

from foldmill_fabricate.verify.languages import replay
from foldmill_fabricate.writers import writer

JOBS = [("gp-gl", ONE_TOOL), ("gp-gl", PENS), ("z", ONE_TOOL), ("beam", PENS)]
CODES = {"z": {"wrong-force": "wrong-depth"}, "beam": {"wrong-force": "wrong-beam"}}
"""What a wrong force is in a tongue that has none."""


def code_in(tongue: str, code: str) -> str:
    return CODES.get(tongue, {}).get(code, code)


@pytest.mark.parametrize(("tongue", "slug"), JOBS)
def test_a_good_job_is_good_in_any_tongue(tongue: str, slug: str) -> None:
    result = verified(told(square_job.job(slug), tongue))
    assert not result.findings
    assert 0 < result.figures.deviation <= result.figures.tolerance == 0.025


@pytest.mark.parametrize(("tongue", "slug"), JOBS)
@pytest.mark.parametrize(("spoil", "code"), PROGRAMS.items(), ids=sentence)
def test_it_is_found_that(spoil: Callable[[Job], Job], code: str, tongue: str, slug: str) -> None:
    assert code_in(tongue, code) in errors(verified(told(spoil(square_job.job(slug)), tongue)))


@pytest.mark.parametrize("tongue", ["gp-gl", "z"])
@pytest.mark.parametrize("offset", [0.25, 0.9])
def test_a_drag_knifes_good_job_is_good(offset: float, tongue: str) -> None:
    assert not verified(told(knife_job.job(offset), tongue)).findings


@pytest.mark.long
@pytest.mark.parametrize("tongue", ["gp-gl", "z"])
@pytest.mark.parametrize(("spoil", "code"), KNIFE_JOBS.items(), ids=sentence)
def test_it_is_found_of_a_drag_knife_that(
    spoil: Callable[[Job], Job], code: str, tongue: str
) -> None:
    assert code in errors(verified(told(spoil(knife_job.job(0.25)), tongue)))


@pytest.mark.parametrize("tongue", TONGUES)
@pytest.mark.parametrize("kind", ["square", "knife"])
def test_writer_and_second_writer_make_a_machine_do_the_same(kind: str, tongue: str) -> None:
    good = square_job.job(PENS) if kind == "square" else knife_job.job(0.25)
    again = told(good, tongue)
    plan = again.plan
    offered = writer(plan.machine)
    assert offered is not None
    written = offered.write(plan, knife_job.fold())
    assert list(written) == [renamed(name, tongue) for name in good.programs]
    assert all(name.endswith(SUFFIXES[tongue]) for name in written)
    for name, data in written.items():
        ours, theirs = (replay(each, name, plan.machine) for each in (data, again.programs[name]))
        assert not ours.findings
        assert len(ours.runs) == len(theirs.runs) > 0
        for one, other in zip(ours.runs, theirs.runs, strict=True):
            assert np.array_equal(one.points, other.points)
            assert (one.tool or 0, one.speed, one.settings) == (
                other.tool or 0,
                other.speed,
                other.settings,
            )


def test_a_machines_profile_decides_what_its_programs_set() -> None:
    plan = told(square_job.job(ONE_TOOL), "z").plan
    deeper = plan.machine.model_copy(
        update={"gcode": plan.machine.gcode.model_copy(update={"clear": 8.0})}
    )
    (file, *_) = plan.programs
    job = told(square_job.job(ONE_TOOL), "z")
    higher = Job(plan.model_copy(update={"machine": deeper}), job.pattern, job.programs)
    assert "low-travel" in errors(verified(higher))
    assert file.name.endswith(".nc")
    assert machine(plan.machine, "beam").gcode.lowers == "beam"
