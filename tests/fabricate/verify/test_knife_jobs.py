"""A drag knife's jobs are proved by dragging blades; whatever is wrong with one is named."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import stools
from fabricate.verify import knife_job
from fabricate.verify.knife_job import KNIFE_JOBS, LIGHT, SWIVEL_JOBS
from fabricate.verify.square_job import Job

from foldmill.finding import Severity
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Fit
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import Verification, verify

OFFSETS = (0.25, 0.9)


def verified(job: Job, fit: Fit | None = None) -> Verification:
    return verify(job.plan, job.pattern, job.programs, fit)


def errors(result: Verification) -> set[str]:
    return {finding.code for finding in result.findings if finding.severity is Severity.ERROR}


def sentence(value: object) -> str:
    return str(getattr(value, "__name__", value)).replace("_", " ")


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("swivel", [0.0, LIGHT])
@pytest.mark.parametrize("change", ["operator", "select"])
def test_a_good_job_passes_whatever_way_the_blade_pointed(
    offset: float, swivel: float, change: str
) -> None:
    result = verified(knife_job.job(offset, swivel, change))
    assert result.findings == ()
    assert 0 < result.figures.deviation <= result.figures.tolerance == pytest.approx(0.045)


@pytest.mark.parametrize(
    ("offset", "swivel", "units", "most"),
    [(0.25, 0, 40, 0.02), (0.9, 0, 40, 0.02), (0.9, LIGHT, 40, 0.02), (0.9, 0, 1000, 0.006)],
)
def test_the_tip_strays_from_the_stool_by_a_fiftieth_of_a_mm_and_cuts_all_of_it(
    offset: float, swivel: float, units: float, most: float
) -> None:
    """On both faces, from twelve starting directions, in the machine's own steps."""
    fold = stools.stool()
    plan = make(fold, knife_job.material(swivel), knife_job.knife(offset, units))
    result = verify(plan, fold.pattern, hpgl.write(plan, fold))
    assert result.findings == ()
    assert result.figures.deviation <= most


def test_a_reverse_fitted_to_its_marks_is_proved_like_any_other() -> None:
    good, fit = knife_job.job(0.9, LIGHT), Fit(angle=0.1, dx=0.4, dy=-0.3)
    programs = {p.name: hpgl.program(good.plan, p.setups, fit) for p in hpgl.layout(good.plan)}
    fitted = Job(good.plan.model_copy(update={"programs": ()}), good.pattern, programs)
    assert errors(verified(fitted, fit)) == set()
    assert errors(verified(fitted))


@pytest.mark.long
@pytest.mark.parametrize(("spoil", "code"), KNIFE_JOBS.items(), ids=sentence)
def test_it_is_found_that(spoil: Callable[[Job], Job], code: str) -> None:
    assert code in errors(verified(spoil(knife_job.job(0.25))))
    assert code in errors(verified(spoil(knife_job.job(0.9, change="select"))))


@pytest.mark.parametrize(("spoil", "code"), SWIVEL_JOBS.items(), ids=sentence)
def test_it_is_found_of_a_thick_sheet_that(spoil: Callable[[Job], Job], code: str) -> None:
    assert code in errors(verified(spoil(knife_job.job(0.25, LIGHT))))
    assert code in errors(verified(spoil(knife_job.job(0.9, LIGHT, "select"))))
