"""The ledger's strokes are those of the plan that verification finds a program to draw."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from fabricate.bench import small_plan
from fabricate.half_made import KNIFE, LASER, ONE_TOOL, PENS, job_of, swivelled

from foldmill_fabricate.marks import targets
from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.plotter.languages import made_ready
from foldmill_fabricate.plotter.ledger import Entry, Program, Record, State
from foldmill_fabricate.remaking.strokes import Standing, owners, standings
from foldmill_fabricate.sending import Job
from foldmill_fabricate.sheet import seen_by_machine
from foldmill_fabricate.verify.programs import prove_programs

PLANS: Mapping[str, Callable[[], Plan]] = {
    slug: partial(small_plan, slug)
    for slug in (
        ONE_TOOL,
        PENS,
        KNIFE,
        LASER,
        "silhouette-like",
        "silhouette-like-matless",
        "grbl-drag-knife",
    )
} | {"swivels": swivelled}


@pytest.fixture(scope="module", params=PLANS)
def job(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Job:
    return job_of(tmp_path_factory.mktemp("job"), PLANS[request.param]())


def lying(job: Job) -> list[Job]:
    """The reverse as planned, and 0.4 mm off as its marks were measured."""
    if not job.plan.holes:  # a sheet of one face
        return [job]
    seen = seen_by_machine(job.plan, Face.REVERSE, targets(job.plan))
    return [job, job.fitted([(x + 0.4, y - 0.3) for x, y in seen.tolist()])]


@pytest.mark.long
def test_every_stroke_is_the_one_that_verification_sees_drawn(job: Job) -> None:
    """Verification reads the bytes and knows nothing of how they were written."""
    for each in lying(job):
        agree(each)


def agree(job: Job) -> None:
    fit = job.fit.fit if job.fit else None
    proof = prove_programs(job.plan, job.programs, fit)
    assert not proof.findings
    for part, replay in zip(job.plan.programs, proof.replays, strict=True):
        ours = owners(job.plan, part, fit)
        assert len(ours) == made_ready(job.programs[part.name], job.plan.machine).strokes
        drawn = replay.drawing
        theirs = [drawn.strokes[k] for k in drawn.strokes_of_lines.tolist() if k >= 0]
        rows = [(own.setup, own.stroke) for own in ours if own is not None]
        assert len(rows) == len(theirs)
        for (setup, stroke), planned in zip(rows, theirs, strict=True):
            assert setup == planned.setup.number
            before = 0
            for operation in planned.setup.operations:
                if operation.role is planned.role:
                    break
                before += len(operation.strokes)
            assert stroke == before + planned.number - 1


def test_lead_ins_and_turns_of_a_lifted_blade_are_no_strokes_of_the_plan(tmp_path: Path) -> None:
    job = job_of(tmp_path, swivelled())
    setups = [setup for work in job.plan.passes for setup in work.setups]
    cut = setups[-1]
    found = owners(job.plan, job.plan.programs[-1])
    assert found[0] is None
    assert found.count(None) > 1
    outline = next(each for each in cut.operations if each.role is Role.CUT_OUTER)
    real = {own.stroke for own in found if own is not None}
    assert real == set(range(len(outline.strokes)))
    assert len([own for own in found if own is not None]) > len(outline.strokes)


RECORD = Record(
    "ABCD", 0, Program("front.hpgl", "front", "", 6), State.INTERRUPTED, 0, 0, 0.0, "", ()
)


def test_a_stroke_that_was_taken_up_at_a_vertex_is_half_cut_until_it_is_confirmed() -> None:
    first = Entry(1, 0, 0, 4, 2, cut_to=2)
    said = replace(RECORD, state=State.READY, first=2, vertex=3, runs=(first,))
    certain, half, left = Standing.CERTAIN, Standing.HALF, Standing.LEFT
    assert standings(said) == [certain, certain, half, left, left, left]
    stopped = replace(said, state=State.INTERRUPTED, runs=(first, Entry(2, 2, 3, 4, 2)))
    doubt = Standing.DOUBTFUL
    assert standings(stopped) == [certain, certain, half, doubt, left, left]
    on = replace(said, state=State.INTERRUPTED, runs=(first, Entry(2, 2, 3, 5, 4)))
    assert standings(on) == [certain, certain, certain, certain, doubt, left]
