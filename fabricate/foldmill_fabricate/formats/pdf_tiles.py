"""The pages of a tiled drawing: a map of them, and each with what joins it to its neighbours."""

from __future__ import annotations

from collections.abc import Iterator
from textwrap import wrap

import numpy as np

from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.formats import tiles as t
from foldmill_fabricate.formats.pdf_book import LEGEND, Book, strokes
from foldmill_fabricate.formats.pdf_letters import fitted, width_of
from foldmill_fabricate.formats.svg import number
from foldmill_fabricate.profiles import Layer

MARKS = Layer(name="TILES", aci=8, colour="#606060", pen=9, cf2=0)
"""What joins the pages: crosses, names, frames. It is on paper only."""
SMALL, LARGE = 2.2, 4.0
"""mm. Height of capitals."""
LEGEND_TOP = 88.0
"""mm from the lower edge of the map's page: its legend stands below."""
_BESIDE = 106.0
"""mm from the window's left end: what stands beside the check bar."""
ADVICE = (
    "Print every page at 100 %, without scaling to the paper, and measure the bar: 100 mm.",
    "Cut each page along its frame at the right and at the bottom, lay it over its neighbour",
    "so that the crosses meet, and tape it. Neighbours are named at the edges they join.",
)


def add(book: Book, view: d.Drawing, laid: t.Tiling, content: str, legend: str) -> None:
    """Add the map and a page for each tile.

    content : draws the whole sheet, mm; legend : draws rows that say what its layers are for, from
    the upper end ``LEGEND_TOP`` of the map's page downward.
    """
    drawing = book.form(view.width, view.height, content)
    book.page(*t.upright(laid), _map(book, view, laid, drawing) + legend)
    for tile in laid.tiles:
        book.page(*laid.page, _tile(book, view, laid, tile, drawing))


def _tile(book: Book, view: d.Drawing, laid: t.Tiling, tile: t.Tile, drawing: str) -> str:
    wide, high = laid.window
    left, low = t.MARGIN, t.MARGIN + t.FOOT
    frame = _frame(left, low, wide, high)
    shift = f"1 0 0 1 {number(left - tile.x)} {number(low - tile.y)} cm"
    near = [
        line
        for x, y in t.crosses(laid)
        if tile.x < x < tile.x + wide and tile.y < y < tile.y + high
        for line in _cross(x, y)
    ]
    crosses = book.layer(MARKS, LEGEND, strokes(near))
    sheet = f"q\n{_box(left, low, wide, high)} W n\n{shift}\n/{drawing} Do\n{crosses}Q\n"
    room = wide - _BESIDE
    marks = "".join(
        [
            strokes([frame]),
            book.words(tile.name, left + _BESIDE, t.MARGIN + 7.5, SMALL),
            *_wrapped(book, view.note, left + _BESIDE, t.MARGIN + 4, 1.6, room),
            check_bar(book, left, t.MARGIN + 1),
            *_names(book, laid, tile),
        ]
    )
    return sheet + book.layer(MARKS, LEGEND, marks)


def _wrapped(
    book: Book, text: str, x: float, y: float, capitals: float, room: float
) -> Iterator[str]:
    """Yield words in lines of at most ``room`` mm, the first one's baseline at y."""
    most = int(room / width_of("n", capitals))
    for k, line in enumerate(wrap(text, most)[:2]):
        yield book.words(line, x, y - 1.8 * capitals * k, capitals)


def _names(book: Book, laid: t.Tiling, tile: t.Tile) -> Iterator[str]:
    """Yield this tile's name, large, and its neighbours' at the edges they join."""
    wide, high = laid.window
    left, low = t.MARGIN, t.MARGIN + t.FOOT
    yield book.words(tile.name, left + 2, low + high - 6, LARGE)
    for across, down in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        name = laid.neighbour(tile, across, down)
        if not name:
            continue
        room = width_of(name, SMALL)
        x = left + (0.5 * wide if down else (wide - room - 1 if across > 0 else 1))
        y = low + (0.5 * high if across else (1 if down > 0 else high - SMALL - 1))
        yield book.words(name, x, y, SMALL)


def _map(book: Book, view: d.Drawing, laid: t.Tiling, drawing: str) -> str:
    page = t.upright(laid)
    scale = min(
        (page[0] - 30) / (laid.xs[-1] + laid.window[0] - laid.xs[0]),
        (page[1] - LEGEND_TOP - 45) / (laid.ys[0] + laid.window[1] - laid.ys[-1]),
    )
    left, low = 15.0 - scale * laid.xs[0], LEGEND_TOP + 8 - scale * laid.ys[-1]
    placed = f"{scale:.6f} 0 0 {scale:.6f} {number(left)} {number(low)} cm"
    sheet = f"q\n{placed}\n/{drawing} Do\nQ\n"
    head = f"{view.note}: {len(laid.tiles)} pages"
    marks = [book.words(head, 15, page[1] - 15, fitted(head, 3.0, page[0] - 30))]
    marks += [book.words(text, 15, page[1] - 21 - 4.5 * k, SMALL) for k, text in enumerate(ADVICE)]
    marks.append(check_bar(book, 15, 12))
    for tile in laid.tiles:
        x, y = left + scale * tile.x, low + scale * tile.y
        wide, high = (scale * side for side in laid.window)
        marks.append(strokes([_frame(x, y, wide, high)]))
        marks.append(book.words(tile.name, x + 2, y + high - 6, LARGE))
    return sheet + book.layer(MARKS, LEGEND, "".join(marks))


def check_bar(book: Book, x: float, y: float) -> str:
    """Return operators for 100 mm that measure 100 mm where the page is printed at its own size."""
    ticks = [
        np.array([(x + 10 * k, y), (x + 10 * k, y + (3.0 if k % 5 == 0 else 1.5))])
        for k in range(11)
    ]
    return strokes([np.array([(x, y), (x + 100, y)]), *ticks]) + book.words(
        "100 mm", x + 86, y + 4, 1.8
    )


def _cross(x: float, y: float) -> list[d.Floats]:
    return [
        np.array([(x - t.ARM, y), (x + t.ARM, y)]),
        np.array([(x, y - t.ARM), (x, y + t.ARM)]),
    ]


def _frame(x: float, y: float, wide: float, high: float) -> d.Floats:
    return np.array([(x, y), (x + wide, y), (x + wide, y + high), (x, y + high), (x, y)])


def _box(*sides: float) -> str:
    return " ".join(number(side) for side in sides) + " re"
