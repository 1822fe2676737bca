"""The page of the service says what there is."""

from __future__ import annotations

import re
from pathlib import Path

import httpx

from foldmill_fabricate.service.tokens import Scope

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs/service.md").read_text(encoding="utf-8")


def test_every_figure_that_prometheus_reads_is_explained(service: httpx.Client) -> None:
    names = re.findall(r"^# TYPE (foldmill_\w+)", service.get("/metrics").text, re.MULTILINE)
    assert len(names) >= 8
    for name in names:
        if not name.endswith("_created"):
            assert f"`{name}" in PAGE, name


def test_every_last_word_of_a_route_is_on_the_page(service: httpx.Client) -> None:
    for path in service.get("/api/v1/openapi.json").json()["paths"]:
        words = [part for part in path.split("/") if part and "{" not in part]
        assert words[-1] in PAGE or path == "/api/v1", path


def test_every_scope_is_in_the_table() -> None:
    for scope in Scope:
        assert f"| {scope.value} |" in PAGE


def test_the_unit_of_systemd_names_a_command_that_there_is() -> None:
    unit = (ROOT / "examples/foldmill.service").read_text()
    command = re.search(r"^ExecStart=\S+/foldmill (.*)$", unit, re.MULTILINE)
    assert command is not None
    assert command[1].split() == ["serve", "--host", "127.0.0.1", "--port", "8765"]
    assert "KillSignal=SIGTERM" in unit
