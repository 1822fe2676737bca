"""What a DXF shows is what is read, whatever the library's version, unit, block or curve."""

from __future__ import annotations

from io import StringIO
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from ezdxf.filemanagement import new

from foldmill import UnreadableFile
from foldmill.exchange.drawing import Drawing
from foldmill.exchange.limits import DEFAULT
from foldmill.exchange.options import Options
from foldmill_fabricate.importing import dxf, read_pattern


def text(document: Any) -> bytes:
    out = StringIO()
    document.write(out)
    return out.getvalue().encode()


def drawn(document: Any) -> Drawing:
    return dxf.read(text(document), Options(), DEFAULT)


def sheet(version: str = "R2000", units: int = 4) -> Any:
    document = new(version, units=units)
    box = [(0, 0), (100, 0), (100, 100), (0, 100), (0, 0)]
    for a, b in pairwise(box):
        document.modelspace().add_line(a, b, dxfattribs={"layer": "Outline"})
    return document


@pytest.mark.parametrize("version", ["R12", "R2000", "R2010", "R2018"])
def test_every_version_is_read(version: str) -> None:
    document = sheet(version)
    document.modelspace().add_line((0, 0), (100, 100), dxfattribs={"color": 1})
    fold = read_pattern(text(document), Options(unit="mm"), name="x.dxf").fold
    assert np.ptp(fold.pattern.vertices, axis=0).tolist() == [100, 100]
    assert fold.pattern.letters().count("M") == 1


@pytest.mark.parametrize(
    ("number", "millimetres"), [(0, None), (1, 25.4), (4, 1), (5, 10), (6, 1e3)]
)
def test_the_unit_is_that_of_the_header(number: int, millimetres: float | None) -> None:
    assert drawn(sheet(units=number)).millimetres == millimetres


def test_a_file_of_lines_alone_says_no_unit_and_is_asked() -> None:
    entity = "0\nLINE\n8\nMountainLine\n62\n1\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n"
    ends = [(0, 0, 6, 0), (6, 0, 6, 6), (6, 6, 0, 0)]
    soup = "0\nSECTION\n2\nENTITIES\n" + "".join(entity.format(*e) for e in ends) + "0\nENDSEC\n"
    found = read_pattern(soup.encode() + b"0\nEOF\n", name="soup.dxf")
    assert [question.option for question in found.questions] == ["--width"]
    assert "import-outline" in {finding.code for finding in found.fold.findings}


def test_colours_are_those_of_the_entity_or_of_its_layer() -> None:
    document = sheet("R2010")
    document.layers.add("folds", color=5)
    space = document.modelspace()
    for look in ({"color": 1}, {"layer": "folds"}, {"true_color": 0x00FF00, "layer": "folds"}):
        space.add_line((0, 0), (100, 100), dxfattribs=look)
    found = [look.hex for look in drawn(document).looks[4:]]
    assert found == ["#ff0000", "#0000ff", "#00ff00"]


def test_blocks_are_set_in_where_they_are_and_on_the_layer_of_the_block() -> None:
    document = sheet()
    block = document.blocks.new("crease")
    block.add_line((0, 0), (1, 0))
    block.add_line((0, 0), (0, 1), dxfattribs={"layer": "Valley"})
    document.modelspace().add_blockref(
        "crease", (10, 20), dxfattribs={"xscale": 5, "yscale": 2, "layer": "Mountain"}
    )
    document.modelspace().add_blockref(
        "crease", (0, 0), dxfattribs={"column_count": 3, "column_spacing": 7, "layer": "Mountain"}
    )
    drawing = drawn(document)
    assert drawing.segments[4:6].tolist() == [[[10, 20], [15, 20]], [[10, 20], [10, 22]]]
    assert [look.layers for look in drawing.looks[4:6]] == [("Mountain",), ("Valley",)]
    assert len(drawing.segments) == 4 + 2 + 6


def test_a_block_within_itself_is_refused() -> None:
    document = sheet()
    block = document.blocks.new("snake")
    block.add_blockref("snake", (1, 1))
    document.modelspace().add_blockref("snake", (0, 0))
    with pytest.raises(UnreadableFile, match="'snake' is set into itself"):
        drawn(document)


