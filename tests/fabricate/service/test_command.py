"""``foldmill serve`` and ``foldmill job`` at a terminal, one with the other."""

from __future__ import annotations

from pathlib import Path

import httpx
import pytest
from command import Run
from services import running

from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens


def test_a_token_is_told_once_listed_by_name_and_revoked(foldmill: Run, tmp_path: Path) -> None:
    state = ("serve", "--state", str(tmp_path))
    secret = foldmill(*state, "--new-token", "anna", "--scope", "submit").out.strip()
    found = Tokens(tmp_path).find(secret)
    assert found is not None
    assert (found.name, found.scope) == ("anna", Scope.SUBMIT)
    listed = foldmill(*state, "--list-tokens").out
    assert listed == "anna  submit\n"
    assert foldmill(*state, "--revoke-token", "anna").code == 0
    assert foldmill(*state, "--list-tokens").out == ""
    assert foldmill(*state, "--revoke-token", "anna").code == 2


@pytest.mark.parametrize("words", [("--host", "0.0.0.0"), ("--demand-tokens",)])
def test_a_service_that_demands_tokens_does_not_start_without_one(
    foldmill: Run, tmp_path: Path, words: tuple[str, ...]
) -> None:
    told = foldmill("serve", "--port", "0", "--state", str(tmp_path), *words)
    assert told.code == 2
    assert "anybody could start a cut" in told.err
    assert "--new-token" in told.err


def test_jobs_are_spoken_of_with_the_service_that_the_environment_names(
    foldmill: Run, service: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FOLDMILL_SERVICE", str(service.base_url))
    order = ("job", "submit", "tuck", "--preset", "stool-n8", "--on", "bench", "--json")
    told = foldmill(*order)
    assert told.code == 0, told.err
    name = httpx.Response(200, text=told.out).json()["id"]
    assert service.get(f"/api/v1/jobs/{name}").json()["title"] == "tuck stool-n8"
    assert foldmill("job", "cancel", name).code == 0
    assert service.get(f"/api/v1/jobs/{name}").json()["state"] == "cancelled"
    refused = foldmill("job", "submit", "tuck", "--on", "lathe")
    assert refused.code == 2
    assert "There is no plotter 'lathe'. There are: bench." in refused.err


def test_a_service_elsewhere_that_wants_a_token_says_so(
    foldmill: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    secret = Tokens(tmp_path).new("anna", Scope.VIEW)
    with running(tmp_path, policy(tmp_path, "127.0.0.1", (), demand=True)) as client:
        monkeypatch.setenv("FOLDMILL_SERVICE", str(client.base_url))
        told = foldmill("job", "list")
        assert told.code == 2
        assert "wants a token" in told.err
        monkeypatch.setenv("FOLDMILL_TOKEN", secret)
        assert foldmill("job", "list").out == "No job is under way.\n"
    gone = foldmill("job", "list")
    assert gone.code == 2
    assert "Does foldmill serve run?" in gone.err
