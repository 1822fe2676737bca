"""A waterbomb drawn for Origami Simulator becomes a two-sided job in one command, and is proved."""

from __future__ import annotations

from pathlib import Path

import pytest
from command import Run

from foldmill_fabricate.passes import Plan, Role

SAMPLE = Path(__file__).parents[1] / "samples" / "os_waterbomb.svg"


def test_the_waterbomb_is_planned_in_one_command_and_verified(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    foldmill = Run(capsys, monkeypatch)
    words = ["--width", "440", "--material", "pp-0.75", "--machine", "generic-hpgl-600"]
    job = tmp_path / "job"
    told = foldmill("plan", str(SAMPLE), *words, "--to", "hpgl", "-o", str(job))
    assert told.code == 0, told.err
    plan = Plan.model_validate_json((job / "plan.json").read_bytes())
    assert "import-side" in {finding.code for finding in plan.findings}
    scored = {
        work.face: sum(
            len(operation.strokes)
            for setup in work.setups
            for operation in setup.operations
            if operation.role is Role.SCORE
        )
        for work in plan.passes
    }
    assert set(scored) == {"front", "reverse"}  # mountains on one face, valleys on the other
    assert min(scored.values()) > 100
    assert sorted(path.suffix for path in job.iterdir()) == sorted(
        [".fold", *[".hpgl"] * len(plan.programs), ".json", ".pdf"]
    )
    verdict = foldmill("verify", str(job))
    assert verdict.code == 0
    assert "246 mountains, 220 valleys" in verdict.out
