"""A pattern goes to another program whole, or with a sentence on what stays behind."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import hand_made
import numpy as np
import pytest
from command import Run
from stools import stool

from foldmill import CreasePattern, Fold, FoldmillError, UnknownName
from foldmill.errors import InvalidInput
from foldmill.exchange import cp, opx, read, write
from foldmill.exchange.marking import marked
from foldmill.finding import Finding, Severity
from foldmill_fabricate.errors import CannotHold
from foldmill_fabricate.exporting import PROGRAMS, export

if TYPE_CHECKING:
    from conftest import Golden

SAMPLES = Path(__file__).parents[2] / "samples"
KINDS = [(program.slug, suffix) for program in PROGRAMS.values() for suffix in program.files]


@pytest.fixture
def foldmill(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Run:
    """Return the command, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return Run(capsys, monkeypatch)


def creased(letters: str) -> Fold:
    """Return a square with two creases of these letters; mountains and valleys fold flat."""
    points = [(0, 0), (30, 0), (60, 0), (60, 60), (30, 60), (0, 60), (30, 30)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 6), (6, 4)]
    return Fold(CreasePattern.from_lines(points, edges, "BBBBBB" + letters))


@pytest.mark.parametrize(("program", "suffix"), KINDS)
def test_every_file_is_as_it_was(program: str, suffix: str, golden: Golden) -> None:
    made = export(hand_made.fold(), program, suffix, lossy=True)
    golden.check(f"exports/{program}{suffix}", made.content)


@pytest.mark.parametrize(("program", "suffix"), KINDS)
def test_a_pattern_that_folds_flat_is_held_by_everybody(program: str, suffix: str) -> None:
    assert export(creased("MM"), program, suffix).lost == ()


def test_angles_between_are_lost_on_those_who_fold_flat_and_on_nobody_else() -> None:
    keeps = set()
    for program, suffix in KINDS:
        try:
            export(stool(), program, suffix)
            keeps.add(program)
        except CannotHold as refusal:
            found = re.search(r"(\d+) of (\d+) creases here fold otherwise", str(refusal))
            assert found is not None
            assert int(found[2]) == 136
            assert 0 < int(found[1]) <= 136
    assert keeps == {"origami-simulator", "rabbit-ear", "fold-1.2"}


def test_refusals_name_the_first_of_what_would_be_lost() -> None:
    with pytest.raises(CannotHold, match=r"no unassigned crease, and 1 here are, edge 6 first"):
        export(creased("UM"), "oriedita", ".fold")
    with pytest.raises(CannotHold, match=r"no inner cut.* 1 here, the first from 30,0 to 30,30 mm"):
        export(creased("CM"), "flat-folder", ".svg")
    assert export(creased("UM"), "flat-folder", ".svg").content.count(b"magenta") == 1


def test_lines_of_four_types_hold_neither_cuts_nor_marks_nor_what_is_tiny() -> None:
    with pytest.raises(CannotHold, match=r"ORIPA knows no inner cut, and there are 1 here"):
        export(creased("CM"), "oripa", ".cp")
    fault = Finding("crosses", Severity.ERROR, "edge 3", "It crosses edge 4.", "Move it.")
    with pytest.raises(CannotHold, match=r"says of itself: DOES NOT FOLD: crosses"):
        export(marked(creased("MM"), [fault]), "oripa", ".cp")
    whole = creased("MM").pattern
    tiny = replace(creased("MM"), pattern=replace(whole, vertices=whole.vertices / 50))
    with pytest.raises(
        CannotHold, match=r"within 1 mm of each other.* 6 edges are shorter.* 0\.6 mm"
    ):
        export(tiny, "oripa", ".opx")
    with pytest.raises(InvalidInput, match=r"1 creases are neither mountain nor valley"):
        export(creased("UM"), "oripa", ".cp", lossy=True)


@pytest.mark.parametrize(("program", "suffix"), [("oripa", ".opx"), ("oripa", ".cp")])
def test_a_pattern_comes_back_from_oripas_files_line_by_line(program: str, suffix: str) -> None:
    content = export(creased("MV"), program, suffix).content
    drawn = opx.read(content) if suffix == ".opx" else cp.read(content.decode())
    whole = creased("MV").pattern
    ends = whole.vertices[whole.edges[~np.asarray(whole.added, bool)]]
    assert np.allclose(drawn.upright(), ends)  # what is up is up
    assert [look.letter for look in drawn.looks] == list("BBBBBBMV")


def test_who_knows_of_the_loss_gets_the_file_and_is_told_again() -> None:
    made = export(stool(), "flat-folder", ".fold", lossy=True)
    assert len(made.lost) == 1
    assert set(read(made.content.decode()).pattern.fold_angles) == {-180, 0, 180}


def test_unknown_programs_and_files_are_refused_with_those_there_are() -> None:
    with pytest.raises(UnknownName, match="origami-simulator"):
        export(stool(), "origami-simulater", ".svg")
    with pytest.raises(FoldmillError, match=r"oriedita is written as \.fold.*, not \.step"):
        export(stool(), "oriedita", ".step")


def test_flat_folder_knows_colours_by_their_names_alone() -> None:
    text = export(creased("MV"), "flat-folder", ".svg").content.decode()
    colours = re.findall(r'style="fill:none;stroke:(\w+);', text)
    assert sorted(colours) == ["black"] * 6 + ["blue", "red"]


def test_the_command_writes_refuses_and_lists(foldmill: Run, tmp_path: Path) -> None:
    (tmp_path / "s.fold").write_text(write(stool()))
    assert len(foldmill("export").out.splitlines()) == 1 + len(PROGRAMS)
    assert foldmill("export", "s.fold", "--profile", "origami-simulator", "-o", "o.svg").code == 0
    assert (tmp_path / "o.svg").read_bytes() == export(stool(), "origami-simulator", ".svg").content
    refused = foldmill("export", "s.fold", "--profile", "flat-folder", "-o", "f.fold")
    assert refused.code == 2
    assert "--lossy writes f.fold all the same" in refused.err
    assert not (tmp_path / "f.fold").exists()
    lossy = foldmill("export", "s.fold", "--profile", "flat-folder", "-o", "f.fold", "--lossy")
    assert lossy.code == 0
    assert "not in it: Flat-Folder folds every crease" in lossy.out
    assert foldmill("export", "s.fold").code == 2


def test_other_peoples_patterns_go_on_to_other_people(foldmill: Run, tmp_path: Path) -> None:
    for name in ("ff_pinwheel.fold", "ff_pinwheel.opx", "fold_diagonal-cp.fold"):
        told = foldmill(
            *("export", str(SAMPLES / name)), *("--profile", "flat-folder", "-o", "x.fold")
        )
        assert told.code == 0, told.err
        assert read((tmp_path / "x.fold").read_text()).pattern.letters()
