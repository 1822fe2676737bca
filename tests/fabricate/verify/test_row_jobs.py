"""Perforated creases and snapped outlines: whatever is wrong with one is found and named."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fabricate.verify.row_job import ROW_JOBS, SNAP_JOBS, job
from fabricate.verify.square_job import Job

from foldmill.finding import Severity
from foldmill_fabricate.verify import Verification, verify

KNIFE, PLAIN = "generic-hpgl-drag-knife", "generic-hpgl-600"


def verified(found: Job) -> Verification:
    return verify(found.plan, found.pattern, found.programs)


def errors(result: Verification) -> set[str]:
    return {finding.code for finding in result.findings if finding.severity is Severity.ERROR}


def sentence(value: object) -> str:
    return str(getattr(value, "__name__", value)).replace("_", " ")


@pytest.mark.parametrize("machine", [KNIFE, PLAIN])
@pytest.mark.parametrize(
    ("score", "outline"), [("perforation", None), (None, "score-and-snap")], ids=str
)
def test_a_good_job_passes(machine: str, score: str | None, outline: str | None) -> None:
    assert errors(verified(job(machine, score, outline))) == set()


@pytest.mark.parametrize("machine", [KNIFE, PLAIN])
@pytest.mark.parametrize(("spoil", "code"), ROW_JOBS.items(), ids=sentence)
def test_it_is_found_of_rows_of_cuts_that(
    spoil: Callable[[Job], Job], code: str, machine: str
) -> None:
    assert code in errors(verified(spoil(job(machine, "perforation", None))))


@pytest.mark.parametrize("machine", [KNIFE, PLAIN])
@pytest.mark.parametrize(("spoil", "code"), SNAP_JOBS.items(), ids=sentence)
def test_it_is_found_of_an_outline_that_is_snapped_that(
    spoil: Callable[[Job], Job], code: str, machine: str
) -> None:
    assert code in errors(verified(spoil(job(machine, None, "score-and-snap"))))
