"""Nobody who follows misses an event or hears one twice, however many do, and however slowly."""

from __future__ import annotations

import json
import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from services import running, serving
from sqlalchemy import create_engine, insert

from foldmill_fabricate.jobs import JobState, Places
from foldmill_fabricate.jobs.tables import EVENTS
from foldmill_fabricate.service.answers import events
from foldmill_fabricate.service.events import MOST
from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens

PATIENCE = 180.0
ROUTE = "/api/v1/events"


def happen(folder: Path, count: int, words: str = "") -> None:
    """Have so many events stand in the database of a service, in one go."""
    row = {"when": "now", "job": "ABCDEF", "who": "anna", "state": JobState.SUBMITTED.value}
    engine = create_engine(f"sqlite:///{Places(folder, '').ledger}")
    with engine.begin() as at:
        at.execute(insert(EVENTS), [{**row, "what": f"{k} {words}"} for k in range(count)])
    engine.dispose()


def until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not true():
        assert time.monotonic() < end
        time.sleep(0.02)


class Listener:
    """A connection that follows, over a bare socket that reads only when it is told to."""

    def __init__(self, url: httpx.URL, heard: int = 0) -> None:
        self.wire = socket.socket()
        self.wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self.wire.settimeout(PATIENCE)
        self.wire.connect((url.host, url.port or 80))
        head = f"GET {ROUTE} HTTP/1.1\r\nHost: {url.netloc.decode()}\r\nLast-Event-ID: {heard}"
        self.wire.sendall(f"{head}\r\n\r\n".encode())
        self.text = bytearray()

    def read_until(self, number: int) -> None:
        """Read up to an event."""
        wanted = f"id: {number}\n".encode()
        looked = 0
        while self.text.find(wanted, looked) < 0:
            looked = max(0, len(self.text) - len(wanted))
            part = self.wire.recv(1 << 16)
            assert part, self.text[-300:]
            self.text += part

    @property
    def numbers(self) -> list[int]:
        """Those of the events that were heard."""
        lines = bytes(self.text).split(b"\n")
        return [int(line[4:]) for line in lines if line.startswith(b"id: ")]


@pytest.fixture
def place(tmp_path: Path) -> Path:
    return tmp_path / "state"


@pytest.fixture
def client(place: Path) -> Iterator[httpx.Client]:
    with running(place) as found:
        happen(place, 5)
        yield found


def heard(client: httpx.Client, said: str | None, **asked: int) -> list[int]:
    headers = {} if said is None else {"last-event-id": said}
    answer = client.get(ROUTE, params={"seconds": 0, **asked}, headers=headers)
    assert answer.status_code == 200, answer.text
    told = [data for kind, data in events(answer.text.splitlines()) if kind == "job"]
    return [json.loads(data)["number"] for data in told]


def test_what_was_heard_last_is_any_number_there_has_been(client: httpx.Client) -> None:
    assert heard(client, None) == heard(client, "") == heard(client, "0") == [1, 2, 3, 4, 5]
    assert (
        heard(client, "003")
        == heard(client, "3", after=1)
        == heard(client, None, after=3)
        == [4, 5]
    )
    assert heard(client, "5") == []


@pytest.mark.parametrize("said", ["6", "999999999999999999"])
def test_an_event_that_is_still_to_come_was_heard_elsewhere(
    said: str, client: httpx.Client
) -> None:
    answer = client.get(ROUTE, params={"seconds": 0}, headers={"last-event-id": said})
    assert answer.status_code == 404
    assert f"There is no event {said} here; the last is 5." in answer.json()["detail"]


@pytest.mark.parametrize("said", ["-1", "one", "1.5", "1,2", "9" * 19, "0x1", "٣"])
def test_what_is_no_number_is_refused_with_a_sentence(said: str, client: httpx.Client) -> None:
    headers = {b"last-event-id": said.encode()}
    answer = client.get(ROUTE, params={"seconds": 0}, headers=headers)
    assert answer.status_code == 422
    assert "last-event-id" in answer.json()["detail"]


