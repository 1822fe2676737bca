"""Where too much is under way, whoever comes is told so before anything is taken of them."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import httpx
import pytest
from services import running, square
from unhurried import of_tests

from foldmill_fabricate.service.desk import WORK
from foldmill_fabricate.service.sandbox import Limits, Sandbox

SHEET = {"material": "pp-0.75", "machine": "generic-hpgl-600"}
Busy = tuple[httpx.Client, str, list[Future[Any]]]


@pytest.fixture(scope="module")
def busy(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Busy]:
    """Give a service whose only process works, and for which another piece of work waits."""
    folder = tmp_path_factory.mktemp("busy")
    sandbox = Sandbox(folder / "scratch", [WORK, "sandbox_probes"], at_once=1, waiting=1)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", of_tests())
        yield from _busy(folder, sandbox)


def _busy(folder: Path, sandbox: Sandbox) -> Iterator[Busy]:
    with running(folder, sandbox=sandbox) as client:
        pattern = client.post("/api/v1/patterns", json=square()).json()["id"]
        folder, limits, nap = sandbox.folder(), Limits(seconds=60), {"seconds": 60}
        sleeping = [
            sandbox.submit("sandbox_probes:sleep", nap, folder=folder, limits=limits)
            for _ in range(2)
        ]
        yield client, pattern, sleeping


def test_a_plan_for_which_there_is_no_room_is_refused_at_once(busy: Busy) -> None:
    client, pattern, _ = busy
    answer = client.post("/api/v1/plans", json={"pattern": pattern, **SHEET})
    assert answer.status_code == 503, answer.text
    assert "there is no room for more. Try again in a minute." in answer.json()["detail"]
    assert answer.headers["retry-after"] == "10"
    [kept] = client.get("/api/v1/plans").json()
    assert kept["state"] == "interrupted"
    assert "there is no room for more" in kept["detail"]


@pytest.mark.parametrize("path", ["patterns", "plans/kept"])
def test_an_upload_for_which_there_is_no_room_is_refused_before_it_is_received(
    busy: Busy, path: str
) -> None:
    url = busy[0].base_url
    head = (
        f"POST /api/v1/{path} HTTP/1.1\r\nHost: {url.netloc.decode()}\r\nX-Foldmill: 1\r\n"
        "Content-Type: application/octet-stream\r\nContent-Length: 30000000\r\n\r\n"
    )
    with socket.create_connection((url.host, url.port or 80), 10) as line:
        line.sendall(head.encode())
        assert line.recv(4096).startswith(b"HTTP/1.1 503")
    assert not any(future.done() for future in busy[2])
