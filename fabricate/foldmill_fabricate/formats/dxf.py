"""DXF cutting drawings: role layers and colours of their own on every entity, mm, R2000 or R12."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from io import StringIO
from typing import TYPE_CHECKING, Literal

from foldmill import Fold
from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.passes import Plan

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.layouts.layout import Modelspace

Version = Literal["R2000", "R12"]
UNITS = {"R2000": 4, "R12": 0}
"""The value of $INSUNITS: mm, or none where the header has no such variable."""


def write(plan: Plan, fold: Fold, version: Version = "R2000") -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return ``front.dxf``, ``reverse.dxf`` (as the machine sees it) and ``master.dxf``.

    version : R12 has no unit in its header and knows no LWPOLYLINE; for old software only.
    """
    return {f"{view.name}.dxf": _dxf(view, version) for view in d.drawings(plan)}


def _dxf(view: d.Drawing, version: Version) -> bytes:
    from ezdxf.filemanagement import new

    with _without_clock():
        document = new(version, units=UNITS[version])
        space = document.modelspace()
        space.reset_extents((0, 0, 0), (view.width, view.height, 0))
        space.reset_limits((0, 0), (view.width, view.height))
        _add_layers(document, view)
        for group in view.groups:
            _add_lines(space, group.layer, group.lines)
        _add_lines(space, d.ANCHOR, tuple(d.anchors(view.width, view.height)))
        _add_note(space, view)
        return _to_bytes(document)


@contextmanager
def _without_clock() -> Iterator[None]:
    """Let ezdxf write fixed dates and identifiers, and give it back its own option afterwards."""
    from ezdxf import options  # type: ignore[attr-defined]  # public, though not in __all__

    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def _add_layers(document: Drawing, view: d.Drawing) -> None:
    for group in view.groups:
        document.layers.add(group.layer.name, color=group.layer.aci)
    for layer in (d.ANCHOR, d.NOTE):
        silent = document.layers.add(layer.name, color=layer.aci)
        if document.dxfversion > "AC1009":
            silent.dxf.plot = 0


def _add_lines(space: Modelspace, layer: d.Layer, lines: tuple[d.Floats, ...]) -> None:
    """Add each line once; with a colour of its own, for readers that know no layers."""
    look = {"layer": layer.name, "color": layer.aci}
    for line in lines:
        points = line.tolist()
        if len(points) == 2:
            space.add_line(points[0], points[1], dxfattribs=look)
            continue
        closed = d.is_closed(line)
        corners = points[:-1] if closed else points
        polyline = space.add_polyline2d if space.dxfversion == "AC1009" else space.add_lwpolyline
        polyline(corners, close=closed, dxfattribs=look)


def _add_note(space: Modelspace, view: d.Drawing) -> None:
    look = {"layer": d.NOTE.name, "color": d.NOTE.aci}
    space.add_text(view.note, height=d.NOTE_HEIGHT, dxfattribs=look).set_placement(d.NOTE_AT)


def _to_bytes(document: Drawing) -> bytes:
    out = StringIO()
    document.write(out)
    return document.encode(out.getvalue())
