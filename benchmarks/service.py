"""What the service costs: submission and status beside a bare route, start-up, idle work, memory.

    python benchmarks/service.py [REQUESTS]

It starts two processes: the service, and an application of FastAPI with a route that answers a
constant of the same size. Both are asked in turn, one request after the other over one connection,
so that what else the machine does slows both. Times are medians; the ratio is of medians.

healthz     no database, no token: the floor of the service's own middleware
status      GET of a job: one row of the database
submit      POST of a job: checked, written, committed with fsync, and its first event
uploads     GET /healthz, asked by another process, while 200 fuzzed files are uploaded: median and
            slowest, ms; and how late that process itself was at most, which is the machine's doing
start-up    from the command to the first answer
idle        processor time of all its processes, %, over 10 s, with no job
memory      resident, of the process that serves, and of the nursery (most of it is shared)
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx

from foldmill import Fold
from foldmill.exchange import fold as fold_file
from foldmill_fabricate import folder, shelf
from foldmill_fabricate.client import Client
from foldmill_fabricate.jobs import Submission
from foldmill_fabricate.plan import make

BARE = """
import socket, sys, uvicorn
from fastapi import FastAPI
app = FastAPI()
SAID = {"id": "ABCDEF", "text": "x" * 350}

@app.get("/bare")
def read() -> dict: return SAID

@app.post("/bare")
def write(asked: dict) -> dict: return SAID

with socket.socket(socket.AF_INET, socket.SOCK_STREAM, socket.IPPROTO_TCP) as listening:
    listening.bind(("127.0.0.1", 0))
    print(listening.getsockname()[1], flush=True)
    config = uvicorn.Config(app, log_config=None, access_log=False)
    uvicorn.Server(config).run(sockets=[listening])
"""
PULSE = """
import json, select, sys, time, httpx
taken, late = [], []
with httpx.Client(base_url=sys.argv[1]) as client:
    while True:
        began = time.perf_counter()
        if select.select([sys.stdin], [], [], 0.01)[0]:
            break
        late.append(1000 * (time.perf_counter() - began) - 10)
        began = time.perf_counter()
        client.get("/healthz")
        taken.append(1000 * (time.perf_counter() - began))
print(json.dumps([taken, late]))
"""
"""Asks every 10 ms until its input ends: a process that makes the files could not ask in time."""
UPLOADS = 200
IDLE = 10.0


def main() -> None:
    """Print one line per figure."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    with tempfile.TemporaryDirectory() as place, bare() as floor:
        root = Path(place)
        began = time.perf_counter()
        with service(root / "state") as (url, process):
            started = time.perf_counter() - began
            latencies(url, floor, root, count)
            beside_uploads(url)
            print(f"start-up  {started:6.2f} s")
            footprint(process)


def latencies(url: str, floor: str, root: Path, count: int) -> None:
    """Print medians of the service and of the bare routes, and their ratios."""
    with Client(url) as jobs, httpx.Client(base_url=url) as own, httpx.Client() as other:
        plan = jobs.keep(job_folder(root / "job"))
        asked = Submission(plan=plan, plotter="bench").model_dump(mode="json")
        job = jobs.submit(Submission.model_validate(asked)).id
        read, write = f"{floor}/bare", f"{floor}/bare"
        pairs: dict[str, tuple[Callable[[], object], Callable[[], object]]] = {
            "healthz": (lambda: own.get("/healthz"), lambda: other.get(read)),
            "status": (lambda: own.get(f"/api/v1/jobs/{job}"), lambda: other.get(read)),
            "submit": (
                lambda: own.post("/api/v1/jobs", json=asked),
                lambda: other.post(write, json=asked),
            ),
        }
        for name, (ours, theirs) in pairs.items():
            mine, floor_ms = medians(ours, theirs, count)
            print(
                f"{name:8s}  {mine:6.2f} ms  bare {floor_ms:5.2f} ms  ratio {mine / floor_ms:5.2f}"
            )


