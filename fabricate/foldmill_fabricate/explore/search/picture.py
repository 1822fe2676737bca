"""All results in one picture: the pattern, the folded form, and what they measure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from foldmill_fabricate.explore.search.request import Request
from foldmill_fabricate.explore.search.results import Result
from foldmill_fabricate.pictures import canvas, folded, pattern

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ACROSS = 5
"""Results in one row."""
CELL, TALL = 62.0, 138.0
"""Width and height of one result, mm."""
HEAD = 10.0
"""Height of the title, mm."""


def picture(results: list[Result], request: Request) -> bytes:
    """Return a PNG with one column for each result, the best at the left."""
    across = min(ACROSS, len(results))
    down = -(-len(results) // ACROSS)
    with canvas.own_style():
        wide, tall = across * CELL, down * TALL + HEAD
        figure = canvas.figure(wide, tall)
        for k, result in enumerate(results):
            left, top = (k % ACROSS) * CELL / wide, 1 - (HEAD + (k // ACROSS) * TALL) / tall
            _cell(figure, k + 1, result, request, (left, top, CELL / wide, TALL / tall))
        wanted = ", ".join(f"{t.name} {t.value:g} mm" for t in request.targets)
        sheet = f"{request.sheet.width:g} × {request.sheet.height:g} mm"
        size = 8 if across == 1 else 11
        figure.suptitle(f"{wanted}; sheet {sheet}", fontsize=size, y=1 - 0.3 * HEAD / tall)
        return canvas.png(figure)


def _cell(
    figure: Figure,
    rank: int,
    result: Result,
    request: Request,
    box: tuple[float, float, float, float],
) -> None:
    """Draw one result: words at the top, the pattern, the form at the bottom."""
    left, top, wide, tall = box
    inner, width = left + 0.02 * wide, 0.96 * wide
    flat = canvas.flat_axes(figure, (inner, top - 0.56 * tall, width, 0.385 * tall))
    pattern.draw(flat, result.fold.pattern, legend=False)
    beside = canvas.flat_axes(figure, (inner, top - 0.98 * tall, width, 0.385 * tall))
    folded.draw(beside, result.fold, pixels=360)
    words = "\n".join([f"{rank}   (from {result.start})", *lines(result, request)])
    figure.text(inner, top - 0.01 * tall, words, va="top", fontsize=7.5, linespacing=1.35)


def lines(result: Result, request: Request) -> list[str]:
    """Return what a result measures, for people: what was asked first, and whether it is met."""
    figures, named = result.figures, [target.name for target in request.targets]
    asked = []
    for target in request.targets:
        by = target.miss(figures)
        held = "" if target.is_met(figures) else ", missed"
        asked.append(f"{target.name} {figures[target.name]:.1f} mm ({by:+.2f}{held})")
    rest = [name for name in ("height", "width", "seat", "footprint") if name not in named]
    beside = ", ".join(f"{name} {figures[name]:.0f}" for name in rest if figures[name] > 0)
    sheet = f"sheet {figures['sheet_x']:.0f} × {figures['sheet_y']:.0f}"
    crease = f"shortest crease {figures['crease']:.1f}"
    return [*asked, *([beside] if beside else []), sheet, crease]
