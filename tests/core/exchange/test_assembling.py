"""Lines become one sheet: joined where they nearly meet, outlined by what the paper does."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill import Fold, InvalidPattern, UnreadableFile
from foldmill.check import check
from foldmill.exchange.assembling import fold_of
from foldmill.exchange.drawing import Look, drawing_of
from foldmill.exchange.limits import Limits
from foldmill.exchange.options import Options
from foldmill.finding import Severity

BOX = [(0, 0, 100, 0), (100, 0, 100, 100), (100, 100, 0, 100), (0, 100, 0, 0)]


def sheet(lines: Sequence[Sequence[float]], letters: str, **said: object) -> Fold:
    drawing = drawing_of(lines, [Look(letter) for letter in letters], down=False, millimetres=1.0)
    return fold_of(drawing, Options(**said))  # type: ignore[arg-type]


def codes(fold: Fold) -> set[str]:
    return {finding.code for finding in fold.findings}


def lines(fold: Fold, letter: str) -> int:
    letters = np.array(list(fold.pattern.letters()))
    return int(((letters == letter) & ~np.asarray(fold.pattern.added)).sum())


def test_creases_are_split_where_they_cross() -> None:
    fold = sheet([*BOX, (0, 0, 100, 100), (0, 100, 100, 0)], "BBBBMV")
    assert (lines(fold, "M"), lines(fold, "V"), len(fold.pattern.vertices)) == (2, 2, 5)
    assert codes(fold) == {"mended-crossing"}


@pytest.mark.parametrize("miss", [0.0, 0.005, 0.05])
def test_ends_that_nearly_meet_are_joined(miss: float) -> None:
    fold = sheet([*BOX, (miss, 50, 100 - miss, 50)], "BBBBM")
    assert lines(fold, "M") == 1
    assert ("import-gap" in codes(fold)) == (miss == 0.05)


def test_ends_that_are_farther_apart_are_asked_for() -> None:
    drawn = [*BOX, (0, 50, 99, 50)]
    with pytest.raises(UnreadableFile, match=r"ends inside the sheet .* near \(49.5, 50\) mm"):
        sheet(drawn, "BBBBM")
    assert lines(sheet(drawn, "BBBBM", gap=1.5), "M") == 1
    dropped = sheet(drawn, "BBBBM", loose="drop")
    assert lines(dropped, "M") == 0
    assert {"import-loose", "import-no-crease"} <= codes(dropped)


def test_what_reaches_beyond_the_outline_is_cut_off() -> None:
    fold = sheet([*BOX, (-7, 50, 120, 50)], "BBBBM")
    assert lines(fold, "M") == 1
    assert np.ptp(fold.pattern.vertices, axis=0).tolist() == [100, 100]
    assert fold.pattern.vertices.min(axis=0).tolist() == [0, 0]
    assert "import-overshoot" in codes(fold)


def test_a_cut_with_paper_on_both_sides_is_an_inner_cut_whatever_it_is_called() -> None:
    for letter in "BC":
        fold = sheet([*BOX, (0, 50, 100, 50), (50, 0, 50, 50)], f"BBBBM{letter}")
        assert (lines(fold, "C"), lines(fold, "B")) == (1, 7)


def test_an_outline_called_cut_is_the_outline() -> None:
    assert lines(sheet([*BOX, (0, 0, 100, 100)], "CCCCM"), "B") == 4


def test_without_an_outline_the_outermost_lines_are_taken_and_it_is_told() -> None:
    fold = sheet([*BOX, (0, 0, 100, 100)], "FFFFM")
    assert lines(fold, "B") == 4
    (finding,) = fold.findings
    assert (finding.code, finding.severity) == ("import-outline", Severity.WARNING)


def test_an_outline_with_a_gap_in_it_is_refused_by_its_place() -> None:
    with pytest.raises(UnreadableFile, match=r"There is no outline at \(100, 50\) mm"):
        sheet([*BOX, (0, 0, 100, 100)], "BMBBM")


def test_the_stronger_of_two_lines_upon_each_other_stays() -> None:
    fold = sheet([*BOX, (0, 0, 100, 0), (0, 0, 100, 100), (100, 100, 0, 0)], "BBBBMVF")
    assert (lines(fold, "B"), lines(fold, "V"), lines(fold, "M"), lines(fold, "F")) == (4, 1, 0, 0)
    assert "mended-overlap" in codes(fold)


def test_parts_that_do_not_touch_are_refused() -> None:
    with pytest.raises(UnreadableFile, match=r"2 groups that do not touch .* near \(200, 0\) mm"):
        sheet([*BOX, (200, 0, 210, 0), (210, 0, 200, 10), (200, 10, 200, 0)], "BBBBBBB")


def test_a_bridge_between_two_sheets_is_refused() -> None:
    other = [(200, 0, 210, 0), (210, 0, 200, 10), (200, 10, 200, 0)]
    with pytest.raises(UnreadableFile, match="hang on each other by points or lines"):
        sheet([*BOX, *other, (100, 0, 200, 0)], "BBBBBBBM")


def test_the_sheet_lies_with_its_lower_left_corner_at_zero() -> None:
    moved = np.array(BOX, float) + 1000
    assert sheet(moved.tolist(), "BBBB").pattern.vertices.min(axis=0).tolist() == [0, 0]


def test_an_invisible_crease_is_flat() -> None:
    looks = [*[Look("B")] * 4, Look("M", opacity=0.0)]
    drawing = drawing_of([*BOX, (0, 0, 100, 100)], looks, down=False)
    assert lines(fold_of(drawing, Options()), "F") == 1


@given(
    st.lists(
        st.tuples(st.integers(0, 8), st.integers(0, 8), st.booleans()), unique_by=lambda s: s[:2]
    )
)
@settings(max_examples=30)
def test_slits_that_end_inside_the_sheet_are_inner_cuts(slits: list[tuple[int, int, bool]]) -> None:
    cuts = [
        (5 + 10 * x, 6 + 10 * y, 5 + 10 * x + (6 if flat else 0), 6 + 10 * y + (0 if flat else 6))
        for x, y, flat in slits
    ]
    fold = sheet([*BOX, (50, 0, 50, 100), *cuts], "BBBBM" + "C" * len(cuts))
    pattern = fold.pattern
    crossing = sum(x == 4 and flat for x, _, flat in slits)  # the crease at 50 is crossed by these
    assert lines(fold, "C") == len(cuts) + crossing
    length = pattern.edge_lengths[np.array(list(pattern.letters())) == "C"].sum()
    assert length == pytest.approx(6 * len(cuts))
    assert lines(fold, "B") == 6
    assert not check(fold).has_errors


def test_holes_float_where_a_cut_goes_round_them() -> None:
    hole = [(20, 20, 40, 20), (40, 20, 30, 40), (30, 40, 20, 20)]
    within = [(28, 25, 32, 25), (32, 25, 30, 30), (30, 30, 28, 25)]
    fold = sheet([*BOX, (0, 100, 100, 0), *hole, *within], "BBBBMCCCBBB")
    assert lines(fold, "C") == 6
    assert {"import-tied", "import-inner-cut"} <= codes(fold)
    assert not check(fold).has_errors


def test_a_crease_that_floats_is_refused() -> None:
    with pytest.raises(UnreadableFile, match="2 groups that do not touch"):
        sheet([*BOX, (20, 20, 40, 20), (40, 20, 30, 40), (30, 40, 20, 20)], "BBBBMMM")
    with pytest.raises(UnreadableFile, match="ends inside the sheet"):
        sheet([*BOX, (20, 20, 40, 20)], "BBBBM")


def test_slits_so_dense_that_few_ties_do_not_do_are_filled_about() -> None:
    chance = random.Random(0)
    cuts = []
    for x, y in chance.sample([(x, y) for x in range(5) for y in range(5)], 25):
        flat = chance.random() < 0.5
        left, low = 5 + 10 * x + chance.uniform(-2, 2), 6 + 10 * y + chance.uniform(-1, 1)
        cuts.append((left, low, left + 6 * flat, low + 6 * (not flat)))
    fold = sheet([*BOX, *cuts], "BBBB" + "C" * len(cuts))
    assert lines(fold, "C") == len(cuts)
    assert lines(fold, "F") > 2 * len(cuts)
    assert not check(fold).has_errors


def test_creases_in_a_strip_nobody_can_fold_are_refused_by_place_and_width() -> None:
    drawn = [*BOX, (0, 40, 100, 40), (0, 40.008, 100, 39.996)]
    with pytest.raises(UnreadableFile, match=r"side by side at .* mm, 0\.\d+ mm apart") as refused:
        sheet(drawn, "BBBBMV")
    assert "--gap" in str(refused.value)
    kept = sheet(drawn, "BBBBMV", gap=0.001)
    assert (lines(kept, "M"), lines(kept, "V")) == (2, 2)


def test_dashes_drawn_one_by_one_are_told_to_be_one_line() -> None:
    dashes = [(x, 50, x + 4, 50) for x in range(5, 95, 9)]
    with pytest.raises(UnreadableFile, match=r"10 lines end inside .* If they are dashes, draw"):
        sheet([*BOX, *dashes], "BBBB" + "M" * len(dashes))
    with pytest.raises(UnreadableFile) as few:
        sheet([*BOX, *dashes[:3]], "BBBBMMM")
    assert "dashes" not in str(few.value)


def test_an_outline_that_is_drawn_as_creases_is_asked_about() -> None:
    # As for a laser: red is cut, the square in the middle too, and blue is scored.
    hole = [(40, 40, 60, 40), (60, 40, 60, 60), (60, 60, 40, 60), (40, 60, 40, 40)]
    drawn = [*BOX, *hole, (0, 50, 40, 50), (60, 50, 100, 50)]
    told = {each.code: each for each in sheet(drawn, "MMMMMMMMVV").findings}["import-outline"]
    assert "drawn as M" in str(told.remedy)
    assert "=C" in str(told.remedy)
    assert lines(sheet(drawn, "CCCCCCCCVV"), "C") == 6


def test_a_drawing_in_one_kind_of_line_says_how_to_score_its_inside() -> None:
    black = sheet([*BOX, (0, 50, 100, 50)], "BBBBB")
    told = {each.code: each for each in black.findings}["import-no-crease"]
    assert "cut through" in str(told.remedy)
    told_u = sheet([*BOX, (0, 50, 100, 50)], "UUUUU")
    assert (lines(told_u, "B"), lines(told_u, "U")) == (6, 1)


def test_a_drawing_whose_lines_cross_too_often_is_refused_before_it_is_cut_up() -> None:
    spread = range(1, 20)
    drawn = [
        *BOX,
        *((0, 5 * k, 100, 5 * k) for k in spread),
        *((5 * k, 0, 5 * k, 100) for k in spread),
    ]
    drawing = drawing_of(drawn, [Look(x) for x in "BBBB" + 38 * "M"], down=False, millimetres=1.0)
    assert lines(fold_of(drawing, Options()), "M") == 2 * 19 * 20
    with pytest.raises(InvalidPattern, match=r"42 lines cross or meet .* the most .* is 500\."):
        fold_of(drawing, Options(), Limits(lines=500))
