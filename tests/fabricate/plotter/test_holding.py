"""A lock says who holds it, and who asks about one disturbs nobody."""

from __future__ import annotations

import multiprocessing
import os
import signal
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from foldmill_fabricate.plotter.holding import Held, Holder, holder_of, is_held, locked

JOB = Holder("job K3PX7Q", "Cancel it.")


def _hold(file: Path, ready: Any, over: Any) -> None:
    with locked(file, JOB):
        ready.set()
        over.wait(60)


def test_whoever_finds_a_lock_held_is_told_by_whom_and_since_when(tmp_path: Path) -> None:
    file = tmp_path / "a.lock"
    context = multiprocessing.get_context("spawn")
    ready, over = context.Event(), context.Event()
    process = context.Process(target=_hold, args=(file, ready, over))
    process.start()
    assert ready.wait(60)
    assert is_held(file)
    with pytest.raises(Held) as told, locked(file, Holder("another", "")):
        pass
    by = told.value.by
    assert by is not None
    assert (by.what, by.remedy, by.process) == (JOB.what, JOB.remedy, process.pid)
    assert f"process {process.pid} of {by.who}" in str(by)
    assert str(by).endswith(" UTC")
    os.kill(process.pid or 0, signal.SIGKILL)
    process.join()
    assert not is_held(file)
    with locked(file, Holder("the next", "")):
        now = holder_of(file)
        assert now is not None
        assert now.what == "the next", "the note of who was killed counts no more"
    assert holder_of(file) is None


def test_many_who_ask_at_once_disturb_neither_each_other_nor_who_begins(tmp_path: Path) -> None:
    file = tmp_path / "host.lock"
    assert not is_held(file)
    assert not file.exists(), "asking makes nothing"
    with locked(file, JOB):
        pass
    with ThreadPoolExecutor(8) as pool:
        asked = [pool.submit(lambda: [is_held(file) for _ in range(300)]) for _ in range(7)]
        assert not any(any(one.result()) for one in asked)
        asked = [pool.submit(lambda: [is_held(file) for _ in range(2000)]) for _ in range(7)]
        for _ in range(5):
            with locked(file, JOB):
                assert is_held(file)
        assert {len(one.result()) for one in asked} == {2000}


def test_a_lock_that_one_thread_took_is_let_go_by_another(tmp_path: Path) -> None:
    """A service begins in its own thread, and is ended from the server's."""
    file, held = tmp_path / "a.lock", ExitStack()
    with ThreadPoolExecutor(1) as pool:
        pool.submit(held.enter_context, locked(file, JOB)).result()
    assert is_held(file)
    held.close()
    assert not is_held(file)


def test_a_note_that_is_nonsense_is_left_out(tmp_path: Path) -> None:
    file = tmp_path / "a.lock"
    for text in ("", "[]", "{", '{"what": 3, "more": 4}'):
        (tmp_path / "a.lock.7.json").write_text(text)
        assert holder_of(file) is None
