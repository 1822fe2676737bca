"""Whatever is sent by the API's own description is answered as it says; never with a fault."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import httpx
import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis.core.result import Ok
from schemathesis.specs.openapi.checks import positive_data_acceptance
from services import running
from soaking import Soak

from foldmill_fabricate.service.server import policy
from foldmill_fabricate.service.tokens import Scope, Tokens

SAMPLE, WHOLE = 8, 150
"""Requests for each method of each path."""


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    folder = tmp_path_factory.mktemp("schema")
    secret = Tokens(folder).new("schema", Scope.OPERATE)
    with running(folder, policy(folder, "127.0.0.1", (), demand=True)) as client:
        client.headers["authorization"] = f"Bearer {secret}"
        yield client


def operations(service: httpx.Client) -> list[Any]:
    described = service.get("/api/v1/openapi.json").json()
    schema = schemathesis.openapi.from_dict(described)
    every = [*schema.get_all_operations()]
    found = [each.ok() for each in every if isinstance(each, Ok)]
    return [each for each in found if each.path != "/api/v1/events"]  # it goes on for an hour


def test_soak_every_answer_is_as_the_description_says(service: httpx.Client, soak: Soak) -> None:
    count = soak.size(SAMPLE, WHOLE)
    every = operations(service)
    assert len(every) >= 15
    with soak.part("service-schema", 0, count * len(every), "requests") as progress:
        for k, operation in enumerate(every):
            _try(operation, service, count)
            progress.reached((k + 1) * count)


def _try(operation: Any, service: httpx.Client, count: int) -> None:
    @given(case=operation.as_strategy())
    @settings(
        max_examples=count,
        phases=[Phase.explicit, Phase.generate],
        suppress_health_check=[*HealthCheck],
        database=None,
    )
    def judged(case: Any) -> None:
        allowed = {"Authorization": service.headers["authorization"]}
        case.call_and_validate(
            base_url=str(service.base_url).rstrip("/"),
            headers=allowed,
            # No schema says which slugs there are, or which shapes fold.
            excluded_checks=[positive_data_acceptance],
        )

    judged()
