"""What the layers of the PDF drawings are for, as rows on a page of paper."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.formats.pdf_book import LEGEND, Book, strokes
from foldmill_fabricate.formats.pdf_letters import fitted
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.profiles import Profile
from foldmill_fabricate.profiles import legend as legend_rows

PAGE = (297.0, 210.0)
"""mm: A4, lying."""
ROW = 7.0
"""mm between rows."""
CAPITALS = 2.3
"""mm."""
_COLUMNS = (15.0, 30.0, 80.0, 104.0)
"""mm. Left ends of line, name, colour and use."""


def legend(plan: Plan, profile: Profile, master: d.Drawing) -> bytes:
    """Return a page that says what each layer of the drawings is for."""
    book = Book(f"{plan.title}: layers")
    top = PAGE[1] - 25
    head = f"{plan.title}: what the layers of its PDF drawings are (profile {profile.slug})"
    capitals = fitted(head, 3.0, PAGE[0] - 2 * _COLUMNS[0])
    rows = "".join(layer_rows(book, profile, master, top - 2 * ROW))
    book.page(*PAGE, f"0 g\n{book.words(head, _COLUMNS[0], top, capitals)}{rows}")
    return book.to_bytes()


def layer_rows(book: Book, profile: Profile, view: d.Drawing, top: float) -> Iterator[str]:
    """Yield a row per layer that a view uses: a piece of its line, its name and what it is for."""
    used = {id(group.layer) for group in view.groups} | {id(view.layers.note)}
    rows = [row for row in legend_rows(profile) if id(row.look) in used]
    for k, (look, about) in enumerate(rows):
        y = top - k * ROW
        line = np.array([(_COLUMNS[0], y + 1), (_COLUMNS[1] - 4, y + 1)])
        yield book.layer(look, LEGEND, "0.8 w\n" + strokes([line]))
        said = zip(_COLUMNS[1:], (look.name, look.colour, about), strict=True)
        yield "0 g\n" + "".join(book.words(text, x, y, CAPITALS) for x, text in said)
