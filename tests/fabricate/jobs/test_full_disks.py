"""No room is left where the service keeps its work: nothing is lost, and all goes on afterwards."""

from __future__ import annotations

import sqlite3
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from disks import Disk, small_disk
from fabricate.jobs.workshop import Workshop, drawn, workshop
from services import running

from foldmill_fabricate.jobs import JobState, Kind, Order, Places, Submission
from foldmill_fabricate.jobs.engine import PLANNING
from foldmill_fabricate.jobs.host import Host
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.jobs.rows import About
from foldmill_fabricate.plotter.errors import LedgerFailed
from foldmill_fabricate.plotter.ledger import Ledger, Program, Run
from foldmill_fabricate.space import DiskFull

pytestmark = pytest.mark.long

STROKES = 20_000
STAR = Order(family="rotational", preset="star-n6")


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Disk]:
    with small_disk(tmp_path / "state", 12) as made:
        yield made


def test_a_ledger_without_room_says_so_and_holds_what_it_held(disk: Disk) -> None:
    ledger = Ledger(disk.place / "ledger.sqlite")
    programs = [Program("1-front-score.hpgl", "front", "0" * 64, STROKES)]
    sheet = ledger.lay("job", programs, title="", machine="", material="").id
    run = ledger.claim(sheet, 0, "here")
    run.advance(1, 0)
    disk.fill()
    with pytest.raises(LedgerFailed, match=f"The disk of {disk.place} is full") as told:
        _write_down(run)
    assert "Make room" in str(told.value)
    reached = ledger.record(sheet, 0).runs[-1].sent
    assert reached == run.sent, "what was not written down is not counted"
    disk.free()
    run.advance(reached + 1, reached)
    assert ledger.record(sheet, 0).runs[-1].sent == reached + 1
    ledger.close()
    _is_whole(disk)


def _write_down(run: Run) -> None:
    for stroke in range(1, STROKES):
        run.advance(stroke + 1, stroke)


def test_a_plan_for_which_there_is_no_room_leaves_nothing(disk: Disk, job_folder: Path) -> None:
    plans = Plans(disk.place / "plans")
    disk.fill()
    with pytest.raises(DiskFull, match=f"The disk of {disk.place}"):
        plans.keep(job_folder)
    disk.free()
    assert not [file for file in disk.place.rglob("*") if file.is_file()]
    assert plans.plan(plans.keep(job_folder)).programs


def test_an_order_waits_until_there_is_room_to_plan_it(
    tmp_path: Path, disk: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    host = Host(Places(tmp_path / "host", ""), {})
    about = About("star", STAR.material, STAR.machine)
    job = host.store.submit(Submission(design=STAR, plotter="bench"), about).id
    monkeypatch.setattr("tempfile.tempdir", str(disk.place))
    disk.fill()
    host._plan(PLANNING, job)
    held = host.store.job(job)
    assert held.state is JobState.PLANNING, held.note
    assert f"The disk of {disk.place}" in held.note
    assert host._due()[PLANNING] == 1, "it is tried again"
    host._held.close()


def test_an_upload_for_which_there_is_no_room_is_to_be_sent_again(disk: Disk) -> None:
    headers = {"content-type": "application/octet-stream", "x-foldmill": "1"}
    with running(disk.place / "service") as client:
        disk.fill()
        answer = client.post("/api/v1/patterns", content=bytes(300_000), headers=headers)
        assert answer.status_code == 503, answer.text
        assert f"The disk of {disk.place}" in answer.json()["detail"]
        assert "Make room" in answer.json()["detail"]
        assert client.get("/api/v1/patterns").json() == []
        assert client.get("/healthz").status_code == 200
        disk.free()
        again = client.post("/api/v1/patterns", content=bytes(300_000), headers=headers)
        assert again.status_code == 422, "now it is read, and is no pattern"


def test_when_the_disk_is_full_under_work_the_machine_stops_and_goes_on_once_there_is_room(
    tmp_path: Path, disk: Disk
) -> None:
    with workshop(tmp_path) as shop:
        shop.start()
        shop.attend(lambda: shop.simulator.device.traffic.begun > 300)
        disk.fill()
        _wait_until_told(shop, disk)
        shop.rest()
        assert not shop.simulator.sheet.under_way, "its pen is up"
        before = drawn(shop.simulator)
        time.sleep(1.0)
        shop.rest()
        assert drawn(shop.simulator) == before
        disk.free()
        shop.attend(lambda: shop.is_ended or shop.is_dead)
        assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
        shop.end()
        shop.check_ledger()
        shop.rest()
        assert shop.difference() == (Counter(), Counter()), shop.log()
        assert "Traceback" not in shop.log(), shop.log()
    _is_whole(disk)


def _wait_until_told(shop: Workshop, disk: Disk) -> None:
    """Wait until the log, or a question, says what is the matter, and what to do."""
    end = time.monotonic() + 30
    wanted = f"The disk of {disk.place}"
    while wanted not in shop.log():
        asked = [one for one in shop.at.questions(shop.job) if one.kind is Kind.TROUBLE]
        if any(wanted in one.text and "Make room" in one.text for one in asked):
            return
        assert time.monotonic() < end, shop.log()
        time.sleep(0.05)


def _is_whole(disk: Disk) -> None:
    for file in disk.place.rglob("*.sqlite"):
        with sqlite3.connect(file) as database:
            assert database.execute("PRAGMA integrity_check").fetchall() == [("ok",)], file
        database.close()
