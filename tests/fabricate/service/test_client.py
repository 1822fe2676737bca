"""The client tells whatever goes amiss in a sentence, and never a token."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import httpx
import pytest

from foldmill.errors import FoldmillError, InvalidInput
from foldmill_fabricate.client import Client, Unreachable
from foldmill_fabricate.jobs import Reply, Submission
from foldmill_fabricate.service.answers import ServiceRefused

HEAD = b"HTTP/1.1 200 OK\r\nConnection: close\r\n\r\n"


@contextmanager
def stranger(*answers: bytes) -> Iterator[str]:
    """Give the address of something that is no service and answers these bytes, one by one."""
    with socket.create_server(("127.0.0.1", 0)) as listening:

        def speak() -> None:
            for answer in answers:
                line, _ = listening.accept()
                with line:
                    line.recv(65536)
                    line.sendall(answer)

        thread = threading.Thread(target=speak, daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{listening.getsockname()[1]}"
        thread.join(10)


@pytest.mark.parametrize(
    "url",
    ["nonsense", "http://[::1", "http://127.0.0.1:port", "ftp://x", "http://", " ", "http://é€.."],
)
def test_what_is_no_address_is_told_with_one_that_is(url: str) -> None:
    with pytest.raises(InvalidInput, match=r"is no address of a service: write it as http://127"):
        Client(url)


@pytest.mark.parametrize(
    "secret", ["foldmill_é", "foldmill_a\nb", "foldmill_\ud800", "foldmill_ x"]
)
def test_what_is_no_token_is_told_without_telling_it(secret: str) -> None:
    with pytest.raises(InvalidInput, match="This is no token") as told:
        Client("http://127.0.0.1:1", secret)
    assert "foldmill_" not in str(told.value)


def test_the_end_of_a_line_after_a_token_or_an_address_is_no_part_of_it() -> None:
    with stranger(HEAD + b'{"name":"foldmill","version":"1","tokens":true,"scope":"view"}') as url:
        assert Client(f"{url}/\n", "foldmill_abc\n").about().scope == "view"


@pytest.mark.parametrize(
    "name", ["", ".", "..", "a\nb", "\ud800", "../jobs", "x?y", "é", "a" * 9999]
)
@pytest.mark.parametrize(
    "verb",
    [Client.pattern, Client.check, Client.plan_status, Client.job, Client.cancel, Client.family],
)
def test_no_id_leads_to_another_route_or_ends_without_a_sentence(
    service: httpx.Client, verb: Callable[[Client, str], object], name: str
) -> None:
    with Client(str(service.base_url)) as client, pytest.raises(FoldmillError) as told:
        verb(client, name)
    assert str(told.value).endswith(".")
    assert "of the same version" not in str(told.value), "it was answered by another route"


def test_what_is_no_text_is_not_sent(service: httpx.Client) -> None:
    with Client(str(service.base_url)) as client:
        with pytest.raises(InvalidInput, match="UTF-8"):
            client.submit(Submission(plotter="bench"), who="\ud800")
        with pytest.raises(InvalidInput, match="UTF-8"):
            client.answer("\ud800", Reply())


@pytest.mark.parametrize(
    ("answer", "error", "words"),
    [
        (b"SSH-2.0-OpenSSH\r\n\r\n", Unreachable, "does not answer"),
        (b"HTTP/1.1 500 X\r\nContent-Length: 0\r\n\r\n", ServiceRefused, "answers 500"),
        (b"HTTP/1.1 302 X\r\nLocation: /x\r\nContent-Length: 0\r\n\r\n", ServiceRefused, "302"),
        (b"HTTP/1.1 200 X\r\nContent-Length: 9\r\n\r\n[", Unreachable, "does not answer"),
        (HEAD + b"[]", ServiceRefused, "does not understand"),
        (HEAD + b"<html>", ServiceRefused, "does not understand"),
        (HEAD + b"\xff\xfe", ServiceRefused, "does not understand"),
    ],
)
def test_who_answers_that_is_no_service_is_told_of(
    answer: bytes, error: type[FoldmillError], words: str
) -> None:
    with stranger(answer) as url, pytest.raises(error, match=words):
        Client(url, seconds=5).about()


@pytest.mark.parametrize(
    "said",
    [b"event: job\ndata: {}\n\n", b"event: job\ndata: [\n\n", b"event: progress\ndata: {\n\n"],
)
def test_events_of_another_version_are_told_as_that(said: bytes) -> None:
    with stranger(HEAD + said) as url, pytest.raises(ServiceRefused, match="does not understand"):
        next(Client(url).follow())
