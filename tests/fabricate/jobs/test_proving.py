"""What is proved beside machines at work is proved in other processes, and is the same."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fabricate.jobs.test_work import asked, at_work

from foldmill_fabricate import sending
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.jobs import Desk, JobState, Kind, Reply, Submission, elsewhere, proving
from foldmill_fabricate.jobs.errors import Leave
from foldmill_fabricate.jobs.proving import Elsewhere
from foldmill_fabricate.jogging import expected_marks
from foldmill_fabricate.passes import Face
from foldmill_fabricate.sending import Job, open_job
from foldmill_fabricate.trials import trial_program

pytestmark = pytest.mark.long

AWRY = (0.3, -0.2)
"""mm by which a sheet lies off after the flip."""


def opened(folder: Path, elsewhere: Elsewhere | None = None) -> Job:
    """Open a folder, proved elsewhere or here."""
    if elsewhere is None:
        return open_job(folder)
    return open_job(folder, prover=elsewhere.prove, fitter=elsewhere.fit)


def seen(job: Job) -> list[tuple[float, float]]:
    """Return where its marks are seen on a sheet that lies awry."""
    return [(x + AWRY[0], y + AWRY[1]) for x, y in expected_marks(job.plan)]


def test_a_reverse_that_is_fitted_elsewhere_is_the_one_that_is_fitted_here(
    job_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = opened(job_folder)
    fitted = here.fitted(seen(here))
    monkeypatch.delattr(sending, "verify")  # nothing is proved in this process from here on
    beside = opened(job_folder, Elsewhere(lambda: None)).fitted(seen(here))
    assert beside.programs == fitted.programs != here.programs
    assert (str(beside.fit), beside.marks) == (str(fitted.fit), fitted.marks)


def test_what_cannot_be_fitted_is_refused_elsewhere_in_the_same_words(
    job_folder: Path, tmp_path: Path
) -> None:
    """One mark shows no angle; and a program was edited since the folder was proved."""
    folder = tmp_path / "job"
    shutil.copytree(job_folder, folder)
    here, beside = opened(folder), opened(folder, Elsewhere(lambda: None))
    with pytest.raises(CannotSend) as told:
        here.fitted(seen(here)[:1])
    with pytest.raises(CannotSend) as same:
        beside.fitted(seen(here)[:1])
    assert str(told.value) == str(same.value)
    program = folder / here.plan.programs[0].name
    program.write_bytes(program.read_bytes() + b"PU0,0;\n")
    with pytest.raises(CannotSend):
        beside.fitted(seen(here))


def test_a_test_cut_that_is_made_elsewhere_is_the_one_that_is_made_here(
    job_folder: Path,
) -> None:
    """Of the front, and of a reverse that lies awry; each in a place of its own."""
    here, there = opened(job_folder), Elsewhere(lambda: None)
    beside = open_job(job_folder, prover=there.prove, fitter=there.fit)
    front, reverse = (work.setups[-1] for work in here.plan.passes)
    fitted = here.fitted(seen(here))
    for job, face, setup, attempt in [
        (here, Face.FRONT, front, 1),
        (fitted, Face.REVERSE, reverse, 0),
    ]:
        other = replace(beside, fit=job.fit)
        made = there.trial(other, face, setup, attempt)
        assert made == trial_program(job, face, setup, attempt)


def test_what_was_proved_once_is_not_proved_again_unless_a_byte_of_it_is_another(
    job_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, proven = tmp_path / "job", set[str]()
    shutil.copytree(job_folder, folder)
    opened(folder, Elsewhere(lambda: None, proven))
    assert len(proven) == 1
    asked_for = set[str]()

    def done(module: str, *order: Any) -> dict[str, Any]:
        asked_for.add(module)
        return elsewhere.done(module, *order)

    monkeypatch.setattr(proving, "done", done)
    assert opened(folder, Elsewhere(lambda: None, proven)).programs
    assert not asked_for
    program = folder / opened(folder).plan.programs[0].name
    program.write_bytes(program.read_bytes() + b"PU0,0;\n")
    with pytest.raises(CannotSend):
        opened(folder, Elsewhere(lambda: None, proven))
    assert asked_for
    assert len(proven) == 1


def test_fitting_ends_with_the_process_that_wants_it(job_folder: Path) -> None:
    left = [False]

    def heed() -> None:
        if left[0]:
            raise Leave("The service ends.")

    job = opened(job_folder, Elsewhere(heed))
    left[0] = True
    with pytest.raises(Leave):
        job.fitted(seen(job))
    left[0] = False
    assert job.fitted(seen(job)).fit is not None


def test_nothing_is_sent_before_what_was_measured_at_a_gate_is_proved(
    desk: Desk, plan: str, job_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    marks = tuple(seen(opened(job_folder)))
    monkeypatch.delattr(sending, "verify")
    job = desk.submit(Submission(plan=plan, plotter="bench")).id
    with at_work(desk):
        gate = asked(desk, Kind.FLIP, Kind.TROUBLE)
        assert gate.kind is Kind.FLIP, gate.text
        desk.answer(gate.id, Reply(sheet=gate.sheet, marks=marks), "Ada")
        asked(desk, Kind.REMOVE)
    history = [one.what for one in desk.history(job)]
    flip = next(k for k, what in enumerate(history) if what.startswith("flip: marks"))
    reverse = [k for k, what in enumerate(history) if what.startswith("begun at stroke 1 ")][-1]
    assert flip < reverse
    (sheet,) = desk.job(job).sheets
    kept = [one.told["marks"] for one in desk.store.ledger.answers(sheet) if "marks" in one.told]
    assert kept == [[list(mark) for mark in marks]]
    assert desk.job(job).state is not JobState.FAILED
