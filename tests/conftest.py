"""Shared test options: golden files, and skips that CI forbids."""

from __future__ import annotations

import os
import zlib
from difflib import unified_diff
from pathlib import Path

import pytest
from hypothesis import settings
from soaking import Soak, head

from foldmill_fabricate.garbage import look_rarely

# No test is timed, on whatever machine it runs; and a test that fails, fails for everybody.
settings.register_profile("foldmill", deadline=None, derandomize=True)
settings.load_profile("foldmill")
look_rarely()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-goldens", action="store_true", help="rewrite golden files")
    parser.addoption("--soak", action="store_true", help="run long suites whole")


SAMPLE, WHOLE = 4, 3000
"""Of long tests one in so many is run, where so many tests are collected that it is all of them."""


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out long tests but for a sample that the commit chooses: others at the next one."""
    commit = head()
    wants_all = config.getoption("--soak") or config.getoption("--update-goldens") or not commit
    if wants_all or len(items) < WHOLE:
        return
    left = [
        item
        for item in items
        if item.get_closest_marker("long")
        and zlib.crc32(f"{commit} {item.nodeid}".encode()) % SAMPLE
    ]
    config.hook.pytest_deselected(items=left)
    out = {id(item) for item in left}
    items[:] = [item for item in items if id(item) not in out]


@pytest.fixture(autouse=True, scope="session")
def _own_ledger(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Keep what tests send out of the ledger of whoever runs them."""
    os.environ["XDG_STATE_HOME"] = str(tmp_path_factory.mktemp("state"))


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Golden:
    return Golden(bool(request.config.getoption("--update-goldens")))


@pytest.fixture
def soak(request: pytest.FixtureRequest) -> Soak:
    return Soak(bool(request.config.getoption("--soak")))


class Golden:
    """Compare bytes with a file beside the tests; one flag rewrites it."""

    folder = Path(__file__).parent / "goldens"

    def __init__(self, update: bool) -> None:
        self.update = update

    def check(self, name: str, content: bytes) -> None:
        path = self.folder / name
        if self.update:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        assert path.exists(), f"no golden {name}: run `make goldens` and look at it"
        difference = unified_diff(
            path.read_text("utf-8").splitlines(), content.decode().splitlines(), "golden", "now"
        )
        assert content == path.read_bytes(), f"{name} is another:\n" + "\n".join(difference)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    skipped = reporter.stats.get("skipped", []) if reporter else []
    if skipped and os.environ.get("FOLDMILL_FORBID_SKIPS"):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
