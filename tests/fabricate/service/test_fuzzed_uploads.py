"""Whatever is uploaded is taken or refused with a sentence, and the service answers meanwhile."""

from __future__ import annotations

from pathlib import Path

import httpx
from fuzzed_uploads import fuzzed
from pulse import asking
from services import said, serving
from soaking import Soak

SEED, SAMPLE, WHOLE = 70_000, 14, 200
QUICK = 0.1
"""s within which a service answers whether it works, on a machine with nothing else to do."""
_HEADERS = {"content-type": "application/octet-stream", "x-foldmill": "1"}


def test_soak_fuzzed_uploads_are_refused_with_a_sentence_while_the_service_answers(
    tmp_path: Path, soak: Soak
) -> None:
    count = soak.size(SAMPLE, WHOLE)
    with (
        soak.part("service-uploads", SEED, count, "uploads") as progress,
        serving(tmp_path) as (_, url),
        httpx.Client(base_url=url, timeout=120) as client,
    ):
        with asking(url) as pulse:
            for k in range(count):
                _judge(client, SEED + k)
                progress.reached(k + 1)
        assert len(pulse.seconds) > count / 10
        assert pulse.failed == 0
        if soak.whole:
            assert max(pulse.seconds) < QUICK
        log = (tmp_path / "log").read_text()
    assert "Traceback" not in log
    assert '"level": "error"' not in log


def _judge(client: httpx.Client, seed: int) -> None:
    """Send one file as it is, with its lines to be mended, and as what it may not be."""
    others = ("svg", "dxf", "cp", "opx")
    for words in ({}, {"planarise": "true"}, {"form": others[seed % 4], "width": "100"}):
        answer = client.post(
            "/api/v1/patterns", content=fuzzed(seed), params=words, headers=_HEADERS
        )
        assert answer.status_code in {201, 422}, (seed, answer.status_code, answer.text)
        if answer.status_code == 422:
            assert answer.headers["content-type"] == "application/problem+json"
            detail = answer.json()["detail"]
            assert detail.endswith((".", "?")), (seed, detail)
            assert "Error" not in detail, (seed, detail)
            assert "a fault of" not in detail, (seed, detail)


def test_ten_million_edges_are_refused_by_their_size_before_anything_is_read(
    service: httpx.Client,
) -> None:
    size = 10_000_000 * len("[1,2],")
    head = (
        f"POST /api/v1/patterns HTTP/1.1\r\nHost: {service.base_url.netloc.decode()}\r\n"
        f"Content-Type: application/json\r\nContent-Length: {size}\r\n\r\n"
    )
    status, answer = said(service, head.encode())
    assert status == 413
    assert b"60000000 bytes; at most 33,554,432 are read here" in answer
