"""Read a DXF drawing: every line and curve of its model space, with its layer and its colour.

DXF has y upward. Blocks are set in, after their number has been counted; curves become chords;
what is switched off, and what is no line, is left out and told.
"""

from __future__ import annotations

import logging
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import suppress
from io import BytesIO, StringIO
from itertools import pairwise
from typing import Any

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.drawing import Drawing, Look, drawing_of
from foldmill.exchange.limits import Limits
from foldmill.exchange.options import Options
from foldmill_fabricate.importing import binary_dxf

_TAG = re.compile(rb"(?:^|\n)[ \t]*0[ \t]*\r?\n")
_HEADER_UNIT = re.compile(rb"\$INSUNITS\s+70\s+(\d{1,3})\b")
_CURVES = {"ARC", "CIRCLE", "ELLIPSE", "SPLINE"}
_LINES = {"LINE", "LWPOLYLINE", "POLYLINE", *_CURVES}
_SHARE = 1 / 2000
"""Of a curve's length that a chord may stray from it, as of curves in SVG."""
_FLAT_SHARE = 1e-6
"""Share of the size by which a drawing may leave its plane."""
_WHITE_OR_BLACK = 7
_NEVER_PLOTTED = "defpoints"
"""A layer of helping points that CAD programs show and never print."""
_BY_LAYER, _BY_BLOCK = 256, 0
_UNITS = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1e3, 9: 0.0254, 10: 914.4, 13: 1e-3, 14: 100.0}
"""mm per unit by the numbers of $INSUNITS; 0 is no unit."""

logging.getLogger("ezdxf").addHandler(logging.NullHandler())  # what it says is said by findings


def recognised(head: bytes) -> bool:
    """Tell by its begin whether a file is a DXF drawing, in text or binary."""
    if head.startswith(binary_dxf.MARK):
        return True
    words = head.removeprefix(b"\xef\xbb\xbf").split(maxsplit=2)[:2]
    return words in ([b"0", b"SECTION"], [b"999"]) or words[:1] == [b"999"]


def read(content: bytes, _options: Options, limits: Limits) -> Drawing:
    """Return the lines of a DXF file; raises UnreadableFile for what is none, or broken."""
    limits.check_size(len(content))
    if content.startswith(binary_dxf.MARK):
        content = binary_dxf.as_text(content, limits)
    limits.check_elements(sum(1 for _ in _TAG.finditer(content)))
    document = _document(content)
    reader = _Reader(document, limits)
    try:
        reader.all()
    except UnreadableFile:
        raise
    except Exception as error:  # a parser of someone else's, over a file of someone else's
        raise UnreadableFile(f"This DXF file is broken: {_brief(error)}.") from None
    return drawing_of(
        reader.segments,
        reader.looks,
        down=False,
        millimetres=_millimetres(content),
        notes=reader.told(),
        limits=limits,
    )


def _document(content: bytes) -> Any:
    """Return the drawing; read as the standard has it, or else with all mercy, which is slow."""
    from ezdxf import filemanagement, recover

    if b"SECTION" not in content:
        raise UnreadableFile("This is no DXF file: it has no section.")
    with suppress(Exception):
        text = content.decode("utf-8", errors="surrogateescape")
        return filemanagement.read(StringIO(text, newline=None))  # as Windows ends lines, too
    try:
        return recover.read(BytesIO(content))[0]
    except Exception as error:  # see above
        raise UnreadableFile(f"This is no DXF file that can be read: {_brief(error)}.") from None


def _brief(error: Exception) -> str:
    said = " ".join(str(error).split()) or type(error).__name__
    return said[:120].rstrip(".")


def _millimetres(content: bytes) -> float | None:
    """Return the mm in a unit of the file; None where its header says none.

    Taken from the text, as a file without a header would be given one with a unit.
    """
    found = _HEADER_UNIT.search(content)
    return _UNITS.get(int(found[1])) if found else None


