"""Whatever is uploaded is taken or refused with a sentence, and the service answers meanwhile."""

from __future__ import annotations

import json
import os
import shutil
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from fuzzed_uploads import HPGL, Sent, otherwise, sent
from pulse import asking
from services import said, serving
from soaking import Soak
from unhurried import of_tests

from foldmill_fabricate import shelf
from foldmill_fabricate.foreign import Asked
from foldmill_fabricate.service.desk import DRAWN, READING, WORK
from foldmill_fabricate.service.models import Upload
from foldmill_fabricate.service.sandbox import Limits, Refused, Sandbox, TooMuch

SEED, SAMPLE, WHOLE = 80_000, 16, 10_000
HTTP_SEED, HTTP_SAMPLE, HTTP_WHOLE = 70_000, 6, 200
QUICK = 0.1
"""s within which a service answers whether it works, on a machine with nothing else to do."""
_HEADERS = {"content-type": "application/octet-stream", "x-foldmill": "1"}


def test_soak_uploads_are_taken_or_refused_with_a_sentence_inside_the_limits(
    tmp_path: Path, soak: Soak
) -> None:
    count = soak.size(SAMPLE, WHOLE)
    became: Counter[tuple[str, str]] = Counter()
    with (
        soak.part("uploads", SEED, count, "uploads") as progress,
        unhurried(tmp_path) as sandbox,
    ):
        under_way: deque[_Begun] = deque()
        for k in range(progress.before, count):
            under_way.append(_begin(sandbox, SEED + k))
            while len(under_way) > (0 if k + 1 == count else sandbox.waiting):
                begun = under_way.popleft()
                became[begun.form, begun.ended()] += 1
                progress.reached(begun.seed - SEED + 1)
    assert {end for _, end in became} <= {"taken", "Refused", "TooMuch"}
    assert {form for form, end in became if end == "Refused"} >= {"fold", "svg", "dxf", HPGL}
    if soak.whole and not progress.before:
        assert {form for form, end in became if end == "taken"} >= {"fold", "svg", "dxf", HPGL}


@contextmanager
def unhurried(folder: Path) -> Iterator[Sandbox]:
    """Give a sandbox as the service has it, at the priority of these tests.

    It does more at once, so that one file that takes long does not hold up all others.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", of_tests())
        box = Sandbox(folder, [WORK, "unhurried"], at_once=2 * (os.cpu_count() or 1))
        assert box.wait_ready()
    try:
        yield box
    finally:
        box.close()


class _Begun:
    """A file that is read in the sandbox."""

    def __init__(self, seed: int, form: str, folder: Path, limits: Limits) -> None:
        self.seed, self.form, self.folder, self._limits = seed, form, folder, limits
        self.future: Future[Any] = Future()

    def ended(self) -> str:
        """Wait until it is taken or refused; return which. Its folder is thrown away."""
        try:
            self.future.result(self._limits.seconds * 4)
        except (Refused, TooMuch) as refusal:
            judge(self.seed, str(refusal))
            return type(refusal).__name__
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)
        return "taken"


def _begin(sandbox: Sandbox, seed: int) -> _Begun:
    upload, folder = sent(seed), sandbox.folder()
    (folder / "upload").write_bytes(upload.content)
    call, arguments, limits = _order(upload)
    begun = _Begun(seed, upload.form, folder, limits)
    begun.future = sandbox.submit(
        f"{WORK}:{call}", arguments, folder=folder, limits=limits, what="The file"
    )
    return begun


def _order(upload: Sent) -> tuple[str, Mapping[str, Any], Limits]:
    """Return what the service has done with an upload: the function, its arguments, its limits."""
    if upload.form == HPGL:
        asked = Asked.model_validate(upload.words)
        of, on = shelf.material(asked.material), shelf.machine(asked.machine)
        presets = {"material": of.model_dump(mode="json"), "machine": on.model_dump(mode="json")}
        return "drawn", {"asked": asked.model_dump(mode="json"), **presets}, DRAWN
    options = Upload.model_validate({"form": upload.form, **upload.words}).model_dump(mode="json")
    return "read", {"form": options.pop("form"), "options": options}, READING


def judge(seed: int, sentence: str) -> None:
    """A refusal is a sentence for people, and no fault of ours."""
    assert sentence.endswith((".", "?")), (seed, sentence)
    assert len(sentence) < 3_000, seed
    for wrong in ("Error", "Traceback", "a fault of", "/tmp", "ended by itself"):
        assert wrong not in sentence, (seed, sentence)


def test_soak_fuzzed_uploads_are_refused_with_a_sentence_while_the_service_answers(
    tmp_path: Path, soak: Soak
) -> None:
    count = soak.size(HTTP_SAMPLE, HTTP_WHOLE)
    with (
        soak.part("service-uploads", HTTP_SEED, count, "uploads") as progress,
        serving(tmp_path) as (_, url),
        httpx.Client(base_url=url, timeout=120) as client,
    ):
        with asking(url) as pulse:
            for k in range(count):
                for upload in (sent(HTTP_SEED + k), otherwise(HTTP_SEED + k)):
                    _send(client, HTTP_SEED + k, upload)
                progress.reached(k + 1)
        assert len(pulse.seconds) > count / 10
        assert pulse.failed == 0
        if soak.whole:
            assert max(pulse.seconds) < QUICK, sorted(pulse.seconds)[-9:]
        log = (tmp_path / "log").read_text()
    assert "Traceback" not in log
    assert '"level": "error"' not in log


def _send(client: httpx.Client, seed: int, upload: Sent) -> None:
    """Send one file to the route it is for."""
    is_drawing = upload.form == HPGL
    path = "/api/v1/plans/drawn" if is_drawing else "/api/v1/patterns"
    words = upload.words if is_drawing else {"form": upload.form, **upload.words}
    answer = client.post(path, content=upload.content, params=words, headers=_HEADERS)
    allowed = {201, 413, 422} if is_drawing else {201, 422}
    assert answer.status_code in allowed, (seed, answer.status_code, answer.text)
    if answer.status_code != 201:
        assert answer.headers["content-type"] == "application/problem+json"
        judge(seed, json.loads(answer.content)["detail"])


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
