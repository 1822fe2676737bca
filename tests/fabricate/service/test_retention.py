"""A service's disk does not fill: what no job needs goes after some days, and is told so."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest
from services import running, serving, square

from foldmill_fabricate.client import Client
from foldmill_fabricate.jobs import Submission
from foldmill_fabricate.jobs.keeping import DAY
from foldmill_fabricate.service.models import PlanRequest, PlanStatus

Left = tuple[Path, str, PlanStatus, PlanStatus]
HPGL = {"material": "pp-0.75", "machine": "generic-hpgl-600", "formats": ["hpgl"]}


def age(state: Path, days: float) -> None:
    """Let time pass over everything that is kept."""
    then = time.time() - days * DAY
    for kept in ("plans", "service/plans", "service/patterns"):
        for place in (state / kept).iterdir():
            os.utime(place, (then, then))


def until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + 60
    while not true():
        assert time.monotonic() < end, "nothing happens any more"
        time.sleep(0.02)


def planned(service: httpx.Client, side: float) -> PlanStatus:
    pattern = service.post("/api/v1/patterns", json=square(side)).json()["id"]
    asked = PlanRequest.model_validate({"pattern": pattern, **HPGL})
    with Client(str(service.base_url)) as client:
        return client.planned(asked)


def status(service: httpx.Client, path: str) -> int:
    return service.get(f"/api/v1/{path}").status_code


@pytest.fixture(scope="module")
def before(tmp_path_factory: pytest.TempPathFactory) -> Left:
    """Leave a service's folder with a plan that a job needs, and one that none does."""
    folder = tmp_path_factory.mktemp("before")
    with running(folder) as service:
        needed, idle = planned(service, 100), planned(service, 120)
        with Client(str(service.base_url)) as client:
            job = client.submit(Submission(plan=needed.plan, plotter="bench"))
            client.cancel(job.id)
    return folder, job.id, needed, idle


@pytest.fixture
def left(before: Left, tmp_path: Path) -> Left:
    shutil.copytree(before[0], tmp_path / "state")
    return tmp_path / "state", *before[1:]


@pytest.mark.long
def test_what_no_job_needs_goes_after_its_days_and_a_history_stays_whole(left: Left) -> None:
    state, job, needed, idle = left
    age(state, 31)
    with running(state) as service:
        until(lambda: not (state / "service/patterns" / idle.pattern).exists())
        until(lambda: not (state / "plans" / idle.plan).exists())
        refused = service.get(f"/api/v1/plans/{idle.id}")
        assert refused.status_code == 404
        assert "is kept 30 days after somebody last asked for it" in refused.json()["detail"]
        assert status(service, f"patterns/{idle.pattern}") == 404
        asked: dict[str, Any] = {"plan": idle.plan, "plotter": "bench"}
        assert service.post("/api/v1/jobs", json=asked).status_code == 404
        for path in (f"plans/{needed.id}", f"patterns/{needed.pattern}", f"jobs/{job}/history"):
            assert status(service, path) == 200
        for row in needed.files:
            assert status(service, f"jobs/{job}/files/{row.name}") == 200
        assert planned(service, 120) == idle, "asked for anew it is the same"


def test_what_was_asked_for_yesterday_stays(left: Left) -> None:
    state, _, needed, idle = left
    age(state, 29)
    with running(state) as service:
        assert status(service, f"plans/{idle.id}/files/plan.json") == 200
        shutil.rmtree(state / "plans" / needed.plan)
        asked = {"pattern": needed.pattern, **HPGL}
        assert service.post("/api/v1/plans", json=asked).status_code == 202, "it is made once more"
    for asked_for in (state / "plans" / idle.plan, state / "service/plans" / idle.id):
        assert time.time() - asked_for.stat().st_mtime < DAY
    left_alone = state / "service/patterns" / idle.pattern
    assert time.time() - left_alone.stat().st_mtime > 28 * DAY


def test_half_written_uploads_and_drafts_of_a_crash_are_gone_when_it_starts_again(
    tmp_path: Path,
) -> None:
    upload = tmp_path / "service/scratch/tmp1" / "upload"
    draft = tmp_path / "plans/.draft-1" / "plan.json"
    for file in (upload, draft):
        file.parent.mkdir(parents=True)
        file.write_bytes(b"{")
    os.utime(draft.parent, (1.7e9, 1.7e9))
    with running(tmp_path):
        assert not upload.parent.exists()
        until(lambda: not draft.parent.exists())


@pytest.mark.long
def test_who_runs_the_service_says_for_how_many_days(left: Left) -> None:
    state, _, needed, idle = left
    age(state, 6)
    words = ("--keep-days", "5", "--plotter", "bench=sim://generic-hpgl-600")
    with serving(state, *words) as (_, url), httpx.Client(base_url=url, timeout=60) as service:
        until(lambda: not (state / "plans" / idle.plan).exists())
        assert "is kept 5 days" in service.get(f"/api/v1/plans/{idle.id}").json()["detail"]
        assert status(service, f"plans/{needed.id}") == 200
