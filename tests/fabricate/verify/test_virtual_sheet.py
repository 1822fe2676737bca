"""What the machine draws comes back to where it belongs on the sheet."""

from __future__ import annotations

import re

import numpy as np
import pytest
import stools
from fabricate.verify import square_job
from fabricate.verify.corrupt_programs import moved_all
from fabricate.verify.square_job import ONE_TOOL, PENS, Job

from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Fit
from foldmill_fabricate.verify import verify
from foldmill_fabricate.verify.virtual_sheet import on_carrier, on_sheet, to_carrier

FIT = Fit(angle=0.1, dx=0.4, dy=-0.3)


def errors(job: Job, fit: Fit | None = None) -> set[str]:
    return {finding.code for finding in verify(job.plan, job.pattern, job.programs, fit).findings}


@pytest.mark.parametrize("flip", ["left-right", "end-over-end"])
@pytest.mark.parametrize("face", list(Face))
def test_there_and_back_again_is_nowhere_else(face: Face, flip: str) -> None:
    plan = square_job.plan(square_job.machine(ONE_TOOL), flip)
    points = np.random.default_rng(5).uniform(0, 240, (50, 2))
    there = to_carrier(points, plan, face, FIT)
    assert on_sheet(there, plan, face, FIT) == pytest.approx(points, abs=1e-9)


def test_a_turned_sheet_shows_its_left_edge_on_the_right() -> None:
    plan = square_job.plan(square_job.machine(ONE_TOOL), "left-right")
    assert to_carrier([(10, 30)], plan, Face.FRONT, None).tolist() == [[30, 45]]
    assert to_carrier([(10, 30)], plan, Face.REVERSE, None).tolist() == [[270, 45]]
    turned = square_job.plan(square_job.machine(ONE_TOOL), "end-over-end")
    assert to_carrier([(10, 30)], turned, Face.REVERSE, None).tolist() == [[30, 225]]


def test_a_machine_that_exchanges_its_axes_is_read_so() -> None:
    machine = square_job.machine(ONE_TOOL)
    swapped = machine.model_copy(update={"axes": machine.axes.model_copy(update={"swap": True})})
    assert on_carrier([(40, 800)], swapped.axes).tolist() == [[20, 1]]
    plan = square_job.plan(swapped, "left-right")
    job = square_job.recorded(Job(plan, square_job.pattern(), square_job.emit(plan)))
    assert errors(job) == set()


@pytest.mark.parametrize("flip", ["left-right", "end-over-end"])
@pytest.mark.parametrize("slug", [ONE_TOOL, PENS])
def test_a_fitted_reverse_passes_with_its_fit_and_fails_without(slug: str, flip: str) -> None:
    job = square_job.job(slug, flip, FIT)
    assert errors(job, FIT) == set()
    assert errors(job) == {"displaced"}
    for finding in verify(job.plan, job.pattern, job.programs).findings:
        dx, dy, angle = (float(word) for word in re.findall(r"-?\d+\.\d+", finding.message))
        assert (dx, dy, angle) == pytest.approx((0.4, -0.3, 0.1), abs=0.05)
    assert errors(square_job.job(slug, flip), FIT) == {"displaced"}


def test_the_stool_fitted_by_the_real_writer_passes_with_its_fit() -> None:
    plan = stools.stool_plan()
    programs = {part.name: hpgl.program(plan, part.setups, FIT) for part in hpgl.layout(plan)}
    job = square_job.recorded(Job(plan, stools.stool().pattern, programs))
    assert errors(job, FIT) == set()
    assert "displaced" in errors(job)


def test_a_reverse_made_for_the_other_flip_is_named() -> None:
    job = square_job.job(PENS)
    wide = round((2 * job.plan.flip.axis + 2 * job.plan.sheet.dx) * 40)
    high = round((job.plan.sheet.height + 2 * job.plan.sheet.dy) * 40)
    other = moved_all(job, Face.REVERSE, lambda xy: (wide - xy[0], high - xy[1]))
    assert errors(other) == {"wrong-flip"}


def dragging(offset: float) -> Machine:
    machine = square_job.machine(ONE_TOOL)
    tools = machine.tools.model_copy(update={"firmware_offset": False, "blade_offset": offset})
    return machine.model_copy(update={"tools": tools})


def test_without_the_firmwares_help_a_blade_leaves_the_plan() -> None:
    """A program that does not make up for the offset is right for a pen and wrong for a knife."""
    found = {}
    for offset in (0.0, 0.25):
        plan = square_job.plan(dragging(offset), "left-right")
        job = square_job.recorded(Job(plan, square_job.pattern(), square_job.emit(plan)))
        found[offset] = verify(plan, job.pattern, job.programs)
    assert found[0.0].ok
    assert not found[0.25].ok
    assert 0.1 < found[0.25].figures.deviation < 0.5
    assert found[0.25].figures.tolerance == pytest.approx(0.045)
