"""DXF cutting drawings: role layers and colours of their own on every entity, mm, R2000 or R12."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from io import StringIO
from typing import TYPE_CHECKING, Literal

from foldmill import Fold
from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.profiles import Layer, Style, find

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts.layout import Modelspace

Version = Literal["R2000", "R12"]
Copies = dict[str, list[tuple[str, list[list[float]]]]]
"""By the handle of a straight line: handles and ends of those that follow it and look like it."""
UNITS = {"R2000": 4, "R12": 0}
"""The value of $INSUNITS: mm, or none where the header has no such variable."""


def write(plan: Plan, fold: Fold, style: Style | None = None) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return ``front.dxf``, ``reverse.dxf`` (as the machine sees it) and ``master.dxf``.

    style : names and colours of layers, and the version; R12 has no unit in its header and knows no
    LWPOLYLINE, for old software only.
    """
    chosen = style or Style(find())
    views = d.drawings(plan, chosen.profile)
    return {f"{view.name}.dxf": one(view, chosen.dxf) for view in views}


def one(view: d.Drawing, version: Version = "R2000") -> bytes:
    """Return one drawing as a DXF file."""
    from ezdxf.filemanagement import new

    with _without_clock():
        document = new(version, units=UNITS[version])
        space = document.modelspace()
        space.reset_extents((0, 0, 0), (view.width, view.height, 0))
        space.reset_limits((0, 0), (view.width, view.height))
        _add_layers(document, view)
        copies: Copies = {}
        for group in view.groups:
            copies |= _add_lines(space, group.layer, group.lines)
        copies |= _add_lines(space, view.layers.anchor, tuple(d.anchors(view.width, view.height)))
        _add_note(space, view)
        return _to_bytes(document, copies)


@contextmanager
def _without_clock() -> Iterator[None]:
    """Let ezdxf write fixed dates and identifiers, and give it back its own options afterwards.

    That R12 holds no unit is said here, where it is chosen, and not on every run.
    """
    from ezdxf import options  # type: ignore[attr-defined]  # public, though not in __all__

    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    logger = logging.getLogger("ezdxf")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)
        options.write_fixed_meta_data_for_testing = before


def _add_layers(document: Drawing, view: d.Drawing) -> None:
    for group in view.groups:
        if group.layer.name not in document.layers:
            document.layers.add(group.layer.name, color=group.layer.aci)
    for layer in (view.layers.anchor, view.layers.note):
        silent = document.layers.add(layer.name, color=layer.aci)
        if document.dxfversion > "AC1009":
            silent.dxf.plot = 0


def _add_lines(space: Modelspace, layer: Layer, lines: tuple[d.Floats, ...]) -> Copies:
    """Add each line once; with a colour of its own, for readers that know no layers.

    Of straight lines in a row only the first is added; returns the others.
    """
    look = {"layer": layer.name, "color": layer.aci}
    found: Copies = {}
    row: list[tuple[str, list[list[float]]]] | None = None
    for line in lines:
        points = line.tolist()
        if len(points) == 2 and row is not None and space.doc is not None:
            row.append((space.doc.entitydb.next_handle(), points))
        elif len(points) == 2:
            first = space.add_line(points[0], points[1], dxfattribs=look)
            row = found[str(first.dxf.handle)] = []
        else:
            row = None
            _add_polyline(space, line, look)
    return found


def _add_polyline(space: Modelspace, line: d.Floats, look: dict[str, object]) -> None:
    closed = d.is_closed(line)
    corners = line[:-1].tolist() if closed else line.tolist()
    polyline = space.add_polyline2d if space.dxfversion == "AC1009" else space.add_lwpolyline
    polyline(corners, close=closed, dxfattribs=look)


def _add_note(space: Modelspace, view: d.Drawing) -> None:
    look = {"layer": view.layers.note.name, "color": view.layers.note.aci}
    space.add_text(view.note, height=d.NOTE_HEIGHT, dxfattribs=look).set_placement(d.NOTE_AT)


def _to_bytes(document: Drawing, copies: Copies) -> bytes:
    """Return the file, with the copies of each line behind it: there may be very many."""
    out = StringIO()
    document.write(out)
    text = out.getvalue()
    parts, done = [], 0
    for handle, others in copies.items():
        begin = text.index(f"  0\nLINE\n  5\n{handle}\n", done)
        end = text.index("\n  0\n", begin) + 1
        parts += [text[done:end], *_like(text[begin:end], others)]
        done = end
    return document.encode("".join([*parts, text[done:]]))


def _like(entity: str, others: list[tuple[str, list[list[float]]]]) -> Iterator[str]:
    """Yield the text of lines like one, each with its own handle and ends."""
    tags = entity.split("\n")
    codes = ["  5", " 10", " 20", " 11", " 21"]
    places = [tags.index(code, 0) + 1 for code in codes]
    for handle, ((x, y), (u, v)) in others:
        for place, value in zip(places, (handle, x, y, u, v), strict=True):
            tags[place] = str(value)
        yield "\n".join(tags)
