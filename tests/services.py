"""A service in this process, reached through a real port, and small patterns to send to it."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import uvicorn

from foldmill_fabricate.jobs import Places
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.service.app import create
from foldmill_fabricate.service.sandbox import Sandbox
from foldmill_fabricate.service.security import Policy
from foldmill_fabricate.service.server import configured
from foldmill_fabricate.service.workshop import Workshop


@contextmanager
def running(
    folder: Path, policy: Policy | None = None, sandbox: Sandbox | None = None
) -> Iterator[httpx.Client]:
    """Run the application on a free port of this computer and give a client of it.

    Jobs are kept there and nobody works on them: a process has one engine, and tests several
    services.
    """
    bench = Plotter(name="bench", port="sim://generic-hpgl-600", machine="generic-hpgl-600")
    workshop = Workshop(Places(folder, ""), {"bench": bench}, works=False)
    app = create(workshop, policy, sandbox)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        port = listening.getsockname()[1]
        server = uvicorn.Server(configured(app))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
        thread.start()
        while not server.started and thread.is_alive():
            time.sleep(0.01)
        try:
            with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60) as client:
                yield client
        finally:
            server.should_exit = True
            thread.join()


@contextmanager
def serving(folder: Path, *words: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Start the command on a free port and give its process and its address."""
    command = [sys.executable, "-m", "foldmill_fabricate", "serve"]
    words = words if "--port" in words else (*words, "--port", "0")
    folder.mkdir(exist_ok=True)
    with (
        (folder / "log").open("a") as log,
        subprocess.Popen(
            [*command, "--state", str(folder), *words],
            text=True,
            stdout=subprocess.PIPE,
            stderr=log,
        ) as process,
    ):
        try:
            assert process.stdout is not None
            line = process.stdout.readline()
            assert line.startswith("foldmill serves on http://"), (folder / "log").read_text()
            yield process, line.split()[-1]
        finally:
            process.kill()


def square(side: float = 100.0, assignment: str = "M") -> dict[str, Any]:
    """Return a FOLD file of a square with one diagonal."""
    return {
        "file_spec": 1.2,
        "frame_unit": "mm",
        "vertices_coords": [[0, 0], [side, 0], [side, side], [0, side]],
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
        "edges_assignment": [*"BBBB", assignment],
    }


def said(client: httpx.Client, head: bytes) -> tuple[int, bytes]:
    """Send the bytes of a request as they are; return the status and all that was answered."""
    url = client.base_url
    with socket.create_connection((url.host, url.port or 80), timeout=10) as line:
        line.sendall(head)
        line.shutdown(socket.SHUT_WR)
        answer = b"".join(iter(lambda: line.recv(65536), b""))
    return int(answer.split(b" ", 2)[1]), answer
