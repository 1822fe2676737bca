"""The picture of what is wrong: red where lines are missing, orange where they are too many."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from io import BytesIO

import numpy as np
import pytest
from fabricate.verify import corrupt_plans as plans
from fabricate.verify import corrupt_programs as programs
from fabricate.verify import square_job
from fabricate.verify.square_job import Job
from matplotlib.image import imread

from foldmill_fabricate.passes import Face
from foldmill_fabricate.pictures.faults import faults_picture, place
from foldmill_fabricate.verify import Kind, Verification, verify

RED, ORANGE, VIOLET = (0xD0, 0x10, 0x10), (0xF0, 0x78, 0x00), (0x70, 0x00, 0xB0)
SPOILED: dict[Callable[[Job], Job], tuple[Kind, Face, tuple[int, int, int]]] = {
    programs.a_stroke_is_missing: (Kind.MISSING, Face.REVERSE, RED),
    programs.a_line_is_extra: (Kind.EXTRA, Face.FRONT, ORANGE),
    programs.a_stroke_is_moved_by_a_twentieth_of_a_mm: (Kind.MOVED, Face.REVERSE, VIOLET),
    lambda job: plans.replanned(job, plans.a_crease_is_forgotten): (Kind.MISSING, Face.FRONT, RED),
    lambda job: plans.replanned(job, plans.a_line_is_invented): (Kind.EXTRA, Face.REVERSE, ORANGE),
    lambda job: plans.replanned(job, plans.a_tie_is_not_left): (Kind.EXTRA, Face.REVERSE, ORANGE),
}


@cache
def good() -> Job:
    return square_job.job()


def verified(job: Job) -> Verification:
    return verify(job.plan, job.pattern, job.programs)


def pixels(png: bytes, colour: tuple[int, int, int]) -> np.ndarray:
    """Return where a picture has exactly this colour, as (row, column) shares."""
    image = np.round(imread(BytesIO(png))[..., :3] * 255).astype(int)
    shares: np.ndarray = np.argwhere((image == colour).all(axis=-1)) / image.shape[:2]
    return shares


@pytest.mark.parametrize(("spoil", "expected"), SPOILED.items())
def test_what_is_wrong_is_drawn_on_its_face_in_its_colour(
    spoil: Callable[[Job], Job], expected: tuple[Kind, Face, tuple[int, int, int]]
) -> None:
    kind, face, colour = expected
    job = spoil(good())
    found = verified(job)
    assert (kind, face) in {(fault.kind, fault.face) for fault in found.faults}
    inked = pixels(faults_picture(job.plan, found), colour)
    assert len(inked)
    assert ((inked[:, 1] > 0.5) == (face is Face.REVERSE)).any()


def test_a_good_job_has_nothing_red() -> None:
    found = verified(good())
    picture = faults_picture(good().plan, found)
    assert found.faults == ()
    assert not any(len(pixels(picture, colour)) for colour in (RED, ORANGE, VIOLET))
    assert picture == faults_picture(good().plan, found)


def test_a_missing_stroke_is_where_it_should_be_and_a_moved_one_says_by_how_much() -> None:
    (lost,) = verified(programs.a_stroke_is_missing(good())).faults
    stroke = good().plan.passes[1].setups[0].operations[0].strokes[1]
    assert {tuple(p) for p in np.round(lost.points, 6)} == {
        tuple(p) for p in np.round(stroke.points, 6)
    }
    (moved,) = verified(programs.a_stroke_is_moved_by_a_twentieth_of_a_mm(good())).faults
    assert moved.shift == pytest.approx((-0.05, 0.0), abs=0.02)  # mirrored on the reverse


def test_a_fault_that_is_no_line_is_ringed_where_it_is_on_the_face_it_speaks_of() -> None:
    job = plans.replanned(good(), plans.a_tie_is_in_a_corner)
    found = verified(job)
    assert found.faults == ()
    (finding,) = found.findings
    tie = job.plan.ties[0]
    assert place(finding) == pytest.approx((tie.x, tie.y), abs=0.01)
    assert len(pixels(faults_picture(job.plan, found), RED))


def test_a_finding_in_a_program_is_marked_on_that_programs_face() -> None:
    job = programs.a_line_is_extra(good())
    inked = pixels(faults_picture(job.plan, verified(job)), RED)
    assert len(inked)
    assert (inked[:, 1] < 0.5).all()
