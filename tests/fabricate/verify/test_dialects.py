"""Every way of spoiling a program in GP-GL or G-code is found and named."""

from __future__ import annotations

import pytest
from fabricate.verify.corrupt_dialects import (
    CUTTER,
    CUTTERS,
    KNIFE,
    KNIVES,
    LASER,
    LASERS,
    Spoil,
    job,
)
from fabricate.verify.corrupt_plans import PLANS
from fabricate.verify.corrupt_programs import PROGRAMS
from fabricate.verify.knife_job import KNIFE_JOBS, SWIVEL_JOBS
from fabricate.verify.pulled_job import PULLED
from fabricate.verify.row_job import ROW_JOBS, SNAP_JOBS
from fabricate.verify.square_job import Job

from foldmill.finding import Severity
from foldmill_fabricate.verify import verify

CASES = [
    (slug, spoil, code)
    for slug, cases in ((CUTTER, CUTTERS), (KNIFE, KNIVES), (LASER, LASERS))
    for spoil, code in cases.items()
]


def errors(found: Job) -> set[str]:
    result = verify(found.plan, found.pattern, found.programs)
    return {finding.code for finding in result.findings if finding.severity is Severity.ERROR}


@pytest.mark.parametrize("slug", [CUTTER, KNIFE, LASER])
def test_a_good_program_passes(slug: str) -> None:
    assert errors(job(slug)) == set()


@pytest.mark.parametrize(
    ("slug", "spoil", "code"),
    CASES,
    ids=lambda value: getattr(value, "__name__", str(value)).replace("_", " "),
)
def test_it_is_found_in_the_program_that(slug: str, spoil: Spoil, code: str) -> None:
    assert code in errors(spoil(job(slug)))


def test_many_more_than_forty_ways_of_spoiling_a_job_are_tried() -> None:
    jobs = [PROGRAMS, KNIFE_JOBS, SWIVEL_JOBS, ROW_JOBS, SNAP_JOBS, PULLED]
    named = {spoil.__name__ for each in jobs for spoil in each}
    named |= {spoil.__name__ for spoil in PLANS}
    named |= {spoil.__name__ for _, spoil, _ in CASES}
    assert len(named) >= 90
