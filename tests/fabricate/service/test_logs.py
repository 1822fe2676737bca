"""A line of the log is one object, whatever a stranger sends, and holds no secret."""

from __future__ import annotations

import io
import json
import logging
import socket
from pathlib import Path
from urllib.parse import quote

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from services import serving

from foldmill_fabricate.service.logs import JsonLines
from foldmill_fabricate.service.tokens import Scope, Tokens

JSON = {"content-type": "application/json"}


def line(message: str, **more: object) -> str:
    record = logging.makeLogRecord({"name": "test", "msg": "%s", "args": (message,), **more})
    return JsonLines().format(record)


@given(st.text(st.characters(exclude_categories=()), max_size=60))
def test_whatever_is_logged_is_one_line_that_no_terminal_obeys(message: str) -> None:
    told = line(message, path=message)
    assert len(told.splitlines()) == 1
    assert not any(ord(each) < 32 or 127 <= ord(each) < 160 for each in told)
    told.encode()
    again = json.loads(told)
    halves = [each.encode("utf-16", "surrogatepass") for each in (again["message"], message)]
    assert halves[0] == halves[1]
    assert again["path"] == again["message"]


@pytest.mark.parametrize("around", ["{}", "Bearer {}", "/api/v1/{}/x", "?token={}&a=1", "\n{}\r"])
def test_a_token_is_left_out_wherever_it_stands(around: str, tmp_path: Path) -> None:
    secret = Tokens(tmp_path).new("anna", Scope.VIEW)
    try:
        raise ValueError(around.format(secret))
    except ValueError as error:
        trace = (type(error), error, error.__traceback__)
    for told in (
        line(around.format(secret)),
        line("x", path=around.format(secret), detail=[{secret: secret}]),
        line("x", exc_info=trace),
        line(around.format(secret[:40])),
    ):
        assert secret[9:30] not in told
        assert "foldmill_…" in told
        json.loads(told)


def test_names_of_our_own_are_no_tokens() -> None:
    said = "foldmill_fabricate.service.logs, foldmill_jobs, foldmill_set_up_time_share"
    assert json.loads(line(said))["message"] == said


def test_what_strangers_send_leaves_no_secret_and_no_line_of_its_own_in_the_log(
    tmp_path: Path,
) -> None:
    secret = Tokens(tmp_path).new("anna", Scope.OPERATE)
    forged = '\n{"level": "info", "message": "forged"}\r\n'
    key = "key-that-nobody-may-read"
    with serving(tmp_path, "--demand-tokens") as (_, url), httpx.Client(base_url=url) as client:
        wrong = (f"Bearer x{secret}", f"Basic {secret}", secret, f"Bearer {secret} {secret}")
        for said in wrong:
            assert client.get("/api/v1", headers={"authorization": said}).status_code == 401
        client.headers["authorization"] = f"Bearer {secret}"
        for path in (f"/api/v1/{secret}", f"/api/v1?token={secret}", f"/{quote(forged)}"):
            client.get(path)
        client.get("/api/v1/plans", headers={"host": "evil.example", "origin": secret})
        order = {"plan": "0" * 64, "plotter": "bench", "key": key}
        client.post("/api/v1/jobs", json=order)
        client.post("/api/v1/jobs", content=b"{" + key.encode(), headers=JSON)
        _send(client, f"GET /{forged} HTTP/1.1\r\n\r\n".encode())
        _send(
            client, b"GET / HTTP/1.1\r\nHost: x\r\nAuthorization: " + secret.encode() + b"\x00\r\n"
        )
    lines = (tmp_path / "log").read_text().split("\n")[:-1]
    told = [json.loads(each) for each in lines]
    assert {"time", "level", "logger", "message"} <= set.intersection(*({*row} for row in told))
    requests = [row for row in told if row["logger"] == "foldmill.access"]
    assert len(requests) == len(wrong) + 6
    assert not [row for row in told if row["logger"] == "uvicorn.access"]
    assert not [row for row in told if row["message"] == "forged"]
    text = "\n".join(lines)
    assert secret[9:] not in text
    assert key not in text
    assert "Traceback" not in text


def _send(client: httpx.Client, content: bytes) -> None:
    url = client.base_url
    with socket.create_connection((url.host, url.port or 80), timeout=10) as wire:
        wire.sendall(content)
        wire.shutdown(socket.SHUT_WR)
        with io.BytesIO() as answer:
            while part := wire.recv(65536):
                answer.write(part)