class _Reader:
    def __init__(self, document: Any, limits: Limits) -> None:
        self.document = document
        self.limits = limits
        self.segments: list[list[float]] = []
        self.looks: list[Look] = []
        self.bent = 0
        self.left: Counter[str] = Counter()
        self.known: dict[tuple[str, int, Any], Look] = {}
        self.heights = [0.0, 0.0]

    def all(self) -> None:
        """Read the model space."""
        space = self.document.modelspace()
        self._count(space)
        for entity in self._set_in(space):
            self._entity(entity)
            self.limits.check_lines(len(self.segments))
        table = np.array(self.segments or [[0.0] * 4])
        if np.ptp(self.heights) > _FLAT_SHARE * np.ptp(table):
            raise UnreadableFile(
                f"The drawing is not flat: its heights differ by {np.ptp(self.heights):.4g}."
            )

    def _count(self, space: Iterable[Any]) -> None:
        """Refuse blocks within blocks that would become too many entities, before they do."""
        counts: dict[str, int] = {}

        def entities(each: Iterable[Any], open_: tuple[str, ...]) -> int:
            total = 0
            for entity in each:
                total += 1 if entity.dxftype() != "INSERT" else inserted(entity, open_)
                self.limits.check_elements(total)
            return total

        def inserted(insert: Any, open_: tuple[str, ...]) -> int:
            name = insert.dxf.name
            if name in open_ or len(open_) > self.limits.depth:
                raise UnreadableFile(f"The block {name!r} is set into itself.")
            block = self.document.blocks.get(name)
            if block is not None and name not in counts:
                counts[name] = entities(block, (*open_, name))
            return max(counts.get(name, 0), 1) * max(int(insert.mcount), 1)

        entities(space, ())

    def _set_in(self, entities: Iterable[Any]) -> Iterator[Any]:
        for entity in entities:
            if entity.dxftype() != "INSERT":
                yield entity
                continue
            if self._is_frozen(entity.dxf.layer) or entity.dxf.get("invisible", 0):
                self.left["blocks that are frozen or invisible"] += 1
                continue
            for each in entity.multi_insert() if entity.mcount > 1 else [entity]:
                yield from self._set_in(_parts(each))

    def _entity(self, entity: Any) -> None:
        kind = entity.dxftype()
        if not self._is_on(entity.dxf.layer):
            self.left["entities on layers that are switched off"] += 1
        elif entity.dxf.get("invisible", 0):
            self.left["entities that are invisible"] += 1
        elif kind not in _LINES:
            self.left[f"{kind}"] += 1
        elif kind == "LINE":
            a, b = entity.dxf.start, entity.dxf.end
            self._add([(a.x, a.y, a.z), (b.x, b.y, b.z)], self._look(entity))
        else:
            self._along(entity, kind)

    def _along(self, entity: Any, kind: str) -> None:
        from ezdxf import path

        try:
            way = path.make_path(entity)
        except TypeError:  # a mesh that calls itself a polyline
            self.left["meshes"] += 1
            return
        self.bent += kind in _CURVES or bool(way.has_curves)
        length = _length(way)
        if not np.isfinite(length):
            raise UnreadableFile(
                f"The coordinates of an entity {kind} are not all numbers of some size."
            )
        if length > 0:
            self._add([(v.x, v.y, v.z) for v in _chords(way)], self._look(entity))

    def _add(self, points: list[tuple[float, float, float]], look: Look) -> None:
        for (x0, y0, z0), (x1, y1, z1) in pairwise(points):
            self.segments.append([x0, y0, x1, y1])
            self.looks.append(look)
            self.heights = [min(self.heights[0], z0, z1), max(self.heights[1], z0, z1)]
        self.limits.check_lines(len(self.segments))

    def _is_on(self, name: str) -> bool:
        layers = self.document.layers
        if name.lower() == _NEVER_PLOTTED or self._is_frozen(name):
            return False
        return name not in layers or not layers.get(name).is_off()

    def _is_frozen(self, name: str) -> bool:
        layers = self.document.layers
        return name in layers and bool(layers.get(name).is_frozen())

    def _look(self, entity: Any) -> Look:
        key = (entity.dxf.layer, entity.dxf.color, entity.dxf.get("true_color"))
        if key not in self.known:
            self.known[key] = Look("", (key[0],), self._colour(*key))
        return self.known[key]

    def _colour(self, layer: str, index: int, true: int | None) -> tuple[int, int, int] | None:
        from ezdxf import colors

        if true is None and index in {_BY_LAYER, _BY_BLOCK} and layer in self.document.layers:
            known = self.document.layers.get(layer)
            index, true = abs(known.dxf.color), known.dxf.get("true_color")
        if true is not None:
            red, green, blue = colors.int2rgb(true)
        elif index == _WHITE_OR_BLACK:
            red, green, blue = 0, 0, 0
        elif 0 < index < _BY_LAYER:
            red, green, blue = colors.aci2rgb(index)
        else:
            return None
        return red, green, blue

    def told(self) -> list[str]:
        """Return sentences on what was left out or drawn otherwise."""
        left = ", ".join(f"{count} {what}" for what, count in sorted(self.left.items()))
        said = [
            f"Left out, as they are no lines that are seen: {left}." if left else "",
            f"{self.bent} curves became chords that stray from them by no more than a "
            f"two-thousandth of their length."
            if self.bent
            else "",
        ]
        return [sentence for sentence in said if sentence]


def _length(way: Any) -> float:
    """Return the length of the corners of a path's curves, of which none is shorter."""
    corners = np.array([(v.x, v.y, v.z) for v in way.control_vertices()], float).reshape(-1, 3)
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())


def _chords(way: Any) -> list[Any]:
    """Return a path's corners, each of its curves as chords by that curve's own length."""
    from ezdxf import path

    found = [way.start]
    for piece in way.commands():
        if piece.type is path.Command.LINE_TO:
            found.append(piece.end)
            continue
        one = path.Path(found[-1])
        if piece.type is path.Command.CURVE4_TO:
            one.curve4_to(piece.end, piece.ctrl1, piece.ctrl2)
        else:
            one.curve3_to(piece.end, piece.ctrl)
        length = _length(one)
        found += list(one.flattening(length * _SHARE))[1:] if length > 0 else [piece.end]
    return found


def _parts(insert: Any) -> Iterator[Any]:
    """Yield what a block holds, where it is set in; lines of its layer 0 lie on the block's own."""
    for part in insert.virtual_entities():
        if part.dxf.layer == "0":
            part.dxf.layer = insert.dxf.layer
        if part.dxf.color == _BY_BLOCK:
            part.dxf.color = insert.dxf.color
            if insert.dxf.hasattr("true_color"):
                part.dxf.true_color = insert.dxf.true_color
        yield part
