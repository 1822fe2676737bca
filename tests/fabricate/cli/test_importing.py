"""On the command line anybody's file is a FILE, and what it does not say is an option."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command import Run

SAMPLES = Path(__file__).parents[2] / "samples"
CROSS = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">
<rect width="100" height="100" fill="none" stroke="black"/>
<path d="M0 0L100 100" stroke="{}"/></svg>"""


def test_a_plan_asks_how_large_a_drawing_is_before_it_writes_anything(foldmill: Run) -> None:
    code, _, err = foldmill("plan", str(SAMPLES / "os_simpleVertex.svg"), "-o", "job")
    assert code == 2
    assert "--width" in err
    assert not Path("job").exists()


def test_import_writes_a_fold_file_and_says_what_it_changed(foldmill: Run) -> None:
    drawing = str(SAMPLES / "os_crane-opacity-angles.svg")
    words = ("import", drawing, "-o", "crane.fold", "--width", "300", "--json")
    code, out, _ = foldmill(*words)
    assert code == 0
    told = json.loads(out)
    assert told["format"] == "svg"
    assert told["questions"] == []
    assert {"import-gap", "mended-crossing", "import-side"} <= {f["code"] for f in told["findings"]}
    assert foldmill("check", "crane.fold")[0] == 0
    code, _, err = foldmill("import", drawing, "-o", "crane.dxf")
    assert code == 2
    assert "converted to .fold" in err


def test_show_draws_anybodys_file(foldmill: Run) -> None:
    assert foldmill("show", str(SAMPLES / "ff_pinwheel.opx"), "-o", "a.png")[0] == 0
    assert Path("a.png").read_bytes().startswith(b"\x89PNG")


def test_unknown_lines_are_asked_for_and_answered_by_as(foldmill: Run) -> None:
    Path("x.svg").write_text(CROSS.format("orange"), encoding="utf-8")
    code, _, err = foldmill("check", "x.svg")
    assert code == 2
    assert "--as '#ffa500=M'" in err
    code, out, _ = foldmill("check", "x.svg", "--as", "orange=V", "--json")
    assert code == 0
    assert json.loads(out)["figures"]["valleys"] == 1


def test_unassigned_creases_are_asked_for_by_import_and_by_plan(foldmill: Run) -> None:
    Path("x.svg").write_text(CROSS.format("magenta"), encoding="utf-8")
    code, out, _ = foldmill("import", "x.svg", "-o", "x.fold", "--scale", "2", "--json")
    assert code == 0
    assert [each["option"] for each in json.loads(out)["questions"]] == ["--unassigned"]
    assert json.loads(out)["unassigned"] == 1
    code, _, err = foldmill("plan", "x.svg", "--scale", "2", "-o", "job")
    assert code == 2
    assert "--unassigned" in err
    words = ("plan", "x.svg", "--scale", "2", "-o", "job", "--to", "hpgl", "--unassigned", "front")
    assert foldmill(*words)[0] == 0


def test_fold_angles_in_radians_are_asked_about_and_answered(foldmill: Run) -> None:
    pinwheel = json.loads((SAMPLES / "fold_diagonal-cp.fold").read_text(encoding="utf-8"))
    turns = {"V": 3.14159, "M": -3.14159}
    pinwheel["edges_foldAngle"] = [turns.get(each, 0) for each in pinwheel["edges_assignment"]]
    Path("x.fold").write_text(json.dumps(pinwheel), encoding="utf-8")
    code, _, err = foldmill("import", "x.fold", "--width", "90", "-o", "y.fold")
    assert code == 2
    assert "they are radians" in err
    words = ("import", "x.fold", "--width", "90", "-o", "y.fold", "--angles", "radians")
    assert foldmill(*words)[0] == 0
    angles = json.loads(Path("y.fold").read_text(encoding="utf-8"))["edges_foldAngle"]
    assert {abs(angle) for angle in angles} == {0, 180}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--width", "0"), "--width must be a positive number"),
        (("--width", "5", "--unit", "mm"), "--width says it all"),
        (("--as", "red"), "--as takes a colour or layer"),
        (("--unit", "ell"), "ell"),
        (("--frame", "7"), "no vertices in a frame 7"),
    ],
)
def test_a_wrong_option_is_one_sentence(foldmill: Run, words: tuple[str, ...], said: str) -> None:
    code, _, err = foldmill("check", str(SAMPLES / "ff_pinwheel.fold"), *words)
    assert code == 2
    assert said in err
    assert "Traceback" not in err


def test_check_says_of_a_sheet_without_a_flat_state_what_is_wrong(foldmill: Run) -> None:
    twist = str(SAMPLES / "ff_bad-twist-UNSAT.fold")
    assert foldmill("check", twist)[0] == 0  # it is a sound pattern, and need not fold flat
    code, out, _ = foldmill("check", twist, "--flat", "--width", "200")
    assert code == 1
    assert "layers would have to pass through each other" in out
    assert foldmill("check", str(SAMPLES / "ff_pinwheel.fold"), "--flat")[0] == 0
