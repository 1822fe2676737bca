"""The examples run, each as its reader would run it."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from foldmill.registry import load
from foldmill.testing import design_checks

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(name: str, *words: str | Path) -> str:
    done = subprocess.run(
        [sys.executable, EXAMPLES / name, *words], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_sheet_is_made_in_python_and_then_submitted(tmp_path: Path) -> None:
    made = run("stool_sheet.py", tmp_path / "job")
    assert "penetrations: 0" in made
    assert "verified: True" in made
    sent = run("submit_job.py", tmp_path / "job")
    assert sent.count("executed") == 2
    assert (tmp_path / "job" / "as-cut" / "reverse.png").exists()


def test_a_family_takes_less_than_thirty_lines() -> None:
    assert len((EXAMPLES / "family_plugin.py").read_text().splitlines()) < 30


def test_the_example_family_keeps_the_contract(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLES))
    registry = load([EntryPoint("accordion", "family_plugin", "foldmill")])
    assert not registry.broken
    for check in design_checks(registry.design("accordion")):
        check()
