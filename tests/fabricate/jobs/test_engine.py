"""The engine keeps nothing of turns that are over: a service runs for years."""

from __future__ import annotations

import sqlite3
import time
from pathlib import Path

from fabricate.jobs.workshop import forks

from foldmill_fabricate.jobs.engine import Engine

TURNS = 22


def give_turns(file: Path, done: Path) -> None:
    """Give turns in which nothing is to do, and end a moment after the last."""
    taken: list[str] = []

    def take(queue: str) -> str:
        taken.append(queue)
        return ""

    def due() -> dict[str, int]:
        return {"plotter-a": min(5, TURNS - len(taken))}

    engine = Engine(f"sqlite:///{file}", "here", {"plotter-a": (take, lambda _q, _j: None)}, due)
    engine.start()
    end = time.monotonic() + 40
    while len(taken) < TURNS and time.monotonic() < end:
        time.sleep(0.05)
    time.sleep(1.0)
    engine.stop()
    done.write_text(str(len(taken)))


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
