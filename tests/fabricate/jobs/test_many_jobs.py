"""Four plotters, many jobs, gates, pauses, cancels and a priority: all end right, one at a time."""

from __future__ import annotations

import random
import time
from itertools import pairwise
from pathlib import Path

from fabricate.jobs import mortal
from fabricate.jobs.workshop import PATIENCE, forks
from soaking import Soak

from foldmill_fabricate.jobs import Desk, JobState, Kind, Places, Reply, Submission
from foldmill_fabricate.jobs.errors import JobRefused
from foldmill_fabricate.jobs.plotters import read

MACHINE = "generic-hpgl-600"
PLOTTERS = [f"p{k}=sim://p{k}?machine={MACHINE}&speed_up=50@{MACHINE}" for k in range(4)]


def test_all_jobs_end_right_and_no_plotter_has_two_at_once(
    tmp_path: Path, job_folder: Path, soak: Soak
) -> None:
    count = soak.size(6, 40)
    with soak.part("many_jobs", 7, count, "jobs"):
        desk = Desk(Places(tmp_path / "state/foldmill", ""), read(Path("/dev/null"), PLOTTERS))
        plan, chance = desk.keep(job_folder), random.Random(7)
        asked = [Submission(plan=plan, plotter=f"p{k % 4}") for k in range(count)]
        jobs = [desk.submit(one).id for one in asked]
        late, early = jobs[-1], jobs[(count - 1) % 4]  # of one plotter
        desk.prioritise(late, 10)
        cancelled = {jobs[1], *chance.sample(jobs[4:-1], count // 8)} - {late, early}
        paused = set(chance.sample(sorted({*jobs} - cancelled - {late, early}), count // 6))
        service = forks().Process(
            target=mortal.main,
            args=(PLOTTERS, {"XDG_STATE_HOME": str(tmp_path / "state")}, tmp_path / "log"),
        )
        service.start()
        try:
            _attend(desk, cancelled, paused)
        finally:
            service.terminate()
            service.join(PATIENCE)
        for name in jobs:
            wanted = JobState.CANCELLED if name in cancelled else JobState.DONE
            assert desk.job(name).state is wanted, (tmp_path / "log").read_text()
        spans = _spans(desk, jobs)
        for plotter in desk.plotters:
            mine = sorted(span for name, span in spans.items() if _on(desk, name) == plotter)
            assert all(one[1] <= other[0] for one, other in pairwise(mine))
        beside = [spans[name][0] for name in jobs if _on(desk, name) == _on(desk, late)]
        assert spans[late][0] < max(beside)
        desk.store.close()


def _attend(desk: Desk, cancelled: set[str], paused: set[str]) -> None:
    """Answer everything; cancel and pause jobs once they ask for something, resume them later."""
    end, to_pause, to_cancel = time.monotonic() + 4 * PATIENCE, set(paused), set(cancelled)
    while not all(job.is_ended for job in desk.jobs()):
        assert time.monotonic() < end
        for question in desk.questions():
            if question.job in to_cancel and question.kind is Kind.FLIP:
                desk.cancel(question.job)
                to_cancel.remove(question.job)
                continue
            if question.job in to_pause:
                desk.pause(question.job)
                to_pause.remove(question.job)
            no = question.kind is Kind.TRY
            _quietly(lambda q=question, no=no: desk.answer(q.id, Reply(sheet=q.sheet, ok=not no)))
        for job in desk.jobs([JobState.PAUSED]):
            if job.id not in to_pause:
                _quietly(lambda job=job: desk.resume(job.id))
        time.sleep(0.03)
    assert not to_pause | to_cancel


def _quietly(call: object) -> None:
    """Do something that may have become needless since it was looked at."""
    try:
        call()  # type: ignore[operator]
    except JobRefused:
        return


def _on(desk: Desk, name: str) -> str:
    return desk.job(name).plotter


def _spans(desk: Desk, jobs: list[str]) -> dict[str, tuple[int, int]]:
    """Return the first and last event of each job while it had its plotter."""
    found: dict[str, tuple[int, int]] = {}
    for name in jobs:
        heard = desk.store.events(job=name)
        begun = next((one.number for one in heard if one.what == "begun"), None)
        if begun is not None:
            found[name] = (begun, heard[-1].number)
    return found
