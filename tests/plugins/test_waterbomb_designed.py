"""Verdict, distance and convergence travel with the file of a waterbomb tessellation."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from command import Run
from waterbomb_targets import NARROW

from foldmill.exchange import read, write
from foldmill_plugins.waterbomb import DESIGN


@pytest.mark.parametrize("name", ["catenoid", "torus", "moebius"])
def test_a_file_says_how_its_form_came_out(name: str) -> None:
    fold = DESIGN.run(DESIGN.presets[name])
    said = read(write(fold)).meta["designed"]
    assert said["verdict"] == "ok"
    assert said["iterations"] == fold.meta["convergence"]["iterations"]
    assert said["distance_mean"] == pytest.approx(fold.meta["distance"]["mean"], rel=5e-3)
    assert said["distance_largest"] == pytest.approx(fold.meta["distance"]["largest"], rel=5e-3)
    assert 0 <= said["e_total_deg"] <= 1e-10
    assert (said["start"], said["depth"]) == (fold.meta["start"], fold.meta["depth"])


def test_a_file_never_says_ok_of_what_is_not() -> None:
    assert DESIGN.run(NARROW).meta["designed"]["verdict"] == "self-intersecting"
    part = DESIGN.run({**NARROW, "pieces": {"columns": 2, "notch": 0}})
    assert part.meta["designed"]["verdict"] == part.meta["status"]["verdicts"][0] != "ok"


def test_a_check_of_the_file_tells_it_as_designed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "form.fold"
    file.write_text(write(DESIGN.run(DESIGN.presets["catenoid-8x6"])), encoding="utf-8")
    run = Run(capsys, monkeypatch)
    text, data = run("check", str(file)), run("check", str(file), "--json")
    assert (text.code, data.code) == (0, 0)
    assert "designed verdict" in text.out
    figures: dict[str, Any] = json.loads(data.out)["figures"]
    assert figures["designed_verdict"] == "ok"
    assert figures["designed_start"] == "closed-form"
