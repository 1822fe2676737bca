"""One hand on a device."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from pathlib import Path
from typing import Any

import pytest

from foldmill_fabricate.plotter.errors import PortUnavailable
from foldmill_fabricate.plotter.lock import device_of, held


@pytest.fixture
def port(tmp_path: Path) -> str:
    place = tmp_path / "ttyX0"
    place.touch()
    return str(place)


def test_a_link_and_the_device_behind_it_are_one(port: str, tmp_path: Path) -> None:
    link = tmp_path / "by-id"
    link.symlink_to(port)
    assert device_of(str(link)) == device_of(port)
    assert device_of("socket://Plotter:4001/?logging=debug") == device_of("SOCKET://plotter:4001")
    assert device_of("com3") == device_of("COM3")
    with held(port), pytest.raises(PortUnavailable, match="Another foldmill"), held(str(link)):
        pass


@pytest.mark.parametrize(
    "other",
    ["socket://LOCALHOST:4001", "rfc2217://127.0.0.1:4001", "spy://socket://localhost:4001?file=x"],
)
def test_a_servers_port_is_one_device_however_it_is_reached(other: str) -> None:
    assert device_of(other) == device_of("socket://127.0.0.1:4001/")
    assert device_of(other) != device_of("socket://127.0.0.1:4002")
    assert device_of(other) != device_of("socket://192.0.2.7:4001")


def test_a_port_that_is_listened_in_at_is_that_port(port: str) -> None:
    assert device_of(f"spy://{port}?file=/dev/null") == device_of(port)


def test_a_lock_is_free_again_after_use_and_other_devices_are_free_all_the_time(port: str) -> None:
    with held(port), held(port + "1"):
        pass
    with held(port) as name:
        assert name == os.path.realpath(port)


def _hold(url: str, ready: Any) -> None:
    with held(url):
        ready.set()
        time.sleep(60)


def test_a_lock_dies_with_the_process_that_held_it(port: str) -> None:
    context = multiprocessing.get_context("spawn")
    ready = context.Event()
    holder = context.Process(target=_hold, args=(port, ready))
    holder.start()
    assert ready.wait(60)
    with pytest.raises(PortUnavailable, match="at work on"), held(port):
        pass
    os.kill(holder.pid or 0, signal.SIGKILL)
    holder.join()
    with held(port):
        pass
