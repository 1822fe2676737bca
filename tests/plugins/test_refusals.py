"""What each family refuses, by its sentence: one table per family, in the order of a long list.

N, T, the order of the points, widths and angles, what is not a number, branches, a direction that
is missing, a point without a place, motions beyond their ends; for tucks pattern, gap and flap.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from foldmill import Design, ImpossibleGeometry, InvalidInput, InvalidParameters
from foldmill_plugins import rotational, six_crease, tuck
from foldmill_plugins.six_crease.params import points_of

NAN, INF = float("nan"), float("inf")
Refusal = tuple[dict[str, Any], str]
"""Values, and how the sentence begins."""

LINES: dict[int, dict[str, Any]] = {1: {"a": 40}, 2: {"a": 62}, 3: {"a": 92}, 4: {"a": 118}}
HEIGHTS: dict[int, dict[str, Any]] = {i: {"y": 5.0 * i} for i in (1, 2, 3, 4)}
STOOL = tuck.DESIGN.preset("stool-n8").model_dump(mode="json")
BASKET = tuck.DESIGN.preset("basket-n10").model_dump(mode="json")
INNER = {1: {"a": 40}, 2: {"a": 40 / np.cos(np.pi / 6)}, 3: {"a": 92}}
"""Points whose third one is free to turn at φ = 90 and N = 6."""


def lines(**changes: Any) -> dict[str, Any]:
    """Return four points on their lines, some of them others: ``p2=…``."""
    return {"points": LINES | {int(name[1:]): point for name, point in changes.items()}}


def heights(**changes: Any) -> dict[str, Any]:
    return {"points": HEIGHTS | {int(name[1:]): point for name, point in changes.items()}}


def stool(*tucks: dict[str, Any], **changes: Any) -> dict[str, Any]:
    points = STOOL["points"] | {name[1:]: point for name, point in changes.items()}
    return STOOL | {"tucks": list(tucks), "points": points}


def refused(design: Design[Any], kind: type[InvalidInput], row: Refusal) -> None:
    values, sentence = row
    with pytest.raises(kind) as caught:
        design.run(values)
    assert str(caught.value).startswith(sentence)


def table(rows: Mapping[str, Refusal]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("row", rows.values(), ids=[name.strip() for name in rows])


ALL_FAMILIES: dict[str, Refusal] = {
    "N below 3": ({"n": 2}, "n must be at least 3, not 2."),
    "N not whole": ({"n": 6.5}, "n must be a whole number, not 6.5."),
    "N not a number": ({"n": NAN}, "n must be a whole number, not NaN."),
    "N infinite": ({"n": INF}, "n must be a whole number, not inf."),
    "phi below 0": ({"phi": -0.5}, "phi must be at least 0 deg, not -0.5."),
    "phi above 180": ({"phi": 180.5}, "phi must be at most 180 deg, not 180.5."),
    "phi not a number": ({"phi": NAN}, "phi must be a finite number, not NaN."),
    "phi infinite": ({"phi": INF}, "phi must be a finite number, not inf."),
}


@pytest.mark.parametrize("design", [rotational.DESIGN, tuck.DESIGN, six_crease.DESIGN])
@table(ALL_FAMILIES)
def test_every_family_refuses(design: Design[Any], row: Refusal) -> None:
    refused(design, InvalidParameters, row)


ON_LINES: dict[str, Refusal] = {
    "T below 2": (
        {"points": {1: {"a": 40}}},
        "points: a facet needs points 1 and 2 beside the centre; add the missing ones.",
    ),
    "a is 0": (lines(p2={"a": 0}), "points.2.a must be more than 0 mm, not 0."),
    "a below 0": (lines(p2={"a": -62}), "points.2.a must be more than 0 mm, not -62."),
    "a not above that of i - 2": (
        lines(p3={"a": 40}),
        (
            "Point 3 must lie farther out than point 1: a = 40 mm, but point 1 is at 40 mm. "
            "Give point 3 more than 40 mm."
        ),
    ),
    "a below that of i - 2": (lines(p4={"a": 61}), "Point 4 must lie farther out than point 2"),
    "a not a number": (lines(p2={"a": NAN}), "points.2.a must be a finite number, not NaN."),
    "a infinite": (lines(p2={"a": INF}), "points.2.a must be a finite number, not inf."),
    "gamma not a number": (
        lines(p3={"a": 92, "gamma": NAN}),
        "points.3.gamma must be a finite number, not NaN.",
    ),
    "another branch": (
        lines(p3={"a": 92, "branch": 2}),
        "points.3.branch must be -1 or 1, not 2.",
    ),
    "no branch": (
        lines(p3={"a": 92, "branch": 0}),
        "points.3.branch must be -1 or 1, not 0.",
    ),
    "gamma missing": (
        {"n": 6, "phi": 90, "points": INNER},
        (
            "Point 3 can turn freely about point 1 here (their circles are one): give it a "
            "direction, points.3.gamma, in degrees."
        ),
    ),
}


@pytest.mark.parametrize("design", [rotational.DESIGN, tuck.DESIGN])
@table(ON_LINES)
def test_points_on_lines_are_refused(design: Design[Any], row: Refusal) -> None:
    refused(design, InvalidParameters, row)


SIX_CREASE: dict[str, Refusal] = {
    "T below 4": (
        {"points": {i: HEIGHTS[i] for i in (1, 2, 3)}},
        (
            "points: a tube needs points 1 to 4 (with fewer the sheet falls apart), not 3 of them; "
            "add the missing ones."
        ),
    ),
    "y not above that of i - 2": (
        heights(p3={"y": 5.0}),
        (
            "points: point 3 must lie above point 1 on its line: points.3.y = 5 mm, but "
            "points.1.y = 5 mm. Give point 3 more than 5 mm"
        ),
    ),
    "y below that of i - 2": (
        heights(p4={"y": 9.0}),
        "points: point 4 must lie above point 2 on its line",
    ),
    "w is 0": ({"w": 0}, "w must be more than 0 mm, not 0."),
    "w below 0": ({"w": -3}, "w must be more than 0 mm, not -3."),
    "L below 0": ({"L": -1}, "L must be at least 0 mm, not -1."),
    "w not a number": ({"w": NAN}, "w must be a finite number, not NaN."),
    "L infinite": ({"L": INF}, "L must be a finite number, not inf."),
    "beta not a number": ({"beta": NAN}, "beta must be a finite number, not NaN."),
    "y infinite": (heights(p3={"y": INF}), "points.3.y must be a finite number, not inf."),
    "gamma not a number": (
        heights(p3={"y": 15, "gamma": NAN}),
        "points.3.gamma must be a finite number, not NaN.",
    ),
    "another branch": (
        heights(p3={"y": 15, "branch": 0}),
        "points.3.branch must be -1 or 1, not 0.",
    ),
    "gamma missing": (
        {"n": 6, "w": 10, "L": 10 / np.tan(np.pi / 6), "phi": 90, "beta": 90}
        | {"points": {i: {"y": y} for i, y in enumerate((0, 0, 30, 40), start=1)}},
        (
            "Point 3 can turn freely about point 1 here (their circles are one): give it a "
            "direction, points.3.gamma, in degrees."
        ),
    ),
}


@table(SIX_CREASE)
def test_a_six_crease_tube_refuses(row: Refusal) -> None:
    refused(six_crease.DESIGN, InvalidParameters, row)


NO_TUBE: dict[str, Refusal] = {
    "L above L_b": (
        {"L": 60, "phi": 90, **heights()},
        (
            "Point 2 has no place: L = 60 mm is more than L_b = 36.1803 mm, the most for φ = 90° "
            "(23.8 mm too many). Make L smaller, or turn φ away from 90°."
        ),
    ),
    "no candidate": (
        {"L": 30, "phi": 90, "beta": 90, **heights()},
        "Point 3 has no place: point 2 is 10.7",
    ),
}


@table(NO_TUBE)
def test_a_six_crease_tube_has_no_place_for_a_point(row: Refusal) -> None:
    refused(six_crease.DESIGN, ImpossibleGeometry, row)


def test_a_point_without_a_candidate_is_told_with_what_is_missing() -> None:
    said = r"and only 10 mm of paper reach there \(0\.\d+ mm too few\)\. Bring point 2 nearer"
    with pytest.raises(ImpossibleGeometry, match=said):
        six_crease.DESIGN.run(NO_TUBE["no candidate"][0])


@pytest.mark.parametrize(("heights", "signs"), [("0 1 5 6", "+"), ("0 1 5 6", "+-+")])
def test_a_wrong_number_of_branches_is_refused(heights: str, signs: str) -> None:
    said = f"4 points need 2 branches, each + or -, for the points from 3 on, not '{signs}'."
    with pytest.raises(InvalidParameters, match=re.escape(said)):
        points_of(heights, signs)


@pytest.mark.parametrize("t", [-0.01, 1.01, NAN])
def test_an_arc_wider_than_the_closed_tubes_or_less_than_none_is_refused(t: float) -> None:
    motion = six_crease.DESIGN.run(six_crease.DESIGN.preset("ball")).motions["along-arc"]
    said = f"The motion 'along-arc' goes from t = 0 to 1, not to {t:g}."
    with pytest.raises(InvalidParameters, match=re.escape(said)):
        motion.at(t)


TUCK: dict[str, Refusal] = {
    "r not a number": (
        stool(p4={"r": NAN, "z": 0}),
        "points.4.r must be a finite number, not NaN.",
    ),
    "z infinite": (stool(p4={"r": 90, "z": INF}), "points.4.z must be a finite number, not inf."),
    "t not a number": (
        stool({"point": 4, "t": NAN}),
        "tucks.0.t must be a finite number, not NaN.",
    ),
    "t infinite": (stool({"point": 4, "t": INF}), "tucks.0.t must be a finite number, not inf."),
    "another side": (stool({"point": 4, "side": 0}), "tucks.0.side must be -1 or 1, not 0."),
    "triangle turned over": (
        stool(p4={"r": 65.2, "z": -125.1}, p5={"a": 250.3}, p6={"a": 246.5, "branch": -1}),
        "Point 6 turns the triangle 4-5-6 over; give it a larger a.",
    ),
}


@table(TUCK)
def test_a_tucked_form_refuses(row: Refusal) -> None:
    refused(tuck.DESIGN, InvalidParameters, row)


NO_TUCK: dict[str, Refusal] = {
    "no candidate": (
        stool(p4={"r": 135.7, "z": -111.2}),
        (
            "Point 6 has no place: point 5 is 68.644 mm from its plane, and only 44.1725 mm of "
            "paper reach there (24.5 mm too few). Bring point 5 nearer to the axis, or move it "
            "outwards in the pattern."
        ),
    ),
    "line crossed": (
        stool(p4={"r": 202.6, "z": -28.7}),
        (
            "Point 4 crosses its symmetry line by 59.13 mm in the pattern: there is no paper for "
            "it (the angles about point 2 exceed 360°). Move it back by r or z."
        ),
    ),
    "gap too short": (
        stool(p4={"r": 44.9, "z": -15.9}),
        "The gap beside point 4 is too short: points 2 and 6 are ",
    ),
    "t off its segment": (
        stool({"point": 4, "t": 300}),
        (
            "The tuck beside point 4 has t = 300 mm, off its segment: give it a value between "
            "119.063 and 238.7 mm."
        ),
    ),
    "t before its segment": (
        stool({"point": 4, "t": 100}),
        "The tuck beside point 4 has t = 100 mm, off its segment",
    ),
    "no T": (
        stool({"point": 4, "t": 120}),
        (
            "The tuck beside point 4 has no place in space at t = 120 mm: give it a value between "
            "122.605 and 236.726 mm."
        ),
    ),
    "penetrating t": (
        stool({"point": 4, "t": 125}),
        "The tuck beside point 4 penetrates the form at t = 125 mm; between 131.",
    ),
    "no t that is free": (
        stool(p4={"r": 96.2, "z": -64}, p5={"a": 297.2}, p6={"a": 273.1, "branch": -1}),
        (
            "The tuck beside point 4 penetrates the form wherever its corner lies between "
            "t = 131.818 and 247.505 mm. Move point 4."
        ),
    ),
    "flap triangle inverted": (
        BASKET | {"tucks": [{"point": 5, "t": 280}, {"point": 7, "t": 240}]},
        (
            "The corner beside point 7 has t = 240 mm, out of order: the corner beside point 5 "
            "is at 280 mm. Give it more than that."
        ),
    ),
}


@table(NO_TUCK)
def test_a_blank_that_cannot_be_tucked_is_refused(row: Refusal) -> None:
    refused(tuck.DESIGN, ImpossibleGeometry, row)
