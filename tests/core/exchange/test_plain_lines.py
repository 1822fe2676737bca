"""ORIPA's two formats hold every line of a pattern that folds flat, and refuse what they cannot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from random_patterns import SIDE, folds

from foldmill import CreasePattern, Fold, UnreadableFile
from foldmill.errors import InvalidInput
from foldmill.exchange import cp, opx, plain_lines, read
from foldmill.exchange.drawing import Drawing
from foldmill.exchange.limits import Limits

SAMPLES = Path(__file__).parents[2] / "samples"
BEAN = (
    '<java><object class="a.OriLineProxy"><void property="x0"><double>{}</double></void>'
    "</object></java>"
)


def _ends(drawing: Drawing) -> list[list[float]]:
    return [[*a, *b] for a, b in map(sorted, drawing.upright().tolist())]


@given(folds())
@settings(max_examples=30)
def test_lines_come_back_to_the_last_digit(fold: Fold) -> None:
    own = np.flatnonzero(~np.asarray(fold.pattern.added, bool))
    ends = fold.pattern.vertices[fold.pattern.edges[own]].tolist()
    wanted = [[*a, *b] for a, b in map(sorted, ends)]
    letters = [fold.pattern.letters()[k] for k in own]
    for back in (cp.read(cp.write(fold)), opx.read(opx.write(fold).encode())):
        assert _ends(back) == wanted
        assert [look.letter for look in back.looks] == letters


def test_what_is_up_on_the_sheet_is_up_on_the_screen() -> None:
    pattern = CreasePattern.from_lines([[0, 0], [9, 0], [0, 5]], [[0, 1], [1, 2], [2, 0]], "BBB")
    rows = [row.split() for row in cp.write(Fold(pattern)).splitlines()]
    assert ["1", "9.0", "0.0", "0.0", "-5.0"] in rows  # a screen's y grows downward


def test_a_canvas_is_filled_about_its_middle() -> None:
    points = np.array([[0, 0], [SIDE, 0], [SIDE, 10], [0, 10]]) + 7
    fold = Fold(CreasePattern.from_lines(points, [[0, 1], [1, 2], [2, 3], [3, 0]], "BBBB"))
    drawn = cp.read(cp.write(fold, canvas=plain_lines.CANVAS)).segments.reshape(-1, 2)
    assert drawn.min(axis=0).tolist() == [-200, -100]
    assert drawn.max(axis=0).tolist() == [200, 100]


def test_losses_are_told_and_unassigned_creases_refused() -> None:
    square = [[0, 0], [9, 0], [9, 9], [0, 9]]
    lines = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]]
    partly = Fold(CreasePattern.from_lines(square, lines, "BBBBV", [0, 0, 0, 0, 90]))
    assert plain_lines.losses(partly) == (
        "1 creases fold only partly; the file holds no fold angles.",
    )
    with pytest.raises(InvalidInput, match="1 creases are neither mountain nor valley"):
        cp.write(Fold(CreasePattern.from_lines(square, lines, "BBBBU")))


def test_a_property_left_out_of_a_bean_is_0() -> None:
    proxy = (
        '<java><object class="oripa.OriLineProxy"><void property="type"><int>2</int></void>'
        '<void property="x1"><double>5</double></void></object></java>'
    )
    drawing = opx.read(proxy.encode())
    assert drawing.segments.tolist() == [[[0, 0], [5, 0]]]
    assert drawing.looks[0].letter == "M"


def test_types_beyond_the_known_ones_are_auxiliary() -> None:
    letters = [look.letter for look in cp.read("0 0 0 1 0\n1 0 0 0 1\n4 0 0 1 1\n7 1 1 2 2").looks]
    assert letters == ["F", "B", "F", "F"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no lines"),
        ("2 0 0 100\n", "Line 1 must be a type and four"),
        ("1 0 0 1 1\nhello\n", "Line 2 must be a type"),
        ("2 0 0 nan 5", "line 1 are not all numbers"),
        ("2 0 0 inf 5", "line 1 are not all numbers"),
        ("2 0 0 1e300 5", "line 1 are not all numbers"),
        ("-1 0 0 1 1", "Line 1 must be"),
        ("2.5 0 0 1 1", "Line 1 must be"),
        ("123456789 0 0 1 1", "Line 1 must be"),
    ],
)
def test_a_broken_cp_is_refused_with_its_line(text: str, said: str) -> None:
    with pytest.raises(UnreadableFile, match=said):
        cp.read(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no element found"),
        ("<java>", "no element found"),
        ("<java/>", "no lines"),
        ("<svg/>", "begins with <java>"),
        ("PK\x03\x04", "This is no XML"),
        (
            BEAN.format("two"),
            "The x0 of line 1 is 'two'",
        ),
        (
            BEAN.format("NaN"),
            "line 1 are not all numbers",
        ),
        (
            '<!DOCTYPE java [<!ENTITY a "b">]><java>&a;</java>',
            "declarations of its own",
        ),
    ],
)
def test_a_broken_opx_is_refused(text: str, said: str) -> None:
    with pytest.raises(UnreadableFile, match=said):
        opx.read(text.encode())


def test_too_many_lines_are_refused_before_they_are_all_read() -> None:
    with pytest.raises(UnreadableFile, match="more than 3 lines"):
        cp.read("1 0 0 1 1\n" * 5, Limits(lines=3))


def test_a_fold_file_made_by_copying_an_opx_is_its_mirror_image() -> None:
    """The two files of one author hold the same numbers; only one of the formats has y downward."""
    drawing = opx.read((SAMPLES / "ff_pinwheel.opx").read_bytes())
    sheet = read((SAMPLES / "ff_pinwheel.fold").read_text("utf-8")).pattern
    ends = sheet.vertices[sheet.edges[~np.asarray(sheet.added)]] * 400 - 200
    as_written = {tuple(map(tuple, sorted(line))) for line in drawing.segments.tolist()}
    as_seen = {tuple(map(tuple, sorted(line))) for line in drawing.upright().tolist()}
    known = {tuple(map(tuple, sorted(line))) for line in ends.tolist()}
    assert as_written == known
    assert as_seen != known  # the pinwheel turns, so it differs from its mirror image