@pytest.mark.parametrize("kind", ["arc", "circle", "bulge", "ellipse"])
def test_curves_are_chords_that_stray_by_little(kind: str) -> None:
    document = new("R2000", units=4)
    space = document.modelspace()
    if kind == "arc":
        space.add_arc((0, 0), 50, 0, 90)
    elif kind == "circle":
        space.add_circle((0, 0), 50)
    elif kind == "bulge":
        space.add_lwpolyline([(50, 0, 0, 0, 1), (-50, 0)])
    else:
        space.add_ellipse((0, 0), (50, 0), 1.0)
    drawing = drawn(document)
    radius = np.hypot(*drawing.segments.reshape(-1, 2).T)
    assert np.allclose(radius, 50, atol=0.02)
    middle = np.hypot(*drawing.segments.mean(axis=1).T)
    assert middle.min() > 50 - 0.2
    assert drawing.notes[0].startswith("1 curves became chords")


def test_a_spline_ends_where_it_ends() -> None:
    document = new("R2000", units=4)
    document.modelspace().add_open_spline([(0, 0), (10, 20), (30, 20), (40, 0)])
    drawing = drawn(document)
    assert np.allclose(drawing.segments[0, 0], [0, 0])
    assert np.allclose(drawing.segments[-1, 1], [40, 0])
    assert len(drawing.segments) > 5


def test_what_is_switched_off_or_no_line_is_left_out_and_told() -> None:
    document = sheet()
    document.layers.add("hidden", color=1).off()
    space = document.modelspace()
    space.add_line((0, 0), (9, 9), dxfattribs={"layer": "hidden"})
    space.add_text("fold here")
    drawing = drawn(document)
    assert len(drawing.segments) == 4
    (note,) = drawing.notes
    assert "1 TEXT, 1 entities on layers that are switched off" in note


def test_y_of_a_dxf_points_upward() -> None:
    assert not drawn(sheet()).down


def test_a_mountain_in_blue_is_a_mountain_by_its_layer_and_a_valley_by_colour() -> None:
    """One program of the trade writes its layer Mountain in blue and Valley in red."""
    document = sheet()
    document.layers.add("Mountain", color=5)
    document.modelspace().add_line((0, 0), (100, 100), dxfattribs={"layer": "Mountain"})
    for by, letter in (("auto", "M"), ("layer", "M")):
        fold = read_pattern(text(document), Options(by=by), name="x.dxf").fold
        assert fold.pattern.letters().count(letter) == 1
    said = Options(by="colour", named={"Outline": "B"})
    assert read_pattern(text(document), said, name="x.dxf").fold.pattern.letters().count("V") == 1


def test_lines_may_end_as_windows_ends_them() -> None:
    document = sheet()
    document.modelspace().add_line((0, 20), (100, 50), dxfattribs={"layer": "Mountain"})
    found = dxf.read(text(document).replace(b"\n", b"\r\n"), Options(), DEFAULT)
    assert found.segments.tolist() == drawn(document).segments.tolist()
    assert [look.layers for look in found.looks] == [("Outline",)] * 4 + [("Mountain",)]
    assert found.millimetres == 1


def test_what_a_cad_program_never_shows_or_prints_is_no_crease() -> None:
    document = sheet()
    space = document.modelspace()
    document.layers.add("Frozen").freeze()
    block = document.blocks.new("PART")
    block.add_line((0, 0), (100, 100), dxfattribs={"layer": "Valley"})
    space.add_blockref("PART", (0, 0), dxfattribs={"layer": "Frozen"})
    space.add_line((0, 100), (100, 0), dxfattribs={"layer": "Valley", "invisible": 1})
    space.add_line((-5, -5), (105, -5), dxfattribs={"layer": "Defpoints"})
    found = drawn(document)
    assert {look.layers for look in found.looks} == {("Outline",)}
    assert "invisible" in found.notes[0]
    assert "frozen" in found.notes[0]


def test_a_block_gives_its_lines_its_true_colour() -> None:
    document = sheet("R2010")
    document.blocks.new("PART").add_line((0, 20), (100, 50), dxfattribs={"color": 0})
    insert = document.modelspace().add_blockref("PART", (0, 0), dxfattribs={"color": 1})
    insert.dxf.true_color = 0x0000FF
    assert drawn(document).looks[-1].colour == (0, 0, 255)


def test_a_small_curve_in_a_long_outline_is_as_round_as_one_by_itself() -> None:
    document = new("R2000", units=4)
    quarter = 2**0.5 - 1  # the bulge of a right angle
    corners = [(0, 0, 0), (1800, 0, quarter), (2000, 200, 0), (2000, 900, 0), (0, 900, 0)]
    document.modelspace().add_lwpolyline(corners, format="xyb", close=True)
    lines = drawn(document).segments
    middle = lines.mean(axis=1)
    bent = middle[(middle[:, 0] > 1800) & (middle[:, 1] < 200)]
    strays = 200 - np.hypot(*(bent - [1800, 200]).T)
    assert len(bent) >= 4
    assert strays.max() <= 200 * np.pi / 2 / 2000
