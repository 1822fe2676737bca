"""The command explore: what people type, what they get, and the exit code."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from command import Run

from foldmill_fabricate.cli.progress import SweepProgress

SWEEP = ("explore", "rotational", "--vary", "phi=30:90:5", "--jobs", "1")


def test_a_sweep_gives_its_table_its_map_its_summary_and_the_fold_of_a_pick(foldmill: Run) -> None:
    told = foldmill(
        *SWEEP, "-o", "bowl.csv", "--picture", "bowl.png", "--pick", "region1:pick.fold", "--json"
    )
    assert told.code == 0
    said = json.loads(told.out)
    assert said["rows"] == 13
    assert sum(said["counts"].values()) == 13
    lines = Path("bowl.csv").read_text().splitlines()
    assert len(lines) == 14
    assert lines[0].startswith("row,phi,outcome,point,region,")
    assert Path("bowl.png").read_bytes().startswith(b"\x89PNG")
    centre = said["regions"][0]["centre"]["phi"]
    picked = json.loads(Path("pick.fold").read_text())["foldmill:design"]
    assert picked["params"]["phi"] == centre
    assert foldmill("check", "pick.fold").code == 0
    assert "13 configurations in one process" in told.err


def test_the_text_tells_outcomes_and_regions(foldmill: Run) -> None:
    told = foldmill(*SWEEP, "--n", "8", "--vary", "points.4.a=100:102:x2")
    assert told.code == 0
    for word in ("free", "crosses-axis", "rows", "REGION", "phi [deg]", "points.4.a [mm]"):
        assert word in told.out


def test_a_pick_that_penetrates_is_written_only_by_force_and_then_marked(foldmill: Run) -> None:
    told = foldmill(*SWEEP, "--pick", "0:bad.fold")
    assert told.code == 1
    assert "Row 0 (phi = 30 deg) does not fold, so bad.fold is not written" in told.err
    assert not Path("bad.fold").exists()
    assert foldmill(*SWEEP, "--pick", "0:bad.fold", "--force").code == 0
    assert json.loads(Path("bad.fold").read_text())["foldmill:errors"] == ["penetration"]


def test_a_sweep_is_resumed_from_its_folder(foldmill: Run) -> None:
    foldmill(*SWEEP, "--resume", "kept", "-o", "a.csv")
    told = foldmill(*SWEEP, "--resume", "kept", "-o", "b.csv")
    assert "13 of them done before" in told.err
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()


def test_a_sweep_that_is_broken_off_ends_with_where_it_is_kept(
    foldmill: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(told: SweepProgress, done: int, rows: int) -> None:
        if done:
            raise KeyboardInterrupt

    monkeypatch.setattr(SweepProgress, "__call__", interrupted)
    told = foldmill("explore", "tuck", *SWEEP[2:3], "phi=80:100:1", "--jobs", "1", "--resume", "k")
    assert told.code == 130
    assert "Broken off. 1 of 2 chunks were done" in told.err
    assert f"kept in {Path('k') / 'tuck'}" in told.err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["explore", "rotationl", "--vary", "phi=1:2:1"], "There is no family 'rotationl'"),
        (["explore", "rotational"], "Nothing is varied"),
        ([*SWEEP, "-o", "a.xls"], "a.xls: a table is written as .csv or .parquet"),
        ([*SWEEP, "--picture", "a.gif"], "a.gif: a map is written as .png or .svg"),
        ([*SWEEP, "--pick", "3"], "--pick 3: write ROW:FILE.fold"),
        ([*SWEEP, "--pick", "3:a.dxf"], "a.dxf: a pick is written as .fold"),
        ([*SWEEP, "--pick", "13:a.fold"], "There is no row 13: the rows are 0 to 12"),
        ([*SWEEP, "--pick", "region9:a.fold"], "There is no region9"),
        ([*SWEEP, "--pick", "best:a.fold"], "'best' is neither a row's number nor regionK"),
        ([*SWEEP, "--picture", "a.png", "--thumbnail", "999"], "There is no row 999: the rows are"),
        ([*SWEEP, "--picture", "a.png", "--thumbnail", "top"], "'top' is neither a row's number"),
        ([*SWEEP, "--thumbnail", "3"], "--thumbnail shows a form beside the map: name it"),
        ([*SWEEP, "-o", "full/a.csv"], "full/a.csv: not a directory"),
        ([*SWEEP, "--picture", "full/of/a.png"], "full/of/a.png: not a directory"),
        ([*SWEEP, "--pick", "3:full/a.stl"], "full/a.stl: not a directory"),
        ([*SWEEP, "--resume", "full"], "full/kept: not a directory"),
        ([*SWEEP, "-o", "folder.csv"], "folder.csv: is a directory"),
        ([*SWEEP, "--phi", "40"], "--phi 40 and --vary phi=… contradict each other"),
        ([*SWEEP, "--scheduler", "tcp://127.0.0.1:9"], "--jobs counts processes here"),
        ([*SWEEP[:-1], "0"], "0 processes compute nothing"),
        ([*SWEEP, "--at-most", "12"], "13 rows, more than 12"),
    ],
)
def test_what_means_nothing_is_refused_with_a_sentence(
    foldmill: Run, words: list[str], sentence: str
) -> None:
    Path("full").write_text("a file, no folder")
    Path("folder.csv").mkdir()
    told = foldmill(*words)
    assert told.code == 2
    assert sentence in told.err
    assert "Traceback" not in told.err
    assert ("13 configurations" in told.err) == ("region9" in sentence)
    assert list(Path().glob("*.fold")) == []


def test_the_help_of_the_program_stays_quick() -> None:
    code = "import sys, foldmill_fabricate.cli\nprint([m for m in sys.modules if m in %r])"
    slow = ("scipy", "matplotlib", "joblib", "distributed", "pyarrow", "rich.progress")
    run = subprocess.run([sys.executable, "-c", code % (slow,)], capture_output=True, text=True)
    assert run.stdout.strip() == "[]"


def commands() -> list[list[str]]:
    page = Path(__file__).parents[3] / "docs" / "explore.md"
    lines = [line.strip() for line in page.read_text("utf-8").splitlines()]
    return [line.split()[1:] for line in lines if line.startswith("foldmill explore ")]


def test_the_picks_of_the_page_are_written(foldmill: Run) -> None:
    (words,) = (words for words in commands() if "--pick" in words)
    told = foldmill(*words, "--jobs", "1")
    assert told.code == 0
    files = [word.split(":")[1] for word in words if word.endswith((".fold", ".glb"))]
    assert len(files) == 2
    assert all(Path(file).stat().st_size for file in files)


@pytest.mark.parametrize("words", commands())
def test_every_command_of_the_page_is_understood(foldmill: Run, words: list[str]) -> None:
    told = foldmill(*words, "--at-most", "0")
    assert told.code == 2
    assert "rows, more than 0" in told.err
