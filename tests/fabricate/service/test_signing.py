"""Whoever says something of a job signs it: by a token, by name, or as who is at the computer."""

from __future__ import annotations

import json
from pathlib import Path

import httpx
import pytest
from command import Run
from fabricate.bench import small_job
from services import running

from foldmill_fabricate.client import Client
from foldmill_fabricate.jobs import Submission
from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens

PLOTTER = "[bench]\nport = 'sim://generic-hpgl-600'\nmachine = 'generic-hpgl-600'\n"


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return small_job(tmp_path_factory.mktemp("job")).path


@pytest.fixture
def at_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a home with a plotter to whoever is at the computer: sam."""
    for name in ("LOGNAME", "USER", "LNAME", "USERNAME"):
        monkeypatch.setenv(name, "sam")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.delenv("FOLDMILL_SERVICE", raising=False)
    named = tmp_path / "config/foldmill/plotters.toml"
    named.parent.mkdir(parents=True)
    named.write_text(PLOTTER)
    return tmp_path


def signers(foldmill: Run, planned: Path, *words: str) -> list[str]:
    """Submit, move and cancel a job at the terminal; return who its history says did each."""
    said = foldmill("job", "submit", str(planned), "--on", "bench", "--json", *words)
    assert said.code == 0, said.err
    job = json.loads(said.out)["id"]
    for verb in (("priority", job, "3"), ("pause", job), ("resume", job), ("cancel", job)):
        assert foldmill("job", *verb, *words).code == 0
    shown = json.loads(foldmill("job", "show", job, "--json").out)
    return [line["who"] for line in shown["history"]]


def test_at_a_terminal_without_a_service_the_person_there_signs_or_who_is_named(
    at_home: Path, foldmill: Run, planned: Path
) -> None:
    assert signers(foldmill, planned) == ["sam"] * 5
    assert signers(foldmill, planned, "--who", "anna") == ["anna"] * 5


def test_at_a_terminal_with_a_service_it_is_the_same(
    at_home: Path, foldmill: Run, planned: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with running(at_home / "service") as service:
        monkeypatch.setenv("FOLDMILL_SERVICE", str(service.base_url))
        assert signers(foldmill, planned) == ["sam"] * 5
        assert signers(foldmill, planned, "--who", "anna") == ["anna"] * 5


def test_a_token_signs_whatever_name_is_said_beside_it(
    at_home: Path, foldmill: Run, planned: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = at_home / "service"
    secret = Tokens(place).new("olga", Scope.OPERATE)
    with running(place, policy(place, "127.0.0.1", (), demand=True)) as service:
        monkeypatch.setenv("FOLDMILL_SERVICE", str(service.base_url))
        monkeypatch.setenv("FOLDMILL_TOKEN", secret)
        assert signers(foldmill, planned, "--who", "mallory") == ["olga"] * 5


def test_over_http_without_a_name_nobody_is_made_out_to_have_said_it(
    at_home: Path, service: httpx.Client, planned: Path
) -> None:
    """The account that the service runs under has said nothing."""
    with Client(str(service.base_url)) as client:
        plan = client.keep(planned)
        assert client.submit(Submission(plan=plan, plotter="bench")).who == "sam"
    asked = {"plan": plan, "plotter": "bench"}
    assert service.post("/api/v1/jobs", json=asked).json()["who"] == "somebody"
    named = service.post("/api/v1/jobs?who=anna", json=asked).json()
    assert named["who"] == "anna"
    service.post(f"/api/v1/jobs/{named['id']}/cancel", json={})
    history = service.get(f"/api/v1/jobs/{named['id']}/history").json()
    assert [line["who"] for line in history] == ["anna", "somebody"]
