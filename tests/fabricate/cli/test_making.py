"""Planning from the shell: other processes, other machines, relief, places."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
import stools
from slit_forms import form

from foldmill import CreasePattern, Fold
from foldmill.exchange import fold as fold_file
from foldmill_fabricate.cli.app import main
from foldmill_fabricate.passes import Plan


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("stool.fold").write_text(fold_file.write(stools.stool()), encoding="utf-8")
    return tmp_path / "job"


def foldmill(*words: str) -> int:
    """Run the command in this process; return its exit code."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["foldmill", *words])
        with pytest.raises(SystemExit) as stop:
            main()
    return int(stop.value.code or 0)


def test_a_machine_gets_drawings_and_programs_in_its_own_language(job: Path) -> None:
    assert foldmill("plan", "stool.fold", "--machine", "silhouette-like", "-o", "job") == 0
    names = {path.name for path in job.iterdir()}
    assert {"front.svg", "reverse.dxf", "job-sheet.pdf", "plan.json"} <= names
    assert {name for name in names if name[0].isdigit()} == {
        "1-front-score.gpgl",
        "2-reverse-score.gpgl",
        "3-reverse-cut.gpgl",
    }


def test_programs_in_another_language_are_refused_in_one_sentence(
    job: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("plan", "stool.fold", "--machine", "grbl-laser", "--to", "svg,hpgl", "-o", "job")
    assert foldmill(*words) == 2
    assert "speaks gcode, so a program in hpgl is nothing to it" in capsys.readouterr().err
    assert not job.exists()


def test_processes_are_chosen_and_the_folder_verifies(job: Path) -> None:
    words = ("--score", "half-cut", "--outline", "score-and-snap", "--to", "hpgl,places")
    assert foldmill("plan", "stool.fold", *words, "-o", "job") == 0
    assert (job / "places.png").is_file()
    assert foldmill("verify", "job") == 0
    plan = Plan.model_validate_json((job / "plan.json").read_bytes())
    assert plan.material.cut.kind == "score-and-snap"


def test_a_tight_vertex_is_an_error_until_relief_is_asked_for(
    job: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lampshade = form("lampshade-n12", slit=False)
    Path("lamp.fold").write_text(fold_file.write(lampshade), encoding="utf-8")
    words = ("plan", "lamp.fold", "-o", "job", "--to", "hpgl", "--json")
    assert foldmill(*words) == 1
    assert "--relief needed" in capsys.readouterr().out
    assert foldmill(*words, "--relief", "needed") == 0
    assert len(json.loads(capsys.readouterr().out)["reliefs"]) == 1
    assert foldmill("verify", "job") == 0


def test_copies_are_planned_counted_and_verified(
    job: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    small = Fold(CreasePattern.from_lines([(0, 0), (90, 0), (90, 90), (0, 90)],
                                          [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)],
                                          "BBBBV"))  # fmt: skip
    Path("small.fold").write_text(fold_file.write(small), encoding="utf-8")
    assert foldmill("plan", "small.fold", "--grid", "3x2", "-o", "job", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["quantity"] == 6
    assert len(told["copies"]) == 5
    assert foldmill("verify", "job") == 0
    assert "Copies                6" in capsys.readouterr().out
    assert foldmill("plan", "small.fold", "--copies", "1", "-o", "one", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["quantity"] == 1
    assert "copies" not in told


def test_the_plan_says_below_what_no_order_travels(
    job: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert foldmill("plan", "stool.fold", "--to", "hpgl", "-o", "job", "--json") == 0
    figures = json.loads(capsys.readouterr().out)["figures"]
    above = figures["travel"] - figures["travel_bound"]
    assert figures["travel_gap"] == pytest.approx(above)
    assert 0 < above < figures["travel"]
    assert foldmill("plan", "stool.fold", "--to", "hpgl", "-o", "again") == 0
    said = capsys.readouterr().out
    assert f"m; no order travels less than {figures['travel_bound'] / 1000:.2f} m\n" in said


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--copies", "2"], "1 would fit"),
        (["--grid", "3by2"], "write COLUMNSxROWS, as 3x2"),
        (["--grid", "0x2"], "write COLUMNSxROWS, as 3x2"),
        (["--grid", "2x2", "--copies", "3"], "holds 4 copies, and 3 are wanted"),
    ],
)
def test_copies_that_cannot_be_made_are_refused_in_one_sentence(
    job: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    assert foldmill("plan", "stool.fold", *words, "-o", "job") == 2
    told = capsys.readouterr().err
    assert said in told
    assert "Traceback" not in told
    assert not job.exists()


def test_who_has_planned_is_told_where_it_lies_and_what_comes_next(
    job: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert foldmill("plan", "stool.fold", "-o", "job") == 0
    *_, head, tried, sent = capsys.readouterr().out.splitlines()
    assert head == f"job: 4 programs; print {Path('job/job-sheet.pdf')}. Next:"
    assert tried.split()[:3] == sent.split()[:3] == ["foldmill", "send", "job"]
    words = tried.split("#")[0].split()[1:]
    assert foldmill(*words) == 0, "it is a command, as it is told"

    assert foldmill("plan", "stool.fold", "--to", "svg", "-o", "drawings") == 0
    assert "drawings: drawings only." in capsys.readouterr().out
