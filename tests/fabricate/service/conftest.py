"""One service for all tests that only look at what it answers."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest
from command import Run
from services import running


@pytest.fixture
def foldmill(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Return the command."""
    return Run(capsys, monkeypatch)


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """Give a client of a service that demands no token."""
    with running(tmp_path_factory.mktemp("service")) as client:
        yield client
