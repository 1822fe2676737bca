"""A drawing of crossing lines is planned once the user asks for it, and told how it was mended."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command import Run

from foldmill_fabricate.passes import Plan, Role

DRAWING = {
    "frame_unit": "mm",
    "vertices_coords": [[0, 0], [200, 0], [200, 200], [0, 200]],
    "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]],
    "edges_assignment": ["B", "B", "B", "B", "M", "M"],
}


@pytest.fixture
def drawing(foldmill: Run) -> str:
    assert foldmill is not None  # it has gone into the empty folder
    Path("cross.fold").write_text(json.dumps(DRAWING), encoding="utf-8")
    return "cross.fold"


def test_crossing_lines_are_refused_with_the_option_that_mends_them(
    foldmill: Run, drawing: str
) -> None:
    for words in (("check", drawing), ("plan", drawing, "-o", "job")):
        code, _, err = foldmill(*words)
        assert code == 2
        assert "--planarise" in err
    assert not Path("job").exists()


def test_check_says_what_was_mended(foldmill: Run, drawing: str) -> None:
    code, out, _ = foldmill("check", drawing, "--planarise", "--json")
    assert code == 0
    found = {f["code"]: f for f in json.loads(out)["findings"]}
    assert found["mended-crossing"]["severity"] == "info"
    assert "(100, 100) mm" in found["mended-crossing"]["where"]


def test_a_mended_drawing_is_planned_and_its_folder_verifies(foldmill: Run, drawing: str) -> None:
    assert foldmill("plan", drawing, "--planarise", "-o", "job", "--to", "hpgl")[0] == 0
    plan = Plan.model_validate_json(Path("job/plan.json").read_bytes())
    assert "mended-crossing" in {finding.code for finding in plan.findings}
    scores = [
        stroke
        for work in plan.passes
        for setup in work.setups
        for operation in setup.operations
        if operation.role is Role.SCORE
        for stroke in operation.strokes
    ]
    assert len(scores) == 4  # each stops short of the middle, where grooves would meet
    assert foldmill("verify", "job")[0] == 0
