"""All pages put together, and turned into a PDF with the same bytes for the same plan."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO

from foldmill import CreasePattern, Fold
from foldmill_fabricate.jobsheet import flip_drawing, folding, register, words
from foldmill_fabricate.jobsheet.coupon_page import coupon_page
from foldmill_fabricate.jobsheet.paper import LEFT, Paper
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures import canvas

DPI = 300
"""Dots per inch of what is too much to be drawn line by line."""
SETUP_STOPS = (0.0, 6.0, 24.0, 49.0, 58.0, 76.0, 94.0, 114.0, 130.0)
HOLE_STOPS = (0.0, 15.0, 60.0, 105.0)
BUDGET_STOPS = (0.0, 20.0, 46.0, 68.0, 93.0, 112.0, 131.0, 152.0)


def write(plan: Plan, fold: Fold) -> bytes:
    """Return the job sheet of a plan as PDF: pages of A4 at true scale."""
    with canvas.own_style():
        made = list(pages(plan, fold))
        for number, page in enumerate(made, start=1):
            whole = f"{plan.title}, pattern {plan.pattern_sha256[:12]}"
            page.foot(f"{whole}: page {number} of {len(made)}")
        return _to_pdf(made)


def pages(plan: Plan, fold: Fold) -> Iterator[Paper]:
    """Yield the pages: for the machine, then for whoever reads a coupon or folds the part."""
    yield _machine_page(plan, fold.pattern)
    if plan.coupon is None:
        yield from folding.pages(plan, fold, _stamp(plan))
        return
    page = coupon_page(plan, plan.coupon, words.findings(plan))
    _add_register(page, plan)
    yield page


def _stamp(plan: Plan) -> str:
    return "" if plan.material.tested and plan.machine.verified else "untested"


def _to_pdf(made: list[Paper]) -> bytes:
    from matplotlib.backends.backend_pdf import PdfPages

    out = BytesIO()
    silent = {"CreationDate": None, "Producer": None, "Creator": "foldmill"}
    with PdfPages(out, metadata=silent) as pdf:
        for page in made:
            pdf.savefig(page.figure, dpi=DPI)
    return out.getvalue()


def _machine_page(plan: Plan, creases: CreasePattern) -> Paper:
    page = Paper()
    _add_title(page, plan)
    page.heading("Before you start")
    for warning in words.warnings(plan, creases):
        page.line(f"•  {warning}", 8.5)
    page.heading("Set-ups, in order of work")
    _add_setups(page, plan)
    _add_flip(page, plan)
    if plan.coupon is None:
        _add_register(page, plan)
        _add_budget(page, plan)
    page.y -= 2
    page.line(words.temperature(plan), 8)
    if plan.figures.travel_gap is not None:
        page.line(words.travel(plan), 8)
    page.check_bar(12)
    return page


def _add_title(page: Paper, plan: Plan) -> None:
    page.title(f"Job sheet: {plan.title}", _stamp(plan))
    page.line(words.summary(plan))
    for what, made in (("Material", plan.material), ("Machine", plan.machine)):
        page.line(f"{what}: {made.title}. {made.provenance}", 8)


def _add_setups(page: Paper, plan: Plan) -> None:
    page.row(words.SETUP_HEAD, SETUP_STOPS, 8, color="#606060")
    page.rule()
    for row, gate in words.setup_rows(plan):
        page.row(row, SETUP_STOPS, weight="bold")
        if gate:
            page.line(f"before it: {gate}", 8, SETUP_STOPS[1], color="#404040")
        page.y -= 0.8


def _add_flip(page: Paper, plan: Plan) -> None:
    if len(plan.passes) < 2:
        page.heading("All work is on one face: the sheet is not turned over")
        return
    page.heading("The flip")
    page.line(flip_drawing.instruction(plan))
    size = 52.0 if plan.coupon is None else 48.0  # a coupon has more set-ups above it
    bottom = page.y - size + 2
    for k, after in enumerate((False, True)):
        flip_drawing.draw(page.window(LEFT + 12 + 84 * k, bottom, 74, size), plan, after=after)
    page.y = bottom - 2


def _add_register(page: Paper, plan: Plan) -> None:
    if len(plan.passes) < 2:
        return
    page.heading(register.heading(plan))
    head, *rows = register.table(plan) or [words.HOLE_HEAD, *words.hole_rows(plan)]
    if rows:
        page.row(head, HOLE_STOPS, 8, color="#606060")
        page.rule()
    for row in rows:
        page.row(row, HOLE_STOPS)
    for said in (*register.sentences(plan), words.farthest_holes(plan)):
        page.line(said, 8.5)


def _add_budget(page: Paper, plan: Plan) -> None:
    if plan.budget is None:
        return
    page.heading("How far the reverse may land beside the front, mm")
    names, errors = register.budget_table(plan.budget)
    page.row(names, BUDGET_STOPS, 8, color="#606060")
    page.row(errors, BUDGET_STOPS, 8)
    page.line(register.budget_words(plan.budget), 7.5)
