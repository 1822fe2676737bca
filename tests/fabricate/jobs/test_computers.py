"""Several computers with one PostgreSQL: each has a name and plotters that no other has."""

from __future__ import annotations

import multiprocessing
import os
import signal
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from fabricate.jobs import postgres
from fabricate.jobs.terminal import plain, said, typing
from fabricate.jobs.workshop import PATIENCE, workshop
from sqlalchemy import create_engine, text

from foldmill_fabricate.jobs import JobState, Places, Submission
from foldmill_fabricate.jobs.alone import is_worked_on
from foldmill_fabricate.jobs.host import Host
from foldmill_fabricate.jobs.rows import About
from foldmill_fabricate.plotter.errors import PortUnavailable, Spoiled
from foldmill_fabricate.plotter.holding import Held, Holder
from foldmill_fabricate.plotter.ledger import Ledger, Program, State, words
from foldmill_fabricate.plotter.ledger.alone import alone

pytestmark = [
    pytest.mark.long,
    postgres.NEEDED,
]
MACHINE = "generic-hpgl-600"
JOB = Holder("job K3PX7Q", "Cancel it.")


def _hold(database: str, ready: Any) -> None:
    with Ledger(database).reserved(["plotter bench"], JOB):
        ready.set()
        time.sleep(60)


def test_a_name_is_held_until_its_process_ends_whatever_ends_it(database: str) -> None:
    ledger = Ledger(database)
    context = multiprocessing.get_context("spawn")
    ready = context.Event()
    process = context.Process(target=_hold, args=(database, ready))
    process.start()
    assert ready.wait(60)
    assert ledger.is_reserved("plotter bench")
    with pytest.raises(Held) as told, ledger.reserved(["other", "plotter bench"], JOB):
        pass
    assert told.value.name == "plotter bench"
    assert told.value.by is not None
    assert (told.value.by.what, told.value.by.process) == (JOB.what, process.pid)
    assert not ledger.is_reserved("other"), "who is refused holds nothing"
    os.kill(process.pid or 0, signal.SIGKILL)
    process.join()
    with ledger.reserved(["plotter bench"], JOB):
        assert ledger.is_reserved("plotter bench")
    assert not ledger.is_reserved("plotter bench")
    ledger.close()


def test_names_are_held_again_after_the_server_let_go_of_them_or_another_has_them(
    database: str,
) -> None:
    """Its administrator ends the connection, as a restart of the server would."""
    here, there = Ledger(database), Ledger(database)
    server = create_engine(database, isolation_level="AUTOCOMMIT")
    ends = text("SELECT pg_terminate_backend(pid) FROM pg_locks WHERE locktype = 'advisory'")
    with here.reserved(["plotter bench"], JOB) as keep, server.connect() as at:
        keep()
        at.execute(ends)
        keep()
        assert there.is_reserved("plotter bench")
        at.execute(ends)
        with there.reserved(["plotter bench"], Holder("another", "")):
            with pytest.raises(Held) as told:
                keep()
            assert told.value.by is not None
            assert told.value.by.what == "another"
        keep()
        assert there.is_reserved("plotter bench")
    assert not there.is_reserved("plotter bench")
    server.dispose()
    here.close()
    there.close()


def test_a_machine_on_the_network_has_one_hand_among_all_computers(
    database: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another computer is one with another folder for the locks of its own devices."""
    here, there = Ledger(database), Ledger(database)
    far, near = "socket://192.0.2.7:4001", "socket://127.0.0.1:4001"
    with alone(far, JOB, here), alone(near, JOB, here):
        monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
        told = r"job K3PX7Q .*Nothing was sent\. Cancel it\."
        with pytest.raises(PortUnavailable, match=told), alone(far, Holder("x", ""), there):
            pass
        with alone(near, Holder("x", ""), there):
            pass  # a port of one computer's own is not the other's
    with alone(far, JOB, there):
        pass
    here.close()
    there.close()


def test_a_stroke_is_written_down_before_a_sheet_is_given_up_or_never(database: str) -> None:
    """Where both are under way at once, whoever is second sees what the first has done."""
    ledger = Ledger(database)
    programs = [Program("1.hpgl", "front", "b" * 64, 12)]
    sheet = ledger.lay("a" * 64, programs, title="", machine="m", material="p").id
    run = ledger.claim(sheet, 0, "dev")
    engine = create_engine(database)
    with ThreadPoolExecutor(1) as pool:
        with engine.begin() as at:
            words.give_up(at, sheet)
            late = pool.submit(run.advance, 3, 1)
            time.sleep(0.5)
            assert not late.done(), "it waits for the word that is being written"
        with pytest.raises(Spoiled):
            late.result(30)
    record = ledger.record(sheet, 0)
    assert (record.state, record.runs[-1].sent) == (State.SPOILED, 0)
    engine.dispose()
    ledger.close()


def test_each_computer_has_a_name_and_plotters_that_no_other_has(
    database: str, tmp_path: Path
) -> None:
    with workshop(tmp_path, database=database, speed_up=0.5) as shop:
        shop.start()
        shop.attend(lambda: shop.simulator.sheet.under_way)
        bench = ("--plotter", f"bench=sim://{MACHINE}@{MACHINE}")
        other = ("--plotter", f"other=sim://{MACHINE}@{MACHINE}")
        elsewhere = {"XDG_STATE_HOME": str(tmp_path / "b")}
        with ThreadPoolExecutor(2) as pool:
            same = pool.submit(
                said, shop, "job", "work", *other, "--host-name", "here", **elsewhere
            )
            table = {"XDG_STATE_HOME": str(tmp_path / "c")}
            twice = pool.submit(said, shop, "job", "work", *bench, "--host-name", "two", **table)
            told = [plain(one.result().stderr) for one in (same, twice)]
        assert "works on jobs as 'here' with this database already" in told[0]
        assert "works on the jobs of plotter 'bench' already" in told[1]
        assert shop.process is not None
        assert all(f"process {shop.process.pid} of" in one for one in told)
        with typing(
            shop, "job", "work", *other, "--host-name", "two", XDG_STATE_HOME=str(tmp_path / "d")
        ) as second:
            assert second.stdout is not None
            assert second.stdout.readline().startswith("At work on other")
            assert is_worked_on(Places(tmp_path / "e", database), shop.at.store)
            shop.at.cancel(shop.job)
            end = time.monotonic() + PATIENCE
            while not shop.is_ended:
                assert time.monotonic() < end
                time.sleep(0.05)
            job = shop.at.job(shop.job)
            assert (job.state, job.note) == (JobState.CANCELLED, "A person ended it.")
        shop.rest()
        assert not shop.simulator.sheet.under_way
        shop.check_ledger()
        shop.end()
        assert not is_worked_on(shop.places, shop.at.store)


def test_a_job_that_is_cancelled_is_ended_by_the_computer_that_has_its_plotter(
    database: str, tmp_path: Path
) -> None:
    """The others end it only where no computer has that plotter any more."""
    host = Host(Places(tmp_path, database), {}, "two")
    asked, about = Submission(plan="0" * 64, plotter="bench"), About("A box", "pp", MACHINE)
    with Ledger(database).reserved(["plotter bench"], JOB):
        name = host.store.submit(asked, about).id
        host.store.take("bench")
        host.store.cancel(name)
        host.start()
        time.sleep(1.5)  # it looks twice a second
        assert host.store.job(name).state is JobState.RUNNING
    end = time.monotonic() + PATIENCE
    while host.store.job(name).state is JobState.RUNNING:
        assert time.monotonic() < end
        time.sleep(0.05)
    assert "bench is no longer there" in host.store.job(name).note
    host.stop()
