"""Who says nothing, or hears nothing, does not keep others from being heard."""

from __future__ import annotations

import socket
import time
from pathlib import Path

import httpx
import pytest
from services import running, square

from foldmill_fabricate.service import patience

JSON = b"Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
SOON = 0.3
"""s"""


@pytest.fixture(autouse=True)
def _hurried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no test wait as long as a service does."""
    monkeypatch.setattr(patience, "HEAD", SOON)
    monkeypatch.setattr(patience, "READING", SOON)
    monkeypatch.setattr(patience, "BODY", SOON)


def connected(client: httpx.Client, begun: bytes = b"") -> socket.socket:
    line = socket.create_connection((client.base_url.host, client.base_url.port or 80), 10)
    line.sendall(begun)
    return line


def head(client: httpx.Client, path: str, method: str = "GET") -> bytes:
    host = client.base_url.netloc.decode()
    return f"{method} {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n".encode()


def trickle(line: socket.socket, letters: bytes) -> None:
    for letter in letters:
        line.sendall(bytes([letter]))
        time.sleep(SOON / 10)


@pytest.mark.parametrize("begun", [b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: 127.0.0.1"])
def test_a_connection_of_which_no_request_comes_is_closed(
    service: httpx.Client, begun: bytes
) -> None:
    with connected(service, begun) as line:
        assert line.recv(100) == b""


def test_a_head_that_comes_byte_by_byte_wins_no_time(service: httpx.Client) -> None:
    began = time.monotonic()
    with connected(service) as line, pytest.raises(OSError, match=r"Broken pipe|reset"):
        trickle(line, b"GET / HTTP/1.1\r\nX-Long: " + b"a" * 1000)
    assert time.monotonic() - began < 100 * SOON


def test_what_trickles_in_after_its_answer_wins_no_time(service: httpx.Client) -> None:
    host = service.base_url.netloc
    refused = b"POST /api/v1/nothing HTTP/1.1\r\nHost: " + host + b"\r\n" + JSON
    with connected(service, refused) as line:
        assert b"404" in line.recv(4096)
        with pytest.raises(OSError, match=r"Broken pipe|reset"):
            trickle(line, b" " * 99)


def test_a_request_under_way_is_not_cut_off(service: httpx.Client) -> None:
    followed = head(service, f"/api/v1/events?seconds={4 * SOON}") + b"\r\n"
    with connected(service, followed) as line:
        answer = b"".join(iter(lambda: line.recv(4096), b""))
    assert b"200" in answer
    assert answer.endswith(b"0\r\n\r\n"), "its stream came to its own end"


@pytest.mark.parametrize("path", ["jobs", "designs", "patterns", "plans/kept"])
def test_a_body_that_does_not_come_is_refused_with_a_sentence(
    service: httpx.Client, path: str
) -> None:
    begun = head(service, f"/api/v1/{path}", "POST") + b"X-Foldmill: 1\r\n" + JSON
    with connected(service, begun) as line:
        answer = b"".join(iter(lambda: line.recv(4096), b""))
    assert answer.startswith(b"HTTP/1.1 408")
    assert b"The body had not arrived after 0.3 s." in answer


def test_who_reads_nothing_of_a_large_file_is_let_go(tmp_path: Path) -> None:
    with running(tmp_path) as client:
        made = client.post("/api/v1/patterns", json=square()).json()["id"]
        large = tmp_path / "service" / "patterns" / made / "pattern.fold"
        large.write_bytes(b" " * (32 << 20))
        asked = head(client, f"/api/v1/patterns/{made}/pattern.fold") + b"\r\n"
        with connected(client, asked) as line:
            time.sleep(5 * SOON)
            heard = b"".join(iter(lambda: line.recv(1 << 20), b""))
        assert b"content-length: 33554432" in heard[:1000]
        assert len(heard) < 32 << 20
        assert client.get("/healthz").status_code == 200