def medians(
    ours: Callable[[], object], theirs: Callable[[], object], count: int
) -> tuple[float, float]:
    """Return the medians of two calls made in turn, ms."""
    taken: tuple[list[float], list[float]] = ([], [])
    for _ in range(count):
        for call, kept in zip((ours, theirs), taken, strict=True):
            began = time.perf_counter()
            call()
            kept.append(1000 * (time.perf_counter() - began))
    return statistics.median(taken[0]), statistics.median(taken[1])


def beside_uploads(url: str) -> None:
    """Print how soon /healthz is answered while files are uploaded that nobody should send."""
    files = [lines(k) for k in range(4)]
    headers = {"content-type": "application/octet-stream", "x-foldmill": "1"}
    command = [sys.executable, "-c", PULSE, url]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as asking:
        with httpx.Client(base_url=url, timeout=120) as client:
            for k in range(UPLOADS):
                client.post("/api/v1/patterns", content=files[k % len(files)], headers=headers)
        told, _ = asking.communicate("")
    taken, late = json.loads(told)
    print(
        f"uploads   {statistics.median(taken):6.2f} ms  slowest {max(taken):.1f} ms of {len(taken)}"
        f"  asked {max(late):.1f} ms late at worst"
    )


def lines(seed: int) -> bytes:
    """Return a file of up to 150,000 vertices, or one that is cut short."""
    count = (seed % 4 + 1) * 37_000
    text = json.dumps({"vertices_coords": [[k % 1000, k // 1000] for k in range(count)]})
    return text.encode()[: -1 if seed % 2 else None]


def footprint(process: int) -> None:
    """Print what an idle service takes (Linux)."""
    listed = subprocess.run(["pgrep", "-P", str(process)], capture_output=True, text=True)
    family = [process, *map(int, listed.stdout.split())]
    before = sum(map(processor_seconds, family))
    time.sleep(IDLE)
    after = sum(map(processor_seconds, family))
    print(f"idle      {100 * (after - before) / IDLE:6.2f} % of a processor")
    print(f"memory    {', '.join(f'{resident(each):.0f} MB' for each in family)}")


def processor_seconds(process: int) -> float:
    """Return the processor time of a process."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def resident(process: int) -> float:
    """Return the resident memory of a process, MB."""
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def square() -> Fold:
    """Return a square with a diagonal."""
    frame = {
        "frame_unit": "mm",
        "vertices_coords": [[0, 0], [100, 0], [100, 100], [0, 100]],
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
        "edges_assignment": [*"BBBBM"],
    }
    return fold_file.read(json.dumps(frame))


def job_folder(place: Path) -> Path:
    """Plan the square into a folder."""
    plan = make(square(), shelf.material("pp-0.75"), shelf.machine("generic-hpgl-600"))
    folder.write(square(), plan, place, ["hpgl"])
    return place


@contextmanager
def service(state: Path) -> Iterator[tuple[str, int]]:
    """Run the service; nobody works at its only plotter, for its port is not there."""
    words = ["serve", "--port", "0", "--state", str(state)]
    words += ["--plotter", "bench=/dev/none@generic-hpgl-600"]
    command = [sys.executable, "-m", "foldmill_fabricate", *words]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        assert process.stdout is not None
        url = process.stdout.readline().split()[-1]
        httpx.get(f"{url}/healthz")
        yield url, process.pid
        process.terminate()


@contextmanager
def bare() -> Iterator[str]:
    """Run the application that does nothing."""
    with subprocess.Popen(
        [sys.executable, "-c", BARE], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        assert process.stdout is not None
        url = f"http://127.0.0.1:{int(process.stdout.readline())}"
        while True:
            try:
                httpx.get(f"{url}/bare")
                break
            except httpx.ConnectError:
                time.sleep(0.05)
        yield url
        process.terminate()


if __name__ == "__main__":
    main()
