"""Where a sheet lies on no mat, no program pushes it; and one that does is found."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from fabricate.verify import pulled_job
from fabricate.verify.pulled_job import MATLESS, PULLED
from fabricate.verify.square_job import Job

from foldmill.finding import Severity
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.jobsheet import words
from foldmill_fabricate.passes import Fit
from foldmill_fabricate.verify import verify

JOBS = [
    (MATLESS, "up", "left-right"),
    (MATLESS, "up", "end-over-end"),
    ("generic-hpgl-600", "up", "left-right"),
    ("generic-hpgl-600", "down", "end-over-end"),
    ("generic-hpgl-pens", "down", "left-right"),
    ("grbl-laser", "up", "left-right"),
]
HPGL = ("generic-hpgl-600", "generic-hpgl-pens")


def errors(found: Job, fit: Fit | None = None) -> set[str]:
    result = verify(found.plan, found.pattern, found.programs, fit)
    return {finding.code for finding in result.findings if finding.severity is Severity.ERROR}


def sentence(value: object) -> str:
    return str(getattr(value, "__name__", value)).replace("_", " ")


@pytest.mark.parametrize("which", JOBS, ids="-".join)
def test_a_sheet_without_a_mat_is_never_pushed(which: tuple[str, str, str]) -> None:
    assert errors(pulled_job.job(*which)) == set()


def test_the_feed_of_a_desktop_cutter_runs_back_with_the_tool_down_never() -> None:
    """Read from the bytes: D goes on to y,x; y falls, counted from the edge that went in."""
    drawn = 0
    for program in pulled_job.job(MATLESS).programs.values():
        for run in re.findall(r"D([-\d., ]+)", program.decode()):
            along = np.array([float(word) for word in re.findall(r"-?[\d.]+", run)][::2])
            assert (np.diff(along) <= 0).all()
            drawn += 1
    assert drawn > 10


@pytest.mark.parametrize(("spoil", "code"), PULLED.items(), ids=sentence)
@pytest.mark.parametrize("slug", HPGL)
def test_it_is_found_of_a_sheet_without_a_mat_that(
    slug: str, spoil: Callable[[Job], Job], code: str
) -> None:
    spoilt = spoil(pulled_job.job(slug))
    assert errors(spoilt) == {code}
    assert errors(spoil(pulled_job.job(slug, "down"))) == {code}


@pytest.mark.parametrize("slug", [MATLESS, "grbl-laser"])
def test_it_is_found_in_other_languages_that_a_mat_was_planned_for(slug: str) -> None:
    spoil = pulled_job.the_programs_are_those_of_the_same_machine_with_a_mat
    assert errors(spoil(pulled_job.job(slug))) == {"pushes"}


def test_a_reverse_fitted_to_its_marks_does_not_push_either() -> None:
    good, fit = pulled_job.job("generic-hpgl-600"), Fit(angle=0.2, dx=0.4, dy=-0.3)
    programs = {p.name: hpgl.program(good.plan, p.setups, fit) for p in hpgl.layout(good.plan)}
    fitted = Job(good.plan.model_copy(update={"programs": ()}), good.pattern, programs)
    assert errors(fitted, fit) == set()


def test_the_plan_says_what_pulling_costs() -> None:
    pulled, mat = (pulled_job.job("generic-hpgl-600", pull).plan for pull in ("up", None))
    assert pulled.figures.drawn == pytest.approx(mat.figures.drawn)
    assert pulled.figures.lifts > mat.figures.lifts
    assert pulled.figures.seconds > mat.figures.seconds
    assert mat.figures.travel < pulled.figures.travel
    assert pulled.figures.travel_bound <= pulled.figures.travel


def test_the_job_sheet_says_that_the_sheet_lies_on_no_mat() -> None:
    good = pulled_job.job(MATLESS)
    said = words.warnings(good.plan, good.pattern)
    assert any("without a mat" in each and "never pushes" in each for each in said)
    assert "on a mat" not in words.summary(good.plan)
    mat = pulled_job.job("generic-hpgl-600", None)
    assert not any("without a mat" in each for each in words.warnings(mat.plan, mat.pattern))
