"""A web page must not be able to start a cut, nor a stranger to look."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from services import running, said, square

from foldmill.errors import InvalidInput
from foldmill_fabricate.service.bounds import MOST_JSON, MOST_UPLOAD
from foldmill_fabricate.service.security import Policy
from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens

DESIGNS, PATTERNS = "/api/v1/designs", "/api/v1/patterns"
DESIGN = {"family": "rotational", "preset": "star-n6"}
JSON = {"content-type": "application/json"}


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[httpx.Client, Tokens]]:
    folder = tmp_path_factory.mktemp("guarded")
    tokens = Tokens(folder)
    tokens.new("first", Scope.VIEW)
    who = policy(folder, "0.0.0.0", (), demand=False)
    with running(folder, who) as client:
        yield client, tokens


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.1:9999", "localhost:8765", "[::1]:8765"])
def test_this_computer_is_reached_by_each_of_its_own_names(
    service: httpx.Client, host: str
) -> None:
    assert service.get("/healthz", headers={"host": host}).status_code == 200


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8765", "127.0.0.1.evil.example", "", "[", "[::1].evil"]
)
def test_a_name_that_a_stranger_made_lead_here_is_refused(service: httpx.Client, host: str) -> None:
    answer = service.get("/api/v1/patterns", headers={"host": host})
    assert answer.status_code == 421
    assert answer.headers["content-type"] == "application/problem+json"
    assert "is not reached by the name" in answer.json()["detail"]


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "http://127.0.0.1:3000", "https://localhost", "file://"],
)
@pytest.mark.parametrize("method", ["GET", "POST", "DELETE"])
def test_a_page_of_any_other_origin_is_refused(
    service: httpx.Client, method: str, origin: str
) -> None:
    answer = service.request(method, DESIGNS, json=DESIGN, headers={"origin": origin})
    assert answer.status_code == 403
    assert f"A page of {origin} may not" in answer.json()["detail"]


def test_a_page_of_our_own_origin_is_let_in(service: httpx.Client) -> None:
    answer = service.post(DESIGNS, json=DESIGN, headers={"origin": str(service.base_url)})
    assert answer.status_code == 201


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_what_a_browser_says_comes_from_another_site_changes_nothing(
    service: httpx.Client, site: str
) -> None:
    said = {"sec-fetch-site": site}
    assert service.post(DESIGNS, json=DESIGN, headers=said).status_code == 403
    assert service.get("/healthz", headers=said).status_code == 200, "a link may lead here"


@pytest.mark.parametrize(
    "kind",
    [
        "text/plain",
        "application/x-www-form-urlencoded",
        "multipart/form-data; boundary=x",
        "text/plain; application/json",
        "application/octet-stream",
        "",
    ],
)
@pytest.mark.parametrize("path", [DESIGNS, PATTERNS, "/api/v1/plans"])
def test_a_body_that_a_form_can_send_is_refused(
    service: httpx.Client, path: str, kind: str
) -> None:
    content = b'{"family": "rotational", "preset": "star-n6"}'
    answer = service.post(path, content=content, headers={"content-type": kind} if kind else {})
    assert answer.status_code == 415


def test_nobody_is_told_that_another_origin_may_ask(service: httpx.Client) -> None:
    asked = {"origin": "http://evil.example", "access-control-request-method": "POST"}
    answers = [service.options(DESIGNS, headers=asked), service.get("/healthz")]
    for answer in answers:
        assert not [name for name in answer.headers if name.startswith("access-control")]


def test_a_body_is_refused_by_its_stated_size_before_it_is_read(service: httpx.Client) -> None:
    for path, most in ((DESIGNS, MOST_JSON), (PATTERNS, MOST_UPLOAD)):
        host = f"Host: {service.base_url.netloc.decode()}"
        kind = f"Content-Type: application/json\r\nContent-Length: {most + 1}"
        status, answer = said(service, f"POST {path} HTTP/1.1\r\n{host}\r\n{kind}\r\n\r\n".encode())
        assert status == 413
        assert f"at most {most:,}".encode() in answer
    chunked = service.post(DESIGNS, content=iter([b"{", b"}"]), headers=JSON)
    assert chunked.status_code == 411


@pytest.mark.parametrize(
    "name",
    [
        "../../tokens.json",
        "..%2f..%2ftokens.json",
        "%2e%2e%2f%2e%2e%2ftokens.json",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "..\\..\\tokens.json",
        "pattern.fold%00",
    ],
)
def test_no_name_that_a_client_gives_is_a_path(service: httpx.Client, name: str) -> None:
    made = service.post(PATTERNS, json=square()).json()["id"]
    for path in (
        f"{PATTERNS}/{name}",
        f"{PATTERNS}/{made}/drawings/{name}",
        f"/api/v1/plans/{made}/files/{name}",
        f"/api/v1/materials/{name}",
        f"/api/v1/machines/{name}",
        f"/api/v1/families/{name}",
    ):
        assert service.get(path).status_code in {404, 422}, path
    wanted = {"pattern": made, "material": "pp-0.75", "machine": "generic-hpgl-600"}
    for key in ("material", "machine", "profile", "formats"):
        value = [name] if key == "formats" else name
        assert service.post("/api/v1/plans", json=wanted | {key: value}).status_code == 422


def test_parameters_name_no_file_of_this_computer(service: httpx.Client, tmp_path: Path) -> None:
    secret = tmp_path / "secret.png"
    secret.write_bytes(b"nobody may read this")
    surface = {"kind": "picture", "file": str(secret)}
    answer = service.post(DESIGNS, json={"family": "waterbomb", "params": {"surface": surface}})
    assert answer.status_code == 422


def test_another_address_is_not_served_on_without_tokens(tmp_path: Path) -> None:
    for host in ("0.0.0.0", "::", "192.168.1.5", "workshop.example"):
        with pytest.raises(InvalidInput, match="there is no token: anybody could start a cut"):
            policy(tmp_path, host, (), demand=False)
    assert policy(tmp_path, "127.0.0.1", (), demand=False).tokens is None
    with pytest.raises(InvalidInput, match="there is no token"):
        policy(tmp_path, "127.0.0.1", (), demand=True)


def test_without_a_right_token_nothing_is_told(guarded: tuple[httpx.Client, Tokens]) -> None:
    client, _ = guarded
    for headers in (
        {},
        {"authorization": "Bearer wrong"},
        {"authorization": "Basic Zmlyc3Q6Zmlyc3Q="},
        {"authorization": "Bearer"},
    ):
        for path in ("/api/v1", "/api/v1/patterns", "/metrics", "/api/v1/families"):
            answer = client.get(path, headers=headers)
            assert answer.status_code == 401, (path, headers)
            assert answer.headers["www-authenticate"].startswith("Bearer")
    assert client.get("/healthz").status_code == 200


def test_each_scope_allows_what_it_says_and_no_more(guarded: tuple[httpx.Client, Tokens]) -> None:
    client, tokens = guarded
    for scope, status in ((Scope.VIEW, 403), (Scope.SUBMIT, 201), (Scope.OPERATE, 201)):
        name = f"of-{scope}"
        headers = {"authorization": f"Bearer {tokens.new(name, scope)}"}
        about = client.get("/api/v1", headers=headers)
        assert (about.json()["scope"], about.json()["tokens"]) == (scope.value, True)
        answer = client.post(DESIGNS, json=DESIGN, headers=headers)
        assert answer.status_code == status
        if status == 403:
            assert f"'{name}' allows to view, and this needs submit" in answer.json()["detail"]


def test_a_token_that_is_revoked_counts_no_longer(guarded: tuple[httpx.Client, Tokens]) -> None:
    client, tokens = guarded
    headers = {"authorization": f"Bearer {tokens.new('short', Scope.VIEW)}"}
    assert client.get("/api/v1", headers=headers).status_code == 200
    tokens.revoke("short")
    assert client.get("/api/v1", headers=headers).status_code == 401


def test_a_token_does_not_let_a_page_of_another_site_in(
    guarded: tuple[httpx.Client, Tokens],
) -> None:
    client, tokens = guarded
    headers = {"authorization": f"Bearer {tokens.new('page', Scope.OPERATE)}"}
    for more in ({"origin": "http://evil.example"}, {"sec-fetch-site": "cross-site"}):
        assert client.post(DESIGNS, json=DESIGN, headers=headers | more).status_code == 403


def test_a_service_for_others_is_reached_by_the_names_it_was_given(tmp_path: Path) -> None:
    Tokens(tmp_path).new("one", Scope.VIEW)
    who = policy(tmp_path, "0.0.0.0", ("cutter.example",), demand=False)
    assert who.knows("cutter.example:8765")
    assert who.knows("CUTTER.example")
    assert not who.knows("evil.example")
    assert not Policy("192.168.1.5").knows("127.0.0.1")


@pytest.mark.parametrize("host", ["0.0.0.0", "::"])
def test_a_service_for_others_is_reached_where_it_says_it_is(tmp_path: Path, host: str) -> None:
    Tokens(tmp_path).new("one", Scope.VIEW)
    who = policy(tmp_path, host, ("cutter.example",), demand=False)
    assert who.knows("127.0.0.1:8765")
    assert who.knows("[::1]:8765")
    assert not who.knows("127.0.0.1.evil.example")


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("Cutter.Example", "cutter.example:8765"),
        ("cutter.example:8443", "cutter.example:8443"),
        ("cutter.example:8443", "cutter.example"),
        ("cutter.example.", "cutter.example"),
        ("cutter.example", "Cutter.Example.:80"),
        ("[FD00::1]", "[fd00::1]:8765"),
    ],
)
def test_a_name_counts_however_it_is_written(tmp_path: Path, name: str, asked: str) -> None:
    assert policy(tmp_path, "127.0.0.1", (name,), demand=False).knows(asked)


@pytest.mark.parametrize("name", ["http://cutter.example", "cutter.example/shop", "", "a b"])
def test_what_no_request_can_call_it_by_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(InvalidInput, match="give a host alone"):
        policy(tmp_path, "127.0.0.1", (name,), demand=False)
