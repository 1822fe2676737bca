"""The readers that foldmill brings itself."""

from __future__ import annotations

from collections.abc import Callable

from foldmill.exchange import cp, fold_options, opx, svg
from foldmill.exchange.drawing import Drawing
from foldmill.exchange.limits import Limits
from foldmill.exchange.options import Options
from foldmill_fabricate.hooks import Reader, Sized
from foldmill_fabricate.importing import dxf


def readers() -> list[Reader]:
    """Return a reader for each format, by its usual suffix and by how its files begin."""
    return [
        Reader("fold", "FOLD 1.0 to 1.2", (".fold",), _fold, _begins(b"{")),
        Reader("cp", "CP of ORIPA, Oriedita and others", (".cp",), _cp, _is_cp),
        Reader("opx", "OPX of ORIPA", (".opx",), _opx, _holds(b"<java")),
        Reader("svg", "SVG by layers or colours", (".svg",), _svg, _holds(b"<svg")),
        Reader("dxf", "DXF by layers or colours", (".dxf",), dxf.read, dxf.recognised),
    ]


def _fold(content: bytes, options: Options, limits: Limits) -> Sized:
    return Sized(*fold_options.read(content, options, limits))


def _cp(content: bytes, _options: Options, limits: Limits) -> Drawing:
    return cp.read(content.decode("utf-8", errors="replace"), limits)


def _opx(content: bytes, _options: Options, limits: Limits) -> Drawing:
    return opx.read(content, limits)


def _svg(content: bytes, _options: Options, limits: Limits) -> Drawing:
    return svg.read(content, limits)


def _begins(mark: bytes) -> Callable[[bytes], bool]:
    return lambda head: head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(mark)


def _holds(mark: bytes) -> Callable[[bytes], bool]:
    return lambda head: mark in head


def _is_cp(head: bytes) -> bool:
    words = head.split(b"\n", 1)[0].split()
    return len(words) == 5 and words[0].isdigit()
