"""Other people's origami libraries accept every preset, fold it as we do, and lose nothing."""

from __future__ import annotations

import json
from collections import Counter
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import readers

from foldmill import Fold, installed
from foldmill.exchange import write
from foldmill_fabricate.exporting import PROGRAMS, export

if TYPE_CHECKING:
    from soaking import Soak

EVERY = [
    (design.slug, preset)
    for design in installed().designs.values()
    if design.slug in {"rotational", "six-crease", "tuck", "waterbomb"}
    for preset in design.presets
]
QUICK = 500
"""Edges. ORIPA's reader compares every point with every other, so larger ones are for a soak."""


@cache
def fold(family: str, preset: str) -> Fold:
    design = installed().design(family)
    return design.run(design.preset(preset))


def written(folder: Path, most: int) -> list[Path]:
    """Write every preset of at most so many edges as a file."""
    files = []
    for family, preset in EVERY:
        made = fold(family, preset)
        if len(made.pattern.edges) <= most:
            files.append(folder / f"{family} {preset}.fold")
            files[-1].write_text(write(made), encoding="utf-8")
    return files


@pytest.fixture(scope="module")
def verdicts(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What is said of every preset's file; one run of node for all of them."""
    readers.judged([])  # skips before any is made
    return readers.judged(written(tmp_path_factory.mktemp("presets"), 10**6))


@pytest.mark.long
@pytest.mark.parametrize(("family", "preset"), EVERY)
def test_rabbit_ear_finds_no_fault_and_fold_the_same_faces(
    family: str, preset: str, verdicts: dict[str, Any]
) -> None:
    told, letters = verdicts[f"{family} {preset}.fold"], fold(family, preset).pattern.letters()
    assert (told["summary"], told["doubled"]) == ("valid", 0)
    assert told["faces"] == told["found"]
    assert told["counts"] == Counter(letters)


@pytest.mark.parametrize(("family", "preset"), EVERY)
def test_rabbit_ear_folds_our_angles_into_our_form(
    family: str, preset: str, verdicts: dict[str, Any]
) -> None:
    assert verdicts[f"{family} {preset}.fold"]["off"] < 1e-8  # mm


def test_soak_mountains_valleys_and_borders_survive_oripas_format(
    tmp_path: Path, soak: Soak
) -> None:
    files = written(tmp_path, soak.size(QUICK, 10**6))
    told = readers.judged(files, "--opx")
    assert {name.split()[0] for name in told} == {family for family, _ in EVERY}
    assert {name: each["back"] for name, each in told.items()} == {
        name: each["counts"] for name, each in told.items()
    }


def test_fold_reads_our_files_for_oripa(tmp_path: Path) -> None:
    small = [each for each in EVERY if len(fold(*each).pattern.edges) <= QUICK]
    for family, preset in small:
        made = export(fold(family, preset), "oripa", ".opx", lossy=True)
        (tmp_path / f"{family} {preset}.opx").write_bytes(made.content)
    told = readers.judged(sorted(tmp_path.iterdir()))
    assert {name: Counter(each["back"]) for name, each in told.items()} == {
        f"{family} {preset}.opx": Counter(fold(family, preset).pattern.letters())
        for family, preset in small
    }


@pytest.mark.parametrize("program", [each for each in PROGRAMS if ".fold" in PROGRAMS[each].files])
def test_a_file_for_any_program_is_sound_to_a_validator(program: str, tmp_path: Path) -> None:
    small = [each for each in EVERY if len(fold(*each).pattern.edges) <= QUICK]
    files = [tmp_path / f"{number}.fold" for number, _ in enumerate(small)]
    for file, each in zip(files, small, strict=True):
        file.write_bytes(export(fold(*each), program, ".fold", lossy=True).content)
    told = readers.judged(files)
    for file, each in zip(files, small, strict=True):
        pattern, verdict = fold(*each).pattern, told[file.name]
        assert (verdict["summary"], verdict["doubled"]) == ("valid", 0)
        assert verdict["counts"] == Counter(pattern.letters())
        assert verdict["found"] == len(pattern.faces)


def test_the_judges_see_a_fault(tmp_path: Path) -> None:
    text = write(fold("tuck", "stool-n8"))
    data = json.loads(text)
    for key in ("edges_vertices", "edges_assignment", "edges_foldAngle"):
        data[key].append(data[key][0])
    (tmp_path / "double.fold").write_text(json.dumps(data))
    assert text.count("-108.") > 1
    (tmp_path / "bent.fold").write_text(text.replace("-108.", "-107.", 1))
    mirrored = json.loads(text)
    for place in mirrored["file_frames"][0]["vertices_coords"]:
        place[2] *= -1
    (tmp_path / "mirrored.fold").write_text(json.dumps(mirrored))
    told = readers.judged(sorted(tmp_path.iterdir()))
    assert told["double.fold"]["summary"] == "problematic"
    assert told["bent.fold"]["off"] > 0.1
    assert told["mirrored.fold"]["off"] is None
