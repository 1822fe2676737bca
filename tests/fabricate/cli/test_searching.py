"""The command search: what people type, what they are told, and the exit code."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command import Run

SMALL = ("--evaluations", "60", "--jobs", "1", "--results", "2")


def test_a_search_writes_its_forms_a_table_and_a_picture(foldmill: Run) -> None:
    Path("out").mkdir()
    Path("out/results.json").write_text('{"results": [1, 2, 3, 4, 5, 6]}')
    Path("out/6.fold").write_text("an older one")
    words = ("search", "rotational", "--target", "height=80±10%", *SMALL, "-o", "out", "--json")
    code, out, err = foldmill(*words)
    assert code == 0
    assert "starts (1 of " in err
    data = json.loads(out)
    assert data == json.loads(Path("out/results.json").read_text())
    assert data["results"][0]["meets_targets"]
    names = sorted(path.name for path in Path("out").iterdir())
    assert names == ["1.fold", "2.fold", "results.csv", "results.json", "results.png"]
    assert foldmill("check", "out/1.fold")[0] == 0
    assert foldmill("plan", "out/1.fold", "-o", "job")[0] == 0


def test_what_is_given_is_kept(foldmill: Run) -> None:
    words = (
        "--target",
        "height=60±20%",
        "--target",
        "n=7",
        "--vary",
        "points.*.a",
        "--preset",
        "bowl-n8",
    )
    code, out, _ = foldmill("search", "rotational", *words, *SMALL, "--json")
    assert code == 0
    for each in json.loads(out)["results"]:
        assert each["params"]["n"] == 7
        assert each["params"]["phi"] == 75


def test_targets_that_are_not_met_end_with_one_and_by_how_much(foldmill: Run) -> None:
    words = ("--target", "height=200", "--sheet", "160x160", "--preset", "bowl-n8")
    code, out, _ = foldmill("search", "rotational", *words, *SMALL)
    assert code == 1
    assert "The targets are not met. Of the nearest, number 1, height is" in out
    assert "mm too small (2 mm allowed)" in out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--target", "size=3"), "There is no target 'size'"),
        (("--target", "height=3in"), "takes no unit"),
        ((), "Name a target"),
        (("--target", "height=80", "--sheet", "0x500"), "larger than 0 mm"),
        (("--target", "height=80", "--sheet", "A3"), "--sheet: write WIDTHxHEIGHT"),
        (("--target", "width=900", "--sheet", "500x500"), "diagonal is 707.1 mm"),
        (("--target", "height=80", "--material", "tin"), "There is no material 'tin'"),
        (("--target", "height=80", "--preset", "vase"), "There is no preset of rotational"),
        (("--target", "height=80", "--points.9.a", "3"), "There is no parameter 'points.9.a'"),
        (("--target", "height=80", "--n", "many"), "numbers only, not 'many'"),
        (("--target", "height=80", "--n", "2"), "n must be at least 3, not 2"),
        (("--target", "height=80", "--jobs", "0"), "--jobs must be 1 or more"),
        (("--target", "height=80", "--seconds", "0"), "--seconds must be above 0"),
        (("--target", "height=80", "--evaluations", "2"), "60 evaluations at least"),
    ],
)
def test_wrong_input_is_one_sentence_and_exit_code_two(
    foldmill: Run, words: tuple[str, ...], said: str
) -> None:
    code, out, err = foldmill("search", "rotational", *words)
    assert code == 2
    assert said in err
    assert err.count("\n") == 1
    assert not out


def test_a_seat_is_refused_at_once_where_no_form_has_one(foldmill: Run) -> None:
    code, _, err = foldmill("search", "six-crease", "--target", "seat=120", "--preset", "ball")
    assert code == 2
    assert err.startswith("foldmill: No form of six-crease to start from has a seat")


def test_a_number_of_wedges_that_is_refused_is_refused_alone(foldmill: Run) -> None:
    for order in ("2", "0", "-5"):
        words = ("--target", "height=150", "--preset", "stool-n8", "--n", order)
        code, _, err = foldmill("search", "tuck", *words)
        assert code == 2
        assert f"n must be at least 3, not {order}" in err
        assert "points" not in err


def test_an_unknown_family_tells_those_there_are(foldmill: Run) -> None:
    code, _, err = foldmill("search", "bowl", "--target", "height=80")
    assert code == 2
    assert "rotational" in err
