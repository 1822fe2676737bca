"""``foldmill serve`` as a process: found when it runs, gone when it is told to go."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx
import pytest
from services import serving, square

from foldmill_fabricate.jobs import Places
from foldmill_fabricate.plotter.errors import PortUnavailable
from foldmill_fabricate.service.reach import reached
from foldmill_fabricate.service.security import Policy
from foldmill_fabricate.service.server import serve
from foldmill_fabricate.service.tokens import Scope, Tokens
from foldmill_fabricate.service.workshop import Workshop


def test_it_says_where_it_is_and_ends_within_seconds_when_told(tmp_path: Path) -> None:
    with serving(tmp_path, "--plotter", "bench=sim://generic-hpgl-600") as (process, url):
        assert process.stdout is not None
        assert process.stdout.readline() == "plotters: bench\n"
        assert reached(Places(tmp_path, "")) == url
        with pytest.raises(PortUnavailable, match=f"A service runs in {tmp_path} already .{url}."):
            serve(Workshop(Places(tmp_path, ""), works=False), Policy(), 0)
        with httpx.Client(base_url=url) as client:
            client.post("/api/v1/patterns", json=square())
            client.post("/api/v1/designs", json={"family": "waterbomb"}, timeout=30)
        children = subprocess.run(
            ["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=True
        )
        process.send_signal(signal.SIGTERM)
        began = time.monotonic()
        process.wait(10)
        assert time.monotonic() - began < 5
        assert reached(Places(tmp_path, "")) is None
        for child in children.stdout.split():
            with pytest.raises(ProcessLookupError):
                os.kill(int(child), 0)
    lines = [json.loads(line) for line in (tmp_path / "log").read_text().splitlines()]
    assert {"time", "level", "logger", "message"} <= {*lines[0]}
    posted = next(line for line in lines if line.get("path") == "/api/v1/patterns")
    assert (posted["method"], posted["status"]) == ("POST", 201)


def grid(side: int, title: str) -> dict[str, Any]:
    """Return a FOLD file that takes its time: squares of a pattern that cannot fold."""
    places = [(k % side, k // side) for k in range(side * side)]
    across = [(k, k + 1) for k, (x, _) in enumerate(places) if x < side - 1]
    edges = across + [(k, k + side) for k, (_, y) in enumerate(places) if y < side - 1]
    rims = (0, side - 1)
    assignment = [
        "B" if any(places[a][axis] == places[b][axis] in rims for axis in (0, 1)) else "M"
        for a, b in edges
    ]
    return square() | {
        "frame_title": title,
        "vertices_coords": places,
        "edges_vertices": edges,
        "edges_assignment": assignment,
    }


def test_whoever_waits_when_it_ends_is_told_to_come_again(tmp_path: Path) -> None:
    with serving(tmp_path) as (process, url), ThreadPoolExecutor(8) as several:

        def upload(number: int) -> httpx.Response:
            pattern = grid(90, f"{number}")
            return httpx.post(f"{url}/api/v1/patterns", json=pattern, timeout=60)

        answers = [several.submit(upload, number) for number in range(8)]
        while httpx.get(f"{url}/healthz").json()["waiting"] < 6:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        told = [answer.result() for answer in answers]
    refused = [answer for answer in told if answer.status_code != 201]
    assert len(refused) > 3
    for answer in refused:
        assert answer.status_code == 503
        assert answer.json()["detail"].startswith("The service is ending")


def test_a_token_is_never_logged(tmp_path: Path) -> None:
    secret = Tokens(tmp_path).new("anna", Scope.SUBMIT)
    with serving(tmp_path, "--demand-tokens") as (_, url):
        assert httpx.get(f"{url}/api/v1").status_code == 401
        for path in ("/api/v1", f"/api/v1/patterns?token={secret}", "/api/v1/nothing"):
            httpx.get(f"{url}{path}", headers={"authorization": f"Bearer {secret}"})
        told = httpx.get(f"{url}/api/v1", headers={"authorization": f"Bearer {secret}"})
        assert told.json()["scope"] == "submit"
    log = (tmp_path / "log").read_text()
    assert '"who": "anna"' in log
    assert secret not in log
    assert "Traceback" not in log


def test_what_a_power_cut_has_left_is_no_service_whoever_has_its_number_now(
    tmp_path: Path,
) -> None:
    places = Places(tmp_path, "")
    with socket.create_server(("127.0.0.1", 0)) as listening:
        url = f"http://127.0.0.1:{listening.getsockname()[1]}"
        places.service.write_text(json.dumps({"url": url, "pid": os.getpid()}))
        assert reached(places) == url
    assert reached(places) is None
