"""The pages for the hands: which crease goes which way and how far, and what becomes of it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from foldmill import Assignment, Fold
from foldmill_fabricate.jobsheet import order, part, words
from foldmill_fabricate.jobsheet.creases import Arrangement, arrange, middle, midpoints
from foldmill_fabricate.jobsheet.moving import Closing, closing
from foldmill_fabricate.jobsheet.paper import BOTTOM, LEFT, RIGHT, Paper
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.pictures import folded, lettered, pattern, sheet
from foldmill_fabricate.pictures.folded import ABOVE
from foldmill_fabricate.pictures.render import INSIDE, OUTSIDE, Ball, Camera, render
from foldmill_fabricate.pictures.stages import cropped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIDE, BEHIND = Camera(azimuth=22, elevation=0), Camera(azimuth=112, elevation=-32)
VIEWS = (
    ("from the front, above", ABOVE),
    ("from behind, below", BEHIND),
    ("from the side", SIDE),
)
LARGE_VIEWS = 171.0
"""mm of a page that they take where there is so much room."""
MANY_FACETS = 8000
"""Of a form: more are drawn from one side only, as each takes its time."""
STAGES = 62.0
"""mm: as high as pictures of a motion become."""
PIXELS, LARGE_PIXELS = 320, 420
"""Of a picture of the form."""
SIGNS = (
    (Assignment.M, "mountain: a ridge, its sides bend away from you"),
    (Assignment.V, "valley: a trough, its sides bend towards you"),
)
ANGLES = "A fold of 0° is flat, 90° a right angle; at 180° the sheet lies on itself."
STOPS = (0.0, 5.5, 22.0, 36.0, 50.0, 61.0, 72.0)
"""mm. Columns of the table of creases, which stands beside the whole pattern."""
WIDE_STOPS = (0.0, 5.5, 22.0, 43.0, 57.0, 68.0, 79.0)
"""mm. The same where angles differ within a kind."""
BESIDE = 112.0
"""mm. Where that table begins."""


def pages(plan: Plan, fold: Fold, stamp: str) -> Iterator[Paper]:
    """Yield the sheet, the drawing to fold from, then the form and the order of folding."""
    how, moving = arrange(fold.pattern), closing(fold)
    yield _sheet_page(plan, stamp)
    yield _creases_page(plan, fold, how, moving, stamp)
    yield _order_page(plan, fold, how, moving, stamp)


def _sheet_page(plan: Plan, stamp: str) -> Paper:
    page = Paper()
    page.title(f"The sheet: {plan.title}", stamp)
    page.line("Seen from the FRONT, lines of both faces unmirrored.", 9)
    size = 158.0
    sheet.draw(page.window(LEFT + 11, page.y - size, size, size - 4), plan, letters=8.5)
    page.y -= size + 14
    found = words.findings(plan)
    if found:
        page.heading("What planning found")
    page.listed(found, 8, "more in plan.json")
    return page


def _creases_page(
    plan: Plan, fold: Fold, how: Arrangement, moving: Closing | None, stamp: str
) -> Paper:
    page = Paper()
    page.title(f"Creases: {plan.title}", stamp)
    page.line("Both drawings show the FRONT. " + ANGLES, 8.5)
    page.y -= 1
    _add_signs(page)
    top = page.y - 2
    _draw_whole(page.window(LEFT, top - 96, 92, 92), fold, how)
    _add_table(page, fold, how, moving)
    shown = part.part(fold, how)
    high = min(page.y - 12, top - 102) - BOTTOM
    enlarged = page.window(LEFT, BOTTOM, RIGHT - LEFT, high)
    part.draw(enlarged, fold.pattern, shown, how, (RIGHT - LEFT, high))
    enlarged.set_title(shown.title, fontsize=9)
    return page


def _add_signs(page: Paper) -> None:
    """Draw how mountains and valleys are drawn, and what they are."""
    for k, (kind, said) in enumerate(SIGNS):
        look, x, y = pattern.PRINTED[kind], LEFT + 92 * k, page.y + 0.8
        style = {"color": look.colour, "linestyle": look.style}
        page.axes.plot([x, x + 14], [y, y], linewidth=1.4 * look.width, **style)  # type: ignore[arg-type]
        rise = 2.2 if kind == Assignment.M else -2.2
        low = y - rise / 2
        page.axes.plot(
            [x + 17, x + 20, x + 23], [low, low + rise, low], color=look.colour, linewidth=1.4
        )
        page.axes.text(x + 25, page.y, said, fontsize=7.5, va="baseline")
    page.y -= 5


def _draw_whole(axes: Axes, fold: Fold, how: Arrangement) -> None:
    creases = fold.pattern
    crowded = max(0.35, min(1.0, (400 / len(creases.edges)) ** 0.5))
    pattern.draw(axes, creases, legend=False, thickness=crowded, looks=pattern.PRINTED)
    width, height = np.ptp(creases.vertices, axis=0)
    axes.set_title(f"The whole pattern, {width:.0f} × {height:.0f} mm", fontsize=9)
    frame = {"boxstyle": "circle,pad=0.12", "facecolor": "white", "edgecolor": "none"}
    placed = middle(creases)[None, :]
    for group in how.groups:
        spots = midpoints(creases, group.edges)
        room = np.linalg.norm(spots[:, None] - placed, axis=2).min(axis=1)
        x, y = best = spots[np.argmax(np.round(room, 6))]
        placed = np.vstack([placed, best])
        axes.text(x, y, group.letter, ha="center", va="center", fontsize=7, bbox=frame)


def _add_table(page: Paper, fold: Fold, how: Arrangement, moving: Closing | None) -> None:
    at = BESIDE - LEFT
    head, *rows = order.crease_table(how, moving, fold)
    differ = any(group.spread > order.ALIKE for group in how.groups)
    stops = [at + stop for stop in (WIDE_STOPS if differ else STOPS)[: len(head)]]
    page.line("Kinds of creases", 11, at, weight="bold")
    if not rows:
        page.line("There are none.", 9, at)
        return
    page.row(head, stops, 7.5, color="#606060")
    page.rule(at)
    for row in rows:
        page.row(row, stops, 8)
    if moving is not None and moving.opens_flat:
        page.line("at …%: the angle that far on the way from the flat sheet to the form", 7, at)
    if differ:
        page.line("±: angles differ within a letter. Each one's own is in pattern.fold.", 7, at)


def _order_page(
    plan: Plan, fold: Fold, how: Arrangement, moving: Closing | None, stamp: str
) -> Paper:
    page = Paper()
    page.title(f"Folding: {plan.title}", stamp)
    seams = 0 if fold.folded is None else len(fold.folded.seams)
    steps = order.folding_steps(plan, how, seams, moving)
    source = order.derived(how, moving, fold)
    words_take = page.height_of([*steps, source]) + 0.8 * len(steps) + 12
    _add_views(page, fold, how, is_large=moving is None and page.y - words_take > LARGE_VIEWS)
    _add_stages(page, fold, moving)
    page.heading("Suggested order of folding")
    for number, step in enumerate(steps, start=1):
        page.line(f"{number}.  {step}")
        page.y -= 0.8
    page.y -= 1
    page.line(source, 8, color="#404040")
    return page


def _add_views(page: Paper, fold: Fold, how: Arrangement, *, is_large: bool) -> None:
    """Draw the form from three sides; large, the third stands alone below the two others."""
    if fold.folded is None:
        page.line("The folded form is not known: only the pattern was given.", 9)
        return
    page.line(f"The folded form, {folded.size_text(fold)}", 10)
    _add_faces(page)
    views = VIEWS if len(fold.pattern.faces) <= MANY_FACETS else VIEWS[:1]
    letters = {group.letter: group.edges for group in how.groups}
    in_row = 2 if is_large else len(VIEWS)
    wide = (RIGHT - LEFT) / in_row
    for k, (name, camera) in enumerate(views):
        if k and k % in_row == 0:
            page.y -= wide + 2
        size = wide - 2 if k < in_row else LARGE_VIEWS - (RIGHT - LEFT) / 2 - 18
        left = LEFT + k % in_row * wide if k < in_row else (LEFT + RIGHT - size) / 2
        axes = page.window(left, page.y - size - 2, size, size)
        pixels, points = (LARGE_PIXELS, 8.0) if is_large else (PIXELS, 6.5)
        lettered.draw_lettered(axes, fold, camera, letters, pixels, points)
        axes.set_title(name, fontsize=8.5)
        end = page.y - size - 9
    page.y = end


def _add_faces(page: Paper) -> None:
    """Name the colours of the two faces, at the right of the line above."""
    y = page.y + 5.6
    for x, colour, name in ((120, OUTSIDE, "front (outside)"), (156, INSIDE, "reverse (inside)")):
        page.axes.plot([x], [y], marker="s", markersize=7, color=colour)
        page.axes.text(x + 3, y, name, fontsize=8, va="center")


def _add_stages(page: Paper, fold: Fold, moving: Closing | None) -> None:
    if moving is None or len(fold.pattern.faces) > MANY_FACETS:
        return
    stages = moving.stages(fold)
    title = moving.motion.title
    said = "On the way from the flat sheet" if moving.opens_flat else f"How it moves: {title}"
    page.line(said, 10)
    every = [stage.folded.vertices for _, stage in stages if stage.folded is not None]
    view, wide = Ball.around(np.vstack(every)), (RIGHT - LEFT) / len(stages)
    images = cropped([render(stage, ABOVE, PIXELS, view) for _, stage in stages])
    high, across = images[0].shape[:2]
    tall = min(STAGES, (wide - 4) * high / across)
    for k, ((name, _), image) in enumerate(zip(stages, images, strict=True)):
        axes = page.window(LEFT + 2 + k * wide, page.y - tall - 4, wide - 4, tall)
        axes.imshow(image, interpolation="none")
        axes.set_title(name, fontsize=8.5)
    page.y -= tall + 6
