"""Every way of spoiling a job is found and named, on a small square and on the stool."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
import stools
from fabricate.verify import square_job
from fabricate.verify.corrupt_plans import PLANS, replanned
from fabricate.verify.corrupt_programs import PROGRAMS, read, with_part
from fabricate.verify.square_job import ONE_TOOL, PENS, Job

from foldmill.finding import Severity
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import Verification, verify

JOBS = [
    ("square", ONE_TOOL, "left-right"),
    ("square", PENS, "left-right"),
    ("square", ONE_TOOL, "end-over-end"),
    ("stool", ONE_TOOL, "left-right"),
    ("stool", PENS, "end-over-end"),
]


@cache
def job(what: str, machine: str, flip: str) -> Job:
    if what == "square":
        return square_job.job(machine, flip)
    fold = stools.stool()
    plan = make(fold, stools.material(), stools.machine(machine), flip=flip)  # type: ignore[arg-type]
    return square_job.recorded(Job(plan, fold.pattern, hpgl.write(plan, fold)))


def verified(found: Job) -> Verification:
    return verify(found.plan, found.pattern, found.programs)


def errors(result: Verification) -> set[str]:
    return {finding.code for finding in result.findings if finding.severity is Severity.ERROR}


def sentence(value: object) -> str:
    return str(getattr(value, "__name__", value)).replace("_", " ")


@pytest.mark.parametrize("which", JOBS, ids="-".join)
def test_a_good_job_passes_without_a_finding(which: tuple[str, str, str]) -> None:
    result = verified(job(*which))
    assert not result.findings
    assert result.ok
    assert 0 < result.figures.deviation <= result.figures.tolerance == 0.025


@pytest.mark.parametrize("which", JOBS, ids="-".join)
def test_a_second_writer_draws_the_same(which: tuple[str, str, str]) -> None:
    good = job(*which)
    again = square_job.recorded(Job(good.plan, good.pattern, square_job.emit(good.plan)))
    assert verified(again).ok


@pytest.mark.parametrize("which", JOBS, ids="-".join)
@pytest.mark.parametrize(("spoil", "code"), PROGRAMS.items(), ids=sentence)
def test_it_is_found_in_the_programs_that(
    spoil: Callable[[Job], Job], code: str, which: tuple[str, str, str]
) -> None:
    result = verified(spoil(job(*which)))
    assert code in errors(result)
    assert not result.ok


@pytest.mark.parametrize("which", JOBS, ids="-".join)
@pytest.mark.parametrize(("spoil", "code"), PLANS.items(), ids=sentence)
def test_it_is_found_in_the_plan_that(
    spoil: Callable[[Plan], Plan], code: str, which: tuple[str, str, str]
) -> None:
    result = verified(replanned(job(*which), spoil))
    assert code in errors(result)


@pytest.mark.parametrize("seed", range(12))
def test_any_stroke_that_is_lost_or_shifted_is_found(seed: int) -> None:
    """Two steps are twice what is allowed; one stroke in a hundred and fifty."""
    good = job("stool", ONE_TOOL, "left-right")
    rng = np.random.default_rng(seed)
    name = str(rng.choice(sorted(good.programs)))
    strokes = [k for k, part in enumerate(read(good.programs[name])) if not isinstance(part, str)]
    part = int(rng.choice(strokes))
    stroke = read(good.programs[name])[part]
    assert not isinstance(stroke, str)
    dx, dy = ((2, 0), (0, 2), (-2, 0), (0, -2))[seed % 4]
    shifted = [(x + dx, y + dy) for x, y in stroke]
    assert errors(verified(with_part(good, name, part))) == {"missing-stroke"}
    assert errors(verified(with_part(good, name, part, shifted))) == {"moved"}


def test_a_hundred_faults_of_one_kind_are_counted_not_listed() -> None:
    good = job("stool", ONE_TOOL, "left-right")
    empty = dict.fromkeys(good.programs, b"IN;DF;PA;PU;SP1;PU;SP0;")
    result = verified(square_job.recorded(Job(good.plan, good.pattern, empty)))
    lost = [finding for finding in result.findings if finding.code == "missing-stroke"]
    assert len(lost) == 13
    assert lost[-1].message == f"There are {result.figures.strokes - 12} more of this kind."
