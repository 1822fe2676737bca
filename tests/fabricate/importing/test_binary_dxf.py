"""A binary DXF is read as the text drawing it stands for, within the same bounds."""

from __future__ import annotations

from contextlib import suppress
from io import BytesIO, StringIO
from typing import Any

import pytest
from ezdxf import units
from ezdxf.filemanagement import new

from foldmill import UnreadableFile
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.options import Options
from foldmill_fabricate.importing import dxf, read_pattern


def document(version: str = "R2000") -> Any:
    made = new(version, units=units.CM)
    made.layers.add("Tälfalz", color=5)
    block = made.blocks.new("unit")
    block.add_line((0, 0), (1, 1), dxfattribs={"color": 1})
    space = made.modelspace()
    space.add_lwpolyline([(0, 0), (9, 0), (9, 9), (0, 9)], close=True) if version != "R12" else None
    space.add_line((0, 4.5), (9, 4.5), dxfattribs={"layer": "Tälfalz"})
    space.add_blockref("unit", (3, 4.5))
    space.add_arc((4, 4), 2, 0, 90)
    return made


def both(made: Any) -> tuple[bytes, bytes]:
    """The same drawing in text and in binary, both as the library writes them."""
    text, binary = StringIO(), BytesIO()
    made.write(text)
    made.write(binary, fmt="bin")
    return text.getvalue().encode(), binary.getvalue()


@pytest.mark.parametrize("version", ["R12", "R2000", "R2007", "R2018"])
def test_a_binary_drawing_is_what_its_text_is(version: str) -> None:
    text, binary = both(document(version))
    assert binary.startswith(b"AutoCAD Binary DXF")
    one, two = (dxf.read(content, Options(), DEFAULT) for content in (text, binary))
    assert one.segments.tolist() == two.segments.tolist()
    assert one.looks == two.looks
    assert (one.millimetres, one.notes) == (two.millimetres, two.notes)


def test_a_binary_drawing_is_known_without_its_suffix() -> None:
    made = new("R2000", units=units.MM)
    for a, b in [((0, 0), (9, 0)), ((9, 0), (9, 9)), ((9, 9), (0, 0))]:
        made.modelspace().add_line(a, b)
    found = read_pattern(both(made)[1], name="upload")
    assert (found.format, len(found.fold.pattern.edges)) == ("dxf", 3)


def test_what_breaks_off_anywhere_is_read_or_refused() -> None:
    binary = both(document())[1]
    for end in range(22, len(binary), len(binary) // 40):
        with suppress(UnreadableFile):
            assert dxf.read(binary[:end], Options(), DEFAULT).segments.size


def test_bounds_hold_before_anything_is_made() -> None:
    binary = both(document())[1]
    with pytest.raises(UnreadableFile, match="more than 10 elements"):
        dxf.read(binary, Options(), Limits(elements=10))
    with pytest.raises(UnreadableFile, match="MB are read"):
        dxf.read(binary, Options(), Limits(size=len(binary)))
