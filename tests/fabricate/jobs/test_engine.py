"""The engine gives turns, whatever became of the one before, and keeps nothing of those over."""

from __future__ import annotations

import logging
import os
import signal
import sqlite3
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from disks import Disk, small_disk
from fabricate.jobs.workshop import PATIENCE, forks

from foldmill_fabricate.jobs import Places
from foldmill_fabricate.jobs.engine import Engine
from foldmill_fabricate.jobs.host import Host

TURNS = 22
QUEUE = "plotter-a"
First = Callable[[Path], None]
"""What happens in a first turn, of an engine that keeps its things in a folder."""


def give_turns(file: Path, done: Path) -> None:
    """Give turns in which nothing is to do, and end a moment after the last."""
    taken: list[str] = []

    def take(queue: str) -> str:
        taken.append(queue)
        return ""

    def due() -> dict[str, int]:
        return {QUEUE: min(5, TURNS - len(taken))}

    engine = Engine(f"sqlite:///{file}", "here", {QUEUE: (take, lambda _q, _j: None)}, due)
    engine.start()
    end = time.monotonic() + 40
    while len(taken) < TURNS and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(1.0)
    engine.stop()
    done.write_text(str(len(taken)))


@pytest.mark.long
def test_turns_that_are_over_are_forgotten(tmp_path: Path) -> None:
    file, done = tmp_path / "engine.sqlite", tmp_path / "done"
    process = forks().Process(target=give_turns, args=(file, done))
    process.start()
    process.join(60)
    assert int(done.read_text()) >= TURNS
    with sqlite3.connect(file) as engine:
        (kept,) = engine.execute("SELECT count(*) FROM workflow_status").fetchone()
    engine.close()
    assert 0 < kept < TURNS


def dies(_place: Path) -> None:
    """End this process as a power cut does."""
    os.kill(os.getpid(), signal.SIGKILL)


def fails(_place: Path) -> None:
    """Do something that nobody foresaw."""
    raise RuntimeError("nobody foresaw this")


def fills(place: Path) -> None:
    """Leave no room to write down that the turn is over."""
    Disk(place).fill()


def work_until_made(place: Path, log: Path, first: First | None = None) -> None:
    """Give turns to a job until it is made; ``first`` : what happens in the first turn."""
    logging.basicConfig(filename=log.with_suffix(".log"), force=True)
    begun, made = log, log.with_suffix(".made")

    def make(_queue: str, _job: str) -> None:
        with begun.open("a") as to:
            to.write("begun\n")
        if first and not begun.read_text().removeprefix("begun\n"):
            first(place)
        else:
            made.touch()

    queues = {QUEUE: (lambda _queue: "" if made.exists() else "A", make)}
    due = lambda: {QUEUE: int(not made.exists())}  # noqa: E731
    engine = Engine(f"sqlite:///{place / 'engine.sqlite'}", "here", queues, due)
    engine.start()
    end = time.monotonic() + PATIENCE
    while not made.exists() and time.monotonic() < end:
        time.sleep(0.05)
    engine.stop()


def test_a_turn_of_a_service_that_died_is_taken_up_by_the_next(tmp_path: Path) -> None:
    log = tmp_path / "turns"
    _run(tmp_path, log, dies)
    assert not log.with_suffix(".made").exists()
    _run(tmp_path, log)
    assert log.read_text() == "begun\n" * 2
    assert log.with_suffix(".made").exists()


def test_what_nobody_foresaw_is_logged_and_the_job_has_another_turn(tmp_path: Path) -> None:
    log = tmp_path / "turns"
    _run(tmp_path, log, fails)
    assert log.read_text() == "begun\n" * 2
    told = log.with_suffix(".log").read_text()
    assert f"a turn of {QUEUE} failed, another is given: nobody foresaw this" in told
    assert "Traceback" in told, "whoever mends it sees where"


@pytest.mark.long
def test_a_turn_whose_end_could_not_be_written_down_does_not_block_its_plotter(
    tmp_path: Path,
) -> None:
    log = tmp_path / "turns"
    with small_disk(tmp_path / "state", 4) as disk:
        process = forks().Process(target=work_until_made, args=(disk.place, log, fills))
        process.start()
        end = time.monotonic() + PATIENCE
        while not (disk.place / "filler").exists():
            assert time.monotonic() < end
            time.sleep(0.05)
        time.sleep(1.5)
        disk.free()
        process.join(PATIENCE)
    assert log.read_text() == "begun\n" * 2
    told = log.with_suffix(".log").read_text()
    assert f"a turn of {QUEUE} failed, another is given" in told
    assert "disk is full" in told


def test_a_computer_is_the_same_to_the_engine_whatever_it_is_called(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else what one service left at a crash would never be taken up by the next."""
    names = set()
    for name in ("bench-pc", "bench-pc.workshop.example"):
        monkeypatch.setattr("socket.gethostname", lambda name=name: name)
        host = Host(Places(tmp_path, ""), {})
        names.add(host._engine._config["executor_id"])
        host._held.close()
    assert len(names) == 1


def _run(place: Path, log: Path, first: First | None = None) -> None:
    process = forks().Process(target=work_until_made, args=(place, log, first))
    process.start()
    process.join(PATIENCE)
    assert not process.is_alive()
