"""A pattern that goes out in a format and comes back is the same pattern, line by line."""

from __future__ import annotations

from collections.abc import Callable
from io import StringIO

import numpy as np
import pytest
from ezdxf.filemanagement import new
from hypothesis import given, settings
from hypothesis import strategies as st
from random_patterns import Known, folds, lines_of

from foldmill import CreasePattern, Fold
from foldmill.exchange import cp, opx, write
from foldmill.exchange.options import Options
from foldmill_fabricate.importing import read_pattern
from foldmill_fabricate.pictures import pattern_svg

COLOURS = {"B": 7, "M": 1, "V": 5, "F": 2, "U": 6}
LAYERS = {"B": "Outline", "M": "Mountain folds", "V": "Valley folds", "F": "Facets", "U": "Hinge"}
LAST = {"gap": 1e-3}  # so that nothing is joined that our own files keep apart


def dxf_of(fold: Fold, by: str) -> bytes:
    """Return the pattern as a DXF written by the library alone, by layer or by colour."""
    document = new("R2000", units=4)
    for start, end, letter, _ in lines_of(fold):
        look = {"layer": LAYERS[letter]} if by == "layer" else {"color": COLOURS[letter]}
        document.modelspace().add_line(start, end, dxfattribs=look)
    out = StringIO()
    document.write(out)
    return out.getvalue().encode()


def back(content: bytes, name: str, **said: object) -> Fold:
    return read_pattern(content, Options(**(LAST | said)), name=name).fold  # type: ignore[arg-type]


@given(folds(letters="MVFU", partly=True))
@settings(max_examples=40)
def test_fold_holds_everything(fold: Fold) -> None:
    assert lines_of(back(write(fold).encode(), "x.fold")) == lines_of(fold)


@given(folds(letters="MVFU", partly=True))
@settings(max_examples=40)
def test_svg_holds_everything_fold_angles_as_opacity(fold: Fold) -> None:
    read = read_pattern(pattern_svg(fold), Options(gap=1e-3), name="x.svg")
    assert lines_of(read.fold, 3, 0) == lines_of(fold, 3, 0)
    assert not [each for each in read.questions if each.option == "--width"]  # it is in mm


@given(folds(), st.sampled_from(["cp", "opx"]))
@settings(max_examples=40)
def test_cp_and_opx_hold_what_folds_flat(fold: Fold, format_: str) -> None:
    text = {"cp": cp.write, "opx": opx.write}[format_](fold)
    assert lines_of(back(text.encode(), f"x.{format_}", unit="mm")) == lines_of(fold)


@given(folds(), st.sampled_from(["layer", "colour"]))
@settings(max_examples=15)
def test_dxf_holds_what_folds_flat(fold: Fold, by: str) -> None:
    assert lines_of(back(dxf_of(fold, by), "x.dxf", by=by)) == lines_of(fold)


def chiral() -> Fold:
    """Return a sheet that differs from its mirror image however it is turned."""
    points = [[0, 0], [60, 0], [60, 40], [0, 40], [60, 10], [20, 40]]
    edges = [[0, 1], [1, 4], [4, 2], [2, 5], [5, 3], [3, 0], [0, 4], [0, 5]]
    return Fold(CreasePattern.from_lines(points, edges, "BBBBBBMV"))


def creases(fold: Fold) -> set[Known]:
    """Return the lines that are no facets: only SVG draws those."""
    return {line for line in lines_of(fold, 3) if line[2] != "F"}


FORMATS: dict[str, Callable[[Fold], bytes]] = {
    "x.fold": lambda fold: write(fold).encode(),
    "x.svg": pattern_svg,
    "x.cp": lambda fold: cp.write(fold).encode(),
    "x.opx": lambda fold: opx.write(fold).encode(),
    "x.dxf": lambda fold: dxf_of(fold, "layer"),
}


@pytest.mark.parametrize("name", FORMATS)
def test_no_format_mirrors_a_sheet(name: str) -> None:
    read = back(FORMATS[name](chiral()), name, width=60.0)
    assert creases(read) == creases(chiral())


@pytest.mark.parametrize("name", FORMATS)
def test_seen_from_the_back_left_is_right_and_mountains_are_valleys(name: str) -> None:
    content = FORMATS[name](chiral())
    seen = back(content, name, width=60.0, side="back")
    swapped = {"M": "V", "V": "M", "B": "B"}
    wanted = {
        (*sorted([(60 - a[0], a[1]), (60 - b[0], b[1])]), swapped[letter], -angle + 0.0)
        for a, b, letter, angle in creases(chiral())
    }
    assert creases(seen) == wanted
    mirrored = back(content, name, width=60.0, mirror=True)
    assert {line[:2] for line in creases(mirrored)} == {line[:2] for line in wanted}
    assert mirrored.pattern.letters().count("M") == 1
    assert creases(mirrored) != wanted


def test_a_sheet_turned_over_twice_is_as_it_was() -> None:
    once = write(back(FORMATS["x.fold"](chiral()), "x.fold", side="back"))
    twice = back(once.encode(), "x.fold", side="back")
    assert lines_of(twice) == lines_of(chiral())
    assert np.array_equal(twice.pattern.vertices, chiral().pattern.vertices)
