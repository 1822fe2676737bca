"""A machine has one hand, and jobs one worker: all others are told whose, and nothing moves."""

from __future__ import annotations

import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from fabricate.jobs.terminal import plain, said, typing
from fabricate.jobs.workshop import PATIENCE, Workshop, machine, workshop

from foldmill_fabricate.jobs import JobState, Kind
from foldmill_fabricate.jobs.store import JobStore
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.ledger import State
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.servers import serve_tcp

pytestmark = pytest.mark.long

MACHINE = "generic-hpgl-600"


def until(shop: Workshop, *kinds: Kind) -> str:
    """Wait, answering nothing, until something of these kinds is asked; return its text."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        for one in shop.at.questions():
            if one.kind in kinds:
                return one.text
        time.sleep(0.02)
    pytest.fail(shop.log())


def test_beside_a_job_nobody_leads_its_machine_about_nor_sends_to_it(tmp_path: Path) -> None:
    with workshop(tmp_path) as shop:
        shop.start()
        until(shop, Kind.LOAD)
        heard = bytes(shop.simulator.device.traffic.received)
        port = ("--port", shop.port)
        commands = [
            ("send", str(shop.folder), *port),
            ("register", str(shop.folder), *port),
            ("jog", "5", "5", *port, "--machine", MACHINE),
        ]
        with ThreadPoolExecutor(4) as pool:
            told = list(pool.map(lambda words: said(shop, *words), commands))
        for one in told:
            text = plain(one.stderr)
            assert one.returncode == 2, text
            assert f"at work on {shop.port}: job {shop.job} (process" in text
            assert f"end it: foldmill job cancel {shop.job}." in text
        assert shop.simulator.device.traffic.received == heard, "not a byte reached the machine"
        assert shop.at.job(shop.job).state is JobState.WAITING


def test_a_job_that_is_due_while_somebody_sends_waits_for_a_word_and_is_made_then(
    tmp_path: Path,
) -> None:
    with workshop(tmp_path) as shop:
        with typing(shop, "send", str(shop.folder), "--port", shop.port) as sender:
            assert sender.stdout is not None
            while "Load" not in (line := sender.stdout.readline()) and line:
                pass
            heard = bytes(shop.simulator.device.traffic.received)
            shop.start()
            text = plain(until(shop, Kind.TROUBLE, Kind.LOAD))
            assert f"at work on {shop.port}: foldmill send {shop.folder} (process" in text
            assert f"process {sender.pid} of" in text
            assert "end it where it runs" in text
            assert shop.at.job(shop.job).state is JobState.NEEDS_OPERATOR
            assert shop.simulator.device.traffic.received == heard
        shop.attend(lambda: shop.is_ended)
        assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
        assert shop.difference() == (Counter(), Counter())
        shop.end()


def test_a_sheet_that_is_being_made_is_not_taken_to_another_port(tmp_path: Path) -> None:
    """A live run must not be found without an end, and be taken for dead, by a wrong address."""
    with workshop(tmp_path, speed_up=0.1) as shop:
        shop.start()
        shop.attend(lambda: shop.simulator.sheet.under_way)
        ledger, sheet = shop.at.store.ledger, shop.at.job(shop.job).sheets[-1]
        elsewhere = Simulator(machine(blind=False), clock=RealClock())
        with serve_tcp(elsewhere) as port:
            words = ("send", str(shop.folder), "--port", port, "--sheet", sheet)
            told = said(shop, *words)
        assert told.returncode == 2
        text = plain(told.stderr)
        assert f"Sheet {sheet} is worked on already: job {shop.job} (process" in text
        states = {one.state for one in ledger.sheet(sheet).records}
        assert states <= {State.RUNNING, State.READY, State.DONE}, "the job goes on undisturbed"
        assert not elsewhere.sheet.seen(Face.FRONT)
        shop.kill()


def test_of_those_who_would_work_on_the_same_jobs_only_the_first_does(tmp_path: Path) -> None:
    """The same folder is refused, and another folder with the same database."""
    with workshop(tmp_path, database=f"sqlite:///{tmp_path / 'jobs.sqlite'}") as shop:
        shop.start()
        until(shop, Kind.LOAD)
        assert shop.process is not None
        more = ("--plotter", f"other=sim://{MACHINE}@{MACHINE}", "--host-name", "two")
        serve, work = ("serve", "--port", "0", *more), ("job", "work", *more)
        elsewhere = {"XDG_STATE_HOME": str(tmp_path / "b")}
        with ThreadPoolExecutor(3) as pool:
            asked = [pool.submit(said, shop, *words) for words in (serve, work)]
            asked.append(pool.submit(said, shop, *work, **elsewhere))
            told = [one.result() for one in asked]
        for one, folder in zip(told, (shop.places.root, shop.places.root, tmp_path), strict=True):
            text = plain(one.stderr)
            assert one.returncode == 2, text
            assert f"works on the jobs in {folder} already: `foldmill serve` or" in text
            assert f"process {shop.process.pid} of" in text
            assert "Stop that one first, leave the work to it" in text
        assert shop.at.job(shop.job).state is JobState.WAITING


def test_a_hand_that_lost_its_job_is_stopped_by_that_alone(tmp_path: Path) -> None:
    """Whoever has the job now must not find its machine at work."""
    with workshop(tmp_path, speed_up=0.5) as shop:
        shop.start()
        shop.attend(lambda: shop.simulator.sheet.under_way)
        another = JobStore(shop.places.ledger)
        assert another.take("bench") is not None
        sheet = shop.at.job(shop.job).sheets[-1]
        end = time.monotonic() + PATIENCE
        while another.ledger.record(sheet, 0).state.value == "running":
            assert time.monotonic() < end, shop.log()
            time.sleep(0.05)
        another.close()
        assert another.ledger.record(sheet, 0).state.value == "interrupted"
        shop.check_ledger()
        shop.kill()
