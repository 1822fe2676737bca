"""True-size PDF drawings: a page as large as the sheet, or tiled over paper that printers take."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

from foldmill import Fold
from foldmill_fabricate.formats import drawing as d
from foldmill_fabricate.formats import pdf_tiles
from foldmill_fabricate.formats.pdf_book import LEGEND, Book, strokes
from foldmill_fabricate.formats.pdf_legend import layer_rows, legend
from foldmill_fabricate.formats.pdf_letters import fitted
from foldmill_fabricate.formats.tiles import PAPERS, Paper, tiling
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.profiles import Profile, Style, find

STEPS = {
    "holes": "Drilling",
    "score_front": "PartialCutting",
    "score_back": "ReversePartialCutting",
    "crease_front": "Creasing",
    "crease_back": "ReverseCreasing",
    "perforation": "Perforating",
    "cut_inner": "Cutting",
    "cut_outer": "Cutting",
}
"""Types of ISO 19593-1 for our layers. A step of the reverse is called so in every drawing, also
where the drawing shows the reverse as it lies on the machine."""


def write(plan: Plan, fold: Fold, style: Style | None = None) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return ``front.pdf``, ``reverse.pdf`` (as the machine sees it) and ``master.pdf``.

    Each is one page as large as the sheet; ``legend.pdf`` says what their layers are for. style :
    names and colours of layers. Raises CannotWrite for a sheet longer than a PDF's page.
    """
    views = list(d.drawings(plan, _profile(style)))
    drawn = {f"{view.name}.pdf": one(plan, view) for view in views}
    return {**drawn, "legend.pdf": legend(plan, _profile(style), views[-1])}


def write_tiled(
    plan: Plan,
    fold: Fold,  # noqa: ARG001 - every format is given both
    style: Style | None = None,
    *,
    paper: Paper,
) -> Mapping[str, bytes]:
    """Return each drawing over pages of a paper, as ``front-a4.pdf``: a map, then the tiles."""
    profile = _profile(style)
    views = d.drawings(plan, profile)
    return {f"{view.name}-{paper}.pdf": tiled(plan, view, profile, paper) for view in views}


TILED = {paper: partial(write_tiled, paper=paper) for paper in PAPERS}
"""A writer for each size of paper."""


def one(plan: Plan, view: d.Drawing) -> bytes:
    """Return one drawing as a PDF of one page, as large as the sheet."""
    book = Book(view.note)
    book.page(view.width, view.height, "".join(drawn(book, plan, view)))
    return book.to_bytes()


def tiled(plan: Plan, view: d.Drawing, profile: Profile, paper: Paper) -> bytes:
    """Return one drawing as a PDF over pages of a paper, with a map and a legend before them."""
    book = Book(view.note)
    content = "".join(drawn(book, plan, view))
    rows = "".join(layer_rows(book, profile, view, pdf_tiles.LEGEND_TOP))
    pdf_tiles.add(book, view, tiling(view.width, view.height, paper), content, rows)
    return book.to_bytes()


def drawn(book: Book, plan: Plan, view: d.Drawing) -> Iterator[str]:
    """Yield the operators of each layer, in order of work; the last are marks and note."""
    for group in view.groups:
        yield book.layer(group.layer, step(plan, group.key), strokes(group.lines))
    corners = strokes(d.anchors(view.width, view.height))
    yield book.layer(view.layers.anchor, LEGEND, corners)
    capitals = fitted(view.note, d.NOTE_HEIGHT, view.width - 2 * d.NOTE_AT[0])
    yield book.layer(view.layers.note, LEGEND, book.words(view.note, *d.NOTE_AT, capitals))


def step(plan: Plan, key: str) -> str:
    """Return the type of ISO 19593-1 for a layer; an outline that is snapped is no cut through."""
    snapped = key == "cut_outer" and plan.material.cut.kind == "score-and-snap"
    return "PartialCutting" if snapped else STEPS[key]


def _profile(style: Style | None) -> Profile:
    return style.profile if style else find()