def test_as_many_follow_as_there_is_room_for_and_leave_nothing_behind(
    client: httpx.Client, place: Path
) -> None:
    handles = Path(f"/proc/{os.getpid()}/fd")
    before = len(list(handles.iterdir()))
    for last in (8, 11):
        listeners = [Listener(client.base_url) for _ in range(MOST)]
        for each in listeners:
            each.read_until(last - 3)
        assert client.get(ROUTE, params={"seconds": 0}).status_code == 503
        assert client.get("/healthz").status_code == 200
        happen(place, 3)
        for each in listeners:
            each.read_until(last)
            assert each.numbers == [*range(1, last + 1)]
            each.wire.close()
        until(lambda: client.get(ROUTE, params={"seconds": 0}).status_code == 200)
    until(lambda: len(list(handles.iterdir())) <= before + 12)  # threads keep the database open


def test_who_reads_slowly_hears_everything_and_takes_no_memory_meanwhile(place: Path) -> None:
    count, words = 4000, "x" * 4000
    with serving(place) as (process, url), httpx.Client(base_url=url) as client:
        happen(place, count, words)
        client.get("/healthz")
        before = _resident(process.pid)
        slow = [Listener(client.base_url) for _ in range(6)]
        time.sleep(2)  # as much as the service would read ahead, it has by now
        grown = _resident(process.pid) - before
        slow[0].read_until(count)
        assert slow[0].numbers == [*range(1, count + 1)]
        for each in slow:
            each.wire.close()
        assert grown < 0.3 * len(slow) * count * len(words)
        assert client.get("/healthz").status_code == 200


def _resident(process: int) -> int:
    """Return the resident memory of a process, bytes."""
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def test_a_token_that_is_revoked_hears_nothing_more(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("foldmill_fabricate.service.events.ASK", 0.2)
    tokens = Tokens(place)
    for name in ("anna", "ben"):
        tokens.new(name, Scope.VIEW)
    tokens.revoke("anna")
    anna = {"authorization": f"Bearer {tokens.new('anna', Scope.VIEW)}"}
    with running(place, policy(place, "127.0.0.1", (), demand=True)) as client:
        with client.stream("GET", f"{ROUTE}?seconds=600", headers=anna) as answer:
            lines = answer.iter_lines()
            assert next(lines) == ": following"
            tokens.revoke("anna")
            assert tokens.new("anna", Scope.OPERATE), "the name is another's now"
            for _ in lines:
                pass  # to the end
        assert client.get(ROUTE, headers=anna).status_code == 401


def test_a_service_that_ended_and_was_started_again_goes_on_where_it_was(place: Path) -> None:
    with running(place) as client:
        happen(place, 3)
        before = Listener(client.base_url)
        before.read_until(3)
    rest = before.wire.recv(1 << 16)
    assert b"id:" not in rest, "it is let go, and told nothing more"
    before.wire.close()
    happen(place, 2)
    with running(place) as client:
        after = Listener(client.base_url, before.numbers[-1])
        after.read_until(5)
        happen(place, 1)
        after.read_until(6)
        after.wire.close()
    assert before.numbers + after.numbers == [1, 2, 3, 4, 5, 6]


def test_followers_come_and_go_while_much_happens_and_each_hears_all_once(
    client: httpx.Client, place: Path
) -> None:
    total = 5 + 40 * 3
    over = threading.Event()

    def follow(seed: int) -> list[int]:
        numbers: list[int] = []
        while not numbers or numbers[-1] < total:
            numbers += _some(client.base_url, numbers[-1] if numbers else 0, 0.05 + seed % 5 / 10)
        return numbers

    with ThreadPoolExecutor(9) as several:
        found = [several.submit(follow, seed) for seed in range(8)]
        for _ in range(40):
            happen(place, 3)
            over.wait(0.03)
        assert all(each.result(PATIENCE) == [*range(1, total + 1)] for each in found)


def _some(url: httpx.URL, heard_last: int, seconds: float) -> list[int]:
    headers = {"last-event-id": str(heard_last)}
    answer = httpx.get(url.join(ROUTE), params={"seconds": seconds}, headers=headers, timeout=30)
    told = [data for kind, data in events(answer.text.splitlines()) if kind == "job"]
    return [json.loads(data)["number"] for data in told]
