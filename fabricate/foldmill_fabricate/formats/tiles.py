"""A large sheet on small paper: which part of it each page shows, and what joins the pages.

Terminology: a *tile* is one page; its *window* is the part of the sheet that it shows at true size.
Neighbouring windows overlap, and crosses in the overlap are printed on both pages.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil
from typing import Literal

Paper = Literal["a4", "a3"]
PAPERS: dict[Paper, tuple[float, float]] = {"a4": (210.0, 297.0), "a3": (297.0, 420.0)}
"""mm, upright."""
MARGIN = 8.0
"""mm. Printers leave up to 6 mm at the paper's edges white."""
FOOT = 12.0
"""mm under the window, for the tile's name and the bar to check the scale by."""
OVERLAP = 12.0
"""mm by which neighbours show the same."""
ARM = 4.0
"""mm. Half the width of an alignment cross; less than half the overlap."""


@dataclass(frozen=True)
class Tile:
    """One page: its name and the lower left corner of its window on the sheet, mm."""

    name: str
    column: int
    """From the left, 0 first."""
    row: int
    """From the top, 0 first."""
    x: float
    y: float


@dataclass(frozen=True)
class Tiling:
    """How a sheet is laid on pages of one size, all upright or all lying."""

    page: tuple[float, float]
    """Width and height of the paper as it is used, mm."""
    xs: tuple[float, ...]
    """Left ends of the windows, by column, mm on the sheet."""
    ys: tuple[float, ...]
    """Lower ends of the windows, by row from the top, mm on the sheet."""

    @property
    def window(self) -> tuple[float, float]:
        """Width and height of what a page shows, mm."""
        return _window(self.page)

    @property
    def tiles(self) -> list[Tile]:
        """Every page, row by row from the top."""
        return [
            Tile(f"{_letters(column)}{row + 1}", column, row, x, y)
            for row, y in enumerate(self.ys)
            for column, x in enumerate(self.xs)
        ]

    def neighbour(self, tile: Tile, across: int, down: int) -> str:
        """Return the name of the page so many columns to the right and rows down; "" for none."""
        column, row = tile.column + across, tile.row + down
        inside = 0 <= column < len(self.xs) and 0 <= row < len(self.ys)
        return f"{_letters(column)}{row + 1}" if inside else ""


def tiling(width: float, height: float, paper: Paper) -> Tiling:
    """Return how a sheet, mm, is laid on as few pages as possible, in their middle."""
    short, long = PAPERS[paper]
    pages = ((short, long), (long, short))
    page = min(pages, key=lambda p: _count(width, p[0], 0) * _count(height, p[1], 1))
    window = _window(page)
    ys = _starts(height, window[1])
    return Tiling(page, _starts(width, window[0]), tuple(reversed(ys)))


def upright(of: Tiling) -> tuple[float, float]:
    """Return the paper upright, whichever way the tiles lie: width and height, mm."""
    return min(of.page), max(of.page)


def crosses(of: Tiling) -> Iterator[tuple[float, float]]:
    """Yield the middles of the alignment crosses, mm on the sheet: two for each pair of tiles."""
    wide, high = of.window
    for tile in of.tiles:
        if of.neighbour(tile, 1, 0):
            middle = (tile.x + wide + of.xs[tile.column + 1]) / 2
            yield from ((middle, tile.y + share * high) for share in (0.25, 0.75))
        if of.neighbour(tile, 0, 1):
            middle = (tile.y + of.ys[tile.row + 1] + high) / 2
            yield from ((tile.x + share * wide, middle) for share in (0.25, 0.75))


def _window(page: tuple[float, float]) -> tuple[float, float]:
    return page[0] - 2 * MARGIN, page[1] - 2 * MARGIN - FOOT


def _count(length: float, page: float, upward: int) -> int:
    window = page - 2 * MARGIN - upward * FOOT
    return max(1, ceil((length - OVERLAP) / (window - OVERLAP) - 1e-9))


def _starts(length: float, window: float) -> tuple[float, ...]:
    step = window - OVERLAP
    count = max(1, ceil((length - OVERLAP) / step - 1e-9))
    spare = (count - 1) * step + window - length
    return tuple(k * step - spare / 2 for k in range(count))


def _letters(column: int) -> str:
    """Return A, B … Z, AA, AB …"""
    more, last = divmod(column, 26)
    return (_letters(more - 1) if more else "") + chr(ord("A") + last)
