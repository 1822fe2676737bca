"""Letters inside a PDF, so that its words look alike wherever it is opened, and can be searched.

Only the letters that are used go into the file, as outlines of DejaVu Sans, which comes with
matplotlib and whose licence allows it (a Type 3 font).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from pikepdf import Dictionary, Pdf

EM = 2048
"""Units of the font in a letter's size."""
CAPITALS = 1493 / EM
"""Height of its capitals, in sizes of the letters."""
MOST = 255
"""Different letters that one font can hold."""
MISSING = "?"
"""Stands for a letter that the font does not have."""
_LINE, _BEND = 2, 3
"""matplotlib's codes of a straight line and of a curve by one control point."""
_TO_UNICODE = """/CIDInit /ProcSet findresource begin
12 dict begin
begincmap
/CMapName /Letters def
/CMapType 2 def
1 begincodespacerange
<00> <FF>
endcodespacerange
{rows}endcmap
end
end
"""


class Glyph(NamedTuple):
    """One letter: how far the next one stands from it, and operators that fill its outline."""

    advance: int
    outline: str


class Letters:
    """The letters that a file uses, numbered in the order in which they were first used."""

    def __init__(self) -> None:
        self._codes: dict[str, int] = {}

    def encoded(self, text: str) -> str:
        """Return text as the operand of an operator that shows it."""
        return "<" + "".join(f"{self._code(letter):02X}" for letter in text) + ">"

    def font(self, pdf: Pdf) -> Dictionary:
        """Return the font with the letters used so far."""
        from pikepdf import Array, Dictionary, Name

        glyphs = [_glyph(letter) for letter in self._codes]
        names = [Name(f"/g{code}") for code in self._codes.values()]
        made = Dictionary()
        for name, glyph in zip(names, glyphs, strict=True):
            made[str(name)] = pdf.make_stream(glyph.outline.encode("ascii"))
        encoding = Dictionary(Type=Name.Encoding, Differences=Array([1, *names]))
        return Dictionary(
            Type=Name.Font, Subtype=Name.Type3, FontBBox=[0, 0, 0, 0], CharProcs=made,
            FontMatrix=_real_array([1 / EM, 0, 0, 1 / EM, 0, 0]), Encoding=encoding,
            FirstChar=1, LastChar=max(1, len(glyphs)), Resources=Dictionary(),
            Widths=Array([glyph.advance for glyph in glyphs] or [0]),
            ToUnicode=pdf.make_stream(self._unicode().encode("ascii")),
        )  # fmt: skip

    def _code(self, letter: str) -> int:
        known = letter if _has(letter) else MISSING
        if known not in self._codes and len(self._codes) >= MOST:
            known = next(iter(self._codes))
        return self._codes.setdefault(known, len(self._codes) + 1)

    def _unicode(self) -> str:
        """Return which letter each code is, for whoever searches or copies the words."""
        rows = [
            f"<{code:02X}> <{letter.encode('utf-16-be').hex().upper()}>\n"
            for letter, code in self._codes.items()
        ]
        parts = [rows[k : k + 100] for k in range(0, len(rows), 100)]  # no more are allowed at once
        return _TO_UNICODE.format(
            rows="".join(f"{len(p)} beginbfchar\n{''.join(p)}endbfchar\n" for p in parts)
        )


def width_of(text: str, capitals: float) -> float:
    """Return how wide words are, mm, whose capitals are so high."""
    units = sum(_glyph(letter if _has(letter) else MISSING).advance for letter in text)
    return units / EM * capitals / CAPITALS


def fitted(text: str, capitals: float, room: float) -> float:
    """Return the height of capitals, mm, at which words take no more than so much room, mm."""
    return capitals * min(1.0, room / max(width_of(text, capitals), 1e-9))


@cache
def _face():  # type: ignore[no-untyped-def]
    from matplotlib import get_data_path
    from matplotlib.ft2font import FT2Font

    return FT2Font(str(Path(get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"))


def _has(letter: str) -> bool:
    return bool(_face().get_char_index(ord(letter)))


@cache
def _glyph(letter: str) -> Glyph:
    from matplotlib.ft2font import LoadFlags

    face = _face()
    found = face.load_char(ord(letter), flags=LoadFlags.NO_SCALE)
    points, codes = face.get_path()
    advance = int(found.horiAdvance)
    path = "".join(_operators(np.rint(np.asarray(points) * 64), codes))
    low, high = (0, 0), (0, 0)
    if path:
        low, high = (tuple(f(np.rint(points * 64), axis=0).astype(int)) for f in (np.min, np.max))
    head = f"{advance} 0 {low[0]} {low[1]} {high[0]} {high[1]} d1\n"
    return Glyph(advance, head + path + ("f\n" if path else ""))


def _operators(points: NDArray[np.float64], codes: NDArray[np.uint8]) -> Iterator[str]:
    """Yield a path; a curve by one control point becomes one by two, which is all a PDF knows."""
    at, k = points[0] if len(points) else np.zeros(2), 0
    while k < len(points):
        if codes[k] == 1:
            yield f"{_pair(points[k])} m\n"
        elif codes[k] == _LINE:
            yield f"{_pair(points[k])} l\n"
        elif codes[k] == _BEND:
            bend, end = points[k], points[k + 1]
            one, two = (at + 2 * bend) / 3, (end + 2 * bend) / 3
            yield f"{_pair(one)} {_pair(two)} {_pair(end)} c\n"
            k += 1
        else:
            yield "h\n"
        at, k = points[k], k + 1


def _pair(point: NDArray[np.float64]) -> str:
    x, y = np.rint(point).astype(int).tolist()
    return f"{x} {y}"


def _real_array(values: list[float]):  # type: ignore[no-untyped-def]
    from decimal import Decimal

    from pikepdf import Array

    return Array([Decimal(f"{value:.10f}") for value in values])
