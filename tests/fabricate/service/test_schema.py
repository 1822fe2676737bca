"""Whatever is sent by the API's own description is answered as it says; never with a fault.

Schemathesis sends it, as a process of its own: what fits the description, what does not fit it in
one place, each limit, methods that are not for a path, requests without the token or with a wrong
one, and chains of requests where one uses what another answered.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import httpx
import pytest
from pydantic import BaseModel
from services import running
from soaking import Soak

from foldmill_fabricate.jobs import Reply, Rest, Submission
from foldmill_fabricate.service.logs import PREFIX
from foldmill_fabricate.service.models import DesignRequest, PlanRequest, Priority
from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens

SEED = 20261122
SAMPLE, WHOLE = 1, 25
"""Requests of each kind for each method of each path."""
PHASES = "examples,coverage,fuzzing,stateful"
OFF = ("positive_data_acceptance",)
"""No schema says which slugs and ids there are, or which shapes fold: what fits it may be refused.
All other checks are on."""
SETTINGS = """
[checks.missing_required_header]
expected-statuses = [401, 415, 422]  # 415: without X-Foldmill an upload is a form's body

[[operations]]
include-path = "/api/v1/events"
parameters = { "query.seconds" = 0.1 }  # else it goes on for an hour
"""


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[httpx.Client, Tokens]]:
    folder = tmp_path_factory.mktemp("schema")
    tokens = Tokens(folder)
    tokens.new("first", Scope.VIEW)
    with running(folder, policy(folder, "127.0.0.1", (), demand=True)) as client:
        yield client, tokens


def sent(client: httpx.Client, token: str, place: Path, phases: str, count: int) -> str:
    """Send what the description calls for; return what was found, as told for people."""
    settings = place / "schemathesis.toml"
    settings.write_text(SETTINGS)
    url = str(client.base_url).rstrip("/")
    words = ["run", f"{url}{PREFIX}/openapi.json", "--phases", phases, "-n", str(count)]
    words += ["--seed", str(SEED), "--exclude-checks", ",".join(OFF), "--warnings", "off"]
    words += ["--suppress-health-check", "all", "--no-shrink", "--continue-on-failure"]
    words += ["-H", f"Authorization: Bearer {token}"] if token else []
    command = [sys.executable, "-m", "schemathesis.cli", "--config-file", str(settings), *words]
    return _ran(command, place)


def _ran(command: Sequence[str], place: Path) -> str:
    done = subprocess.run(command, cwd=place, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-6000:] + done.stderr[-2000:]
    return done.stdout


def test_soak_every_answer_is_as_the_description_says(
    service: tuple[httpx.Client, Tokens], soak: Soak, tmp_path: Path
) -> None:
    client, tokens = service
    if not soak.whole:
        told = sent(client, tokens.new("sample", Scope.OPERATE), tmp_path, "fuzzing", SAMPLE)
        assert _count(told, r"Tested: (\d+)") >= 35
        return
    secrets = ["", *(tokens.new(f"soak-{scope}", scope) for scope in Scope)]
    with soak.part("service-schema", SEED, len(secrets) * WHOLE, "for each route") as progress:
        for k, secret in enumerate(secrets):
            told = sent(client, secret, tmp_path, PHASES, WHOLE)
            assert _count(told, r"Tested: (\d+)") >= 35
            progress.reached((k + 1) * WHOLE)


def _count(told: str, form: str) -> int:
    found = re.search(form, told)
    assert found is not None, told[-2000:]
    return int(found[1])


def test_a_method_that_is_not_for_a_path_is_told_which_are(
    service: tuple[httpx.Client, Tokens],
) -> None:
    client, _ = service
    described = client.get(f"{PREFIX}/openapi.json").json()["paths"]
    assert len(described) >= 35
    for path, methods in described.items():
        there = re.sub(r"\{\w+\}", "a", path.replace("{face}", "front"))
        allowed = ", ".join(sorted(method.upper() for method in methods))
        for method in ("TRACE", "DELETE", "OPTIONS"):
            answer = client.request(method, there)
            assert (answer.status_code, answer.headers["allow"]) == (405, allowed), (method, path)


def test_an_upload_says_in_the_description_that_it_needs_our_header(
    service: tuple[httpx.Client, Tokens],
) -> None:
    client, _ = service
    described = client.get(f"{PREFIX}/openapi.json").json()["paths"]
    for path, required in ((f"{PREFIX}/plans/kept", True), (f"{PREFIX}/patterns", False)):
        parameters = described[path]["post"]["parameters"]
        [header] = [each for each in parameters if each["name"].lower() == "x-foldmill"]
        assert (header["in"], header["required"]) == ("header", required)


def test_whatever_may_be_sent_is_described_and_shown(
    service: tuple[httpx.Client, Tokens],
) -> None:
    client, _ = service
    whole = client.get(f"{PREFIX}/openapi.json").json()
    schemas, shown = whole["components"]["schemas"], set()
    for path, methods in whole["paths"].items():
        body = methods.get("post", {}).get("requestBody", {}).get("content", {})
        name = body.get("application/json", {}).get("schema", {}).get("$ref", "").split("/")[-1]
        if name and schemas[name].get("properties"):
            shown.add(name)
            assert schemas[name].get("examples"), (path, name)
    assert {"DesignRequest", "PlanRequest", "Submission", "Reply", "Rest"} <= shown
    for name in {*shown, "Order", "PlanOptions"}:
        bare = [field for field, one in schemas[name]["properties"].items() if _is_bare(one)]
        assert not bare, f"{name}: {bare}"


@pytest.mark.parametrize("model", [DesignRequest, PlanRequest, Submission, Reply, Rest, Priority])
def test_what_is_shown_is_taken(model: type[BaseModel]) -> None:
    for body in model.model_json_schema()["examples"]:
        assert model.model_validate_json(json.dumps(body)).model_dump(exclude_unset=True)


def _is_bare(field: dict[str, Any]) -> bool:
    return not field.get("description")
