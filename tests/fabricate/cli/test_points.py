"""Points are added and left out on the command line, whatever the family."""

from __future__ import annotations

import json
from typing import Any

import pytest

from foldmill import Design, InvalidParameters, Params, installed
from foldmill_fabricate.cli.parameters import gather


def design(family: str = "rotational") -> Design[Any]:
    return installed().design(family)


def a_of(params: Params) -> list[float]:
    return [point["a"] for point in params.model_dump()["points"].values()]


def told(*words: str, family: str = "rotational") -> Params:
    return gather(design(family), None, None, words)


def test_a_point_after_the_last_is_added_by_naming_it() -> None:
    assert a_of(told("--points.7.a", "150"))[-2:] == [121, 150]


def test_a_point_is_inserted_and_the_later_ones_move_up() -> None:
    assert a_of(told("--insert", "points.3", "--points.3.a=60")) == [40, 56, 60, 76, 100, 117, 121]


def test_a_point_is_dropped_and_the_later_ones_move_down() -> None:
    assert a_of(told("--drop=points.2", "--points.2.a", "77")) == [40, 77, 100, 117, 121]


def test_what_is_said_first_is_done_first() -> None:
    words = ("--drop", "points.6", "--drop", "points.5", "--insert", "points.1")
    assert a_of(told(*words, "--points.1.a", "30")) == [30, 40, 56, 76, 100]


def test_parts_of_a_list_are_numbered_from_nothing() -> None:
    words = ("--insert", "tucks.0", "--tucks.0.point", "4", "--tucks.0.t", "189.2")
    assert [tuck["point"] for tuck in told(*words, family="tuck").model_dump()["tucks"]] == [4]
    with pytest.raises(InvalidParameters, match=r"--drop tucks\.0: There is no number 0"):
        told("--drop", "tucks.0", family="tuck")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--drop", "points.9"), "--drop points.9: There is no number 9 .* there are 1 to 6"),
        (("--insert", "points.9"), "a new one is number 1 to 7"),
        (("--insert", "points.3"), r"points\.3\.a is missing"),
        (("--drop", "n"), "--drop n: write the name of a numbered part, such as points.3"),
        (("--drop", "points"), "write the name of a numbered part"),
        (("--drop", "points.3.a"), "write the name of a numbered part"),
        (("--insert", "nothing.1"), "write the name of a numbered part"),
        (("--insert",), "--insert needs a value"),
    ],
)
def test_what_cannot_be_is_said(words: tuple[str, ...], said: str) -> None:
    with pytest.raises(InvalidParameters, match=said):
        told(*words)


def test_a_slit_is_asked_for_by_its_name() -> None:
    from foldmill.exchange import fold as fold_file

    fold = design().run(gather(design(), "star-n6", None, ("--slit", "true")))
    file = json.loads(fold_file.write(fold))
    assert file["foldmill:design"]["params"]["slit"] is True
    assert list(fold.motions) == ["unfold", "along-arc"]
    assert list(design().run({}).motions) == ["unfold"]
