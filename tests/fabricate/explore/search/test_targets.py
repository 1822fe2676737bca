"""What people may aim at, how they write it, and what nobody can fold."""

from __future__ import annotations

import pytest

from foldmill import InvalidInput, UnknownName
from foldmill_fabricate.explore.search import Request, Target
from foldmill_fabricate.explore.search.fit import Room

SHEET = Room(500, 500, 1)


@pytest.mark.parametrize(
    ("text", "value", "tolerance"),
    [
        ("height=150", 150, 1.5),
        ("width=220±5", 220, 5),
        ("width = 220 +- 0.5", 220, 0.5),
        ("seat=200±2%", 200, 4),
        ("footprint=1.5e2+/-10%", 150, 15),
    ],
)
def test_a_target_is_a_measure_and_what_it_may_be_missed_by(
    text: str, value: float, tolerance: float
) -> None:
    read = Target.read(text)
    assert (read.value, read.tolerance) == pytest.approx((value, tolerance))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("height", "write name=value"),
        ("height=", "write name=value"),
        ("height=15cm", "takes no unit"),
        ("height=0", "above 0 mm, not 0"),
        ("height=-3", "above 0 mm, not -3"),
        ("height=nan", "above 0 mm, not nan"),
        ("height=150±0", "tolerance of the target height must be above 0"),
        ("height=150±2±3", "write name=value"),
    ],
)
def test_what_is_no_target_is_refused_in_a_sentence(text: str, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        Target.read(text)


def test_an_unknown_measure_tells_those_there_are() -> None:
    with pytest.raises(UnknownName, match="footprint, height, seat, width"):
        Target.read("hight=150")


def test_an_error_is_the_share_of_the_value_and_weighs_more_where_little_is_allowed() -> None:
    missed = {"height": 153.0}
    assert Target.read("height=150").error(missed) == pytest.approx(0.02)
    assert Target.read("height=150±0.1%").error(missed) == pytest.approx(0.2)
    assert Target.read("height=150").miss(missed) == pytest.approx(3)
    assert Target.read("height=150±3").is_met(missed)
    assert not Target.read("height=150±2.9").is_met(missed)


def test_nothing_is_wider_than_the_diagonal_of_its_sheet() -> None:
    Request((Target.read("width=700"),), SHEET, 4.5)
    with pytest.raises(InvalidInput, match=r"diagonal is 707\.1 mm, 30\.9 mm too few"):
        Request((Target.read("width=745.5"),), SHEET, 4.5)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"sheet": Room(0, 500)}, "sheet must be larger than 0"),
        ({"sheet": Room(float("inf"), 500)}, "must have an end"),
        ({"least_crease": -1}, "cannot be below 0 mm"),
        ({"results": 0}, "One result at least"),
        ({"evaluations": 3}, "takes 60 evaluations at least, not 3"),
        ({"seed": -1}, "0 or more, not -1"),
        ({"targets": ()}, "Name a target"),
        ({"targets": (Target.read("height=9"), Target.read("height=8"))}, "named twice"),
    ],
)
def test_what_cannot_be_asked_is_refused(changes: dict[str, object], said: str) -> None:
    asked = {"targets": (Target.read("height=9"),), "sheet": SHEET, "least_crease": 4.5}
    with pytest.raises(InvalidInput, match=said):
        Request(**(asked | changes))  # type: ignore[arg-type]
