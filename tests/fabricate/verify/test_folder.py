"""A job in a folder is verified as it lies there."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
from fabricate.verify import square_job
from fabricate.verify.corrupt_programs import a_crease_is_cut_once_more
from fabricate.verify.square_job import PENS

from foldmill import Fold, UnreadableFile
from foldmill.exchange import fold
from foldmill_fabricate.verify import (
    read_folder,
    report,
    verify,
    verify_files,
    verify_folder,
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    job = square_job.job(PENS)
    text = fold.write(Fold(job.pattern))
    (tmp_path / "pattern.fold").write_bytes(text.encode())
    digest = hashlib.sha256(text.encode()).hexdigest()
    plan = job.plan.model_copy(update={"pattern_sha256": digest})
    (tmp_path / "plan.json").write_text(plan.model_dump_json(indent=1), encoding="utf-8")
    for name, data in job.programs.items():
        (tmp_path / name).write_bytes(data)
    return tmp_path


def codes(folder: Path) -> set[str]:
    return {finding.code for finding in verify_folder(folder).findings}


def test_a_good_folder_passes_and_its_report_says_so(folder: Path) -> None:
    result = verify_folder(folder)
    assert result.findings == ()
    text = report(result)
    assert "2 mountains, 2 valleys, 4 flats" in text
    assert f"{result.figures.deviation:.4f} mm of 0.0250 mm allowed" in text
    assert "Findings: none." in text
    assert "Cut it." in text


def test_an_edited_program_is_found_by_its_hash_and_by_what_it_draws(folder: Path) -> None:
    spoilt = a_crease_is_cut_once_more(square_job.job(PENS))
    (folder / "front.hpgl").write_bytes(spoilt.programs["front.hpgl"])
    assert codes(folder) == {"edited", "repeats"}


def test_what_is_proved_is_what_was_read_whatever_becomes_of_the_files(folder: Path) -> None:
    files = read_folder(folder)
    for path in folder.iterdir():
        path.write_bytes(b"spoilt since")
    assert verify_files(files).ok
    assert files.programs == square_job.job(PENS).programs


def test_a_missing_program_and_a_foreign_one_are_told(folder: Path) -> None:
    (folder / "reverse.hpgl").rename(folder / "other.hpgl")
    assert codes(folder) == {"missing-program", "foreign-program"}


def test_an_edited_pattern_is_found(folder: Path) -> None:
    path = folder / "pattern.fold"
    path.write_bytes(path.read_bytes() + b" ")
    assert codes(folder) == {"edited"}


@pytest.mark.parametrize("name", ["plan.json", "pattern.fold"])
def test_without_plan_or_pattern_there_is_one_sentence(folder: Path, name: str) -> None:
    (folder / name).unlink()
    with pytest.raises(UnreadableFile, match=rf"{name}.*Plan again"):
        verify_folder(folder)


@pytest.mark.parametrize("text", ["", "{", '{"version": 1}', "[]"])
def test_a_broken_plan_is_refused_with_its_name(folder: Path, text: str) -> None:
    (folder / "plan.json").write_text(text, encoding="utf-8")
    with pytest.raises(UnreadableFile, match=r"plan\.json is no plan"):
        verify_folder(folder)


def test_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UnreadableFile, match="no folder"):
        verify_folder(tmp_path / "nowhere")


def test_the_report_of_a_bad_job_says_not_to_cut_it() -> None:
    job = a_crease_is_cut_once_more(square_job.job(PENS))
    text = report(verify(job.plan, job.pattern, job.programs))
    assert text.splitlines()[2] == "Verdict: NOT to be cut. 1 error."
    assert "ERROR  A stroke is repeated too often or too rarely (repeats): 1" in text
    assert "gone over once more than its 2 repeats say" in " ".join(text.split())
    assert "To do: Plan again" in text


def test_the_report_tells_kind_by_kind_with_errors_first_and_counts_the_rest() -> None:
    good = square_job.job(PENS)
    few = good.plan.model_copy(update={"ties": good.plan.ties[:2]})
    empty = dict.fromkeys(good.programs, b"IN;DF;PA;PU;SP1;PU;SP0;")
    text = report(verify(few, good.pattern, {**empty, "stray.hpgl": b"IN;"}))
    heads = [line for line in text.splitlines() if line.startswith(("ERROR", "WARNING"))]
    assert len(heads) > 3
    assert heads == sorted(heads, key=lambda line: line.startswith("WARNING"))
    assert any(head.startswith("ERROR  A stroke of the plan is not drawn") for head in heads)
    numbers = [int(line.split(".")[0]) for line in text.splitlines() if line[:4].strip().isdigit()]
    assert numbers == list(range(1, len(numbers) + 1))
    assert max(len(line) for line in text.splitlines()) <= 96
