"""The command coupon: what it writes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command import Run


def test_coupon_writes_a_job_folder_and_keeps_what_a_person_wrote_into_it(foldmill: Run) -> None:
    answers = Path("job/coupon-answers.toml")
    answers.parent.mkdir()
    answers.write_text("filled in", encoding="utf-8")
    size = ("--blank", "300x300", "--to", "hpgl")
    made = foldmill("coupon", "--machine", "generic-hpgl-pens", *size, "-o", "job", "--json")
    assert made.code == 0, made.err
    names = {path.name for path in Path("job").iterdir()}
    assert {"plan.json", "front.hpgl", "reverse.hpgl", "job-sheet.pdf"} <= names
    assert json.loads(made.out)["coupon"]["left_out"]
    assert foldmill("verify", "job").code == 0
    assert answers.read_text(encoding="utf-8") == "filled in"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ((), "Say -o FOLDER to make a coupon, or --record FOLDER"),
        (("-o", "job", "--record", "job"), "Say -o FOLDER to make a coupon"),
        (("-o", "job", "--degree", "5"), "--degree is 4 or 6, not 5."),
        (("-o", "job", "--blank", "100x100"), "A coupon does not fit on a blank of 100 × 100 mm"),
        (("--record", "nowhere"), "Answers are read beside the plan.json of their coupon"),
    ],
)
def test_wrong_use_is_refused_with_a_sentence_and_nothing_is_written(
    foldmill: Run, words: tuple[str, ...], sentence: str
) -> None:
    told = foldmill("coupon", *words)
    assert told.code == 2
    assert sentence in told.err
    assert not Path("job").exists()
