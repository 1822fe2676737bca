"""No request waits for what could have been done before: routes, threads, old objects."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import httpx
from services import square

_FIRST = """
import asyncio, gc, inspect, json, sys
from pathlib import Path
from foldmill_fabricate.jobs import Places
from foldmill_fabricate.service.app import create
from foldmill_fabricate.service.warming import settle, warm
from foldmill_fabricate.service.workshop import Workshop

looked, signature = [0], inspect.signature

def counting(*said, **more):
    looked[0] += 1
    return signature(*said, **more)

inspect.signature = counting
app = create(Workshop(Places(Path(sys.argv[1]), ""), works=False))

async def answer(path):
    told = []
    async def send(message): told.append(message)
    async def receive(): return {"type": "http.request", "body": b"", "more_body": False}
    scope = {"type": "http", "method": "GET", "path": path, "root_path": "", "query_string": b"",
             "headers": [(b"host", b"127.0.0.1")], "client": None, "state": {}}
    await app(scope, receive, send)
    return told[0]["status"]

async def main():
    await warm(app)
    settle()
    was = looked[0], len(sys.modules), len(gc.get_objects()), gc.get_freeze_count()
    asked = ("/healthz", "/api/v1/plotters", "/nothing")
    statuses = [await answer(path) for path in asked]
    print(json.dumps([was, [looked[0], len(sys.modules)], statuses]))

asyncio.run(main())
"""


def test_the_first_requests_build_no_route_import_nothing_and_find_few_objects(
    tmp_path: Path,
) -> None:
    said = subprocess.run(
        [sys.executable, "-c", _FIRST, str(tmp_path)], capture_output=True, text=True, check=True
    )
    (signatures, modules, objects, frozen), after, statuses = json.loads(said.stdout)
    assert signatures > 25, "one for each route, at least"
    assert after == [signatures, modules]
    assert statuses == [200, 200, 404]
    assert frozen > 50_000 > 1_000 > objects


def test_a_file_does_not_make_the_service_tell_a_million_figures_or_letters(
    service: httpx.Client,
) -> None:
    figures = {f"figure {k}": k for k in range(5000)}
    frame: dict[str, Any] = {**square(), "foldmill:designed": figures, "file_title": "x" * 100_000}
    told = service.post("/api/v1/patterns", json=frame).json()
    assert told["title"] == "x" * 300
    report = service.get(f"/api/v1/patterns/{told['id']}/check").json()
    assert len(report["figures"]) == 1000
