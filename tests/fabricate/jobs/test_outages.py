"""The database's server goes away under work, and under a service that has none, and comes back."""

from __future__ import annotations

import json
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import httpx
import pytest
from fabricate.jobs import postgres
from fabricate.jobs.workshop import PATIENCE, Workshop, drawn, workshop
from services import serving
from soaking import Soak

from foldmill_fabricate.jobs import JobState, Kind, Places
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.plotter.errors import LedgerFailed

pytestmark = [
    pytest.mark.long,
    postgres.NEEDED,
]
MACHINE = "generic-hpgl-600"
AWAY = "does not answer"


def test_a_server_that_goes_away_under_work_costs_no_stroke_and_no_job(
    tmp_path: Path, server: postgres.Server, database: str, soak: Soak
) -> None:
    """It is restarted at once, and is away for a while; each time a person says how it goes on."""
    with workshop(tmp_path, database=database) as shop:
        shop.start()
        for begun, seconds in ((300, 0), (900, soak.size(2, 20))):
            _cut(shop, begun)
            with server.away():
                _stands(shop, seconds)
            shop.attend(lambda: bool(_asked(shop, Kind.DECIDE)))
            (asked,) = _asked(shop, Kind.DECIDE)
            assert AWAY in asked, "the person is told why it ended early"
        shop.attend(lambda: shop.is_ended or shop.is_dead)
        assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
        shop.check_ledger()
        shop.end()
        shop.rest()
        assert shop.difference() == (Counter(), Counter()), shop.log()
        assert len(shop.at.job(shop.job).sheets) == 1
        assert shop.log().count(AWAY) < 10, shop.log()
        assert "Traceback" not in shop.log()


def _cut(shop: Workshop, bytes_: int) -> None:
    shop.attend(lambda: shop.simulator.device.traffic.begun > bytes_)


def _stands(shop: Workshop, seconds: float) -> None:
    """See the machine stand with its pen up, as long as nobody can write down what it does."""
    shop.rest()
    assert not shop.simulator.sheet.under_way
    before, end = drawn(shop.simulator), time.monotonic() + seconds
    while time.monotonic() < end:
        assert not shop.is_dead, shop.log()
        time.sleep(0.1)
    shop.rest()
    assert drawn(shop.simulator) == before, "nothing is cut without a ledger"


def _asked(shop: Workshop, kind: Kind) -> list[str]:
    with suppress(LedgerFailed):
        return [one.text for one in shop.at.questions(shop.job) if one.kind is kind]
    return []


def test_a_service_says_that_its_database_is_away_and_works_by_itself_once_it_is_back(
    tmp_path: Path,
    server: postgres.Server,
    database: str,
    job_folder: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("FOLDMILL_DATABASE", database)
    plan = Plans(Places(tmp_path).plans).keep(job_folder)
    plotter = f"bench=sim://bench?machine={MACHINE}@{MACHINE}"
    asked = {"plan": plan, "plotter": "bench"}
    words = ("--plotter", plotter, "--host-name", "here")
    with serving(tmp_path, *words) as (process, url), httpx.Client(base_url=url) as client:
        first = client.post("/api/v1/jobs", json=asked).json()["id"]
        gate = _until(lambda: _questions(client))
        events = client.stream("GET", "/api/v1/events", params={"seconds": 60})
        with events as heard:
            _refused_while_away(client, server, asked, gate["id"])
            assert _until(lambda: _questions(client)) == gate, "it waits for the same answer"
            client.post(f"/api/v1/jobs/{first}/cancel", json={}).raise_for_status()
            assert any("to be cancelled" in line for line in heard.iter_lines())
        second = client.post("/api/v1/jobs", json=asked).json()["id"]
        assert _until(lambda: _questions(client, second))["kind"] == "load"
        process.terminate()
        process.wait(30)
    log = [json.loads(line) for line in (tmp_path / "log").read_text().splitlines()]
    assert sum(AWAY in line["message"] for line in log) < 10
    assert any("begun again" in line["message"] for line in log)
    assert not any("trace" in line for line in log), log


def _refused_while_away(
    client: httpx.Client, server: postgres.Server, asked: dict[str, str], question: str
) -> None:
    with server.away():
        told = [client.get("/api/v1/jobs"), client.post("/api/v1/jobs", json=asked)]
        told += [client.post(f"/api/v1/questions/{question}/answer", json={})]
        for answer in told:
            assert answer.status_code == 503, answer.text
            assert answer.headers["retry-after"]
            assert AWAY in answer.json()["detail"]
        assert client.get("/healthz").status_code == 200
        time.sleep(1.0)


def _questions(client: httpx.Client, job: str = "") -> dict[str, str]:
    """Return the first question that is asked; nothing while there is none."""
    answer = client.get("/api/v1/questions", params={"job": job})
    found: list[dict[str, str]] = answer.json() if answer.status_code == 200 else []
    return found[0] if found else {}


def _until(look: Callable[[], dict[str, str]]) -> dict[str, str]:
    """Look until there is something."""
    end = time.monotonic() + PATIENCE
    while not (found := look()):
        assert time.monotonic() < end
        time.sleep(0.1)
    return found
