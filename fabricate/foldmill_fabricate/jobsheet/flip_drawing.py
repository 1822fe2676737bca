"""How the sheet is turned over, drawn twice: the front before, the reverse after."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.pictures.sheet import axis_line
from foldmill_fabricate.sheet import flipped, strokes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

INK, PALE, MARK, STOP = "#202020", "#909090", "#8000a0", "#c03000"


def draw(axes: Axes, plan: Plan, *, after: bool, name: str = "") -> None:
    """Draw the blank before or after the flip, holes numbered alike, the witness mark in place.

    name : the id that is written on this very sheet, if it has one yet.
    """
    sheet, span = plan.sheet, max(plan.sheet.width, plan.sheet.height)
    w, h = sheet.width, sheet.height
    axes.fill(
        [0, w, w, 0], [0, 0, h, h], facecolor="#eef2f6" if after else "#fff8ea", edgecolor=INK
    )
    axes.plot(*axis_line(sheet, plan.flip, 0.04 * span), color=PALE, linewidth=0.8, linestyle="-.")
    _draw_part(axes, plan, after=after)
    _draw_marks(axes, plan, after=after)
    _draw_stops(axes, plan, Face.REVERSE if after else Face.FRONT)
    words = ("REVERSE up" if after else "FRONT up") + (f"\n{name}" if name else "")
    axes.text(w / 2, h / 2, words, ha="center", va="center", fontsize=11, weight="bold", color=INK)
    if not after:
        _draw_arrow(axes, plan, span)
    axes.set_xlim(-0.16 * span, w + 0.08 * span)
    axes.set_ylim(-0.08 * span, h + 0.16 * span)


def where_mark_is(plan: Plan) -> str:
    """Return in words where the witness mark lies after the flip, such as "upper right"."""
    marks = strokes(plan, Role.WITNESS)
    if not marks:
        return ""
    x, y = flipped(np.vstack(marks), plan.flip).mean(axis=0)
    upward = "upper" if y > plan.sheet.height / 2 else "lower"
    return f"{upward} {'right' if x > plan.sheet.width / 2 else 'left'}"


def instruction(plan: Plan) -> str:
    """Return the flip in one or two sentences."""
    stays = "bottom" if plan.flip.kind == "left-right" else "left"
    moves = "left edge to the right" if plan.flip.kind == "left-right" else "top edge down"
    said = f"Turn the sheet over {plan.flip.kind}: {moves}; the {stays} edge stays where it is."
    place = where_mark_is(plan)
    if not place:
        return said
    return (
        f"{said} The witness mark must then be underneath, {place}; seen on top, the sheet was "
        f"not turned over, and anywhere else it was turned the wrong way."
    )


def _seen(points: Floats, plan: Plan, *, after: bool) -> Floats:
    return flipped(points, plan.flip) if after else points


def _draw_part(axes: Axes, plan: Plan, *, after: bool) -> None:
    for line in strokes(plan, Role.CUT_OUTER):
        seen = _seen(line, plan, after=after)
        axes.plot(seen[:, 0], seen[:, 1], color="#c0c0c0", linewidth=0.7)


def _draw_marks(axes: Axes, plan: Plan, *, after: bool) -> None:
    for number, hole in enumerate(plan.holes, start=1):
        x, y = _seen(np.array([[hole.x, hole.y]]), plan, after=after)[0]
        axes.plot([x], [y], marker="o", markersize=5, color="#109030", fillstyle="none")
        _label(axes, plan, (x, y), str(number), "#0a6020")
    for line in strokes(plan, Role.MARK):
        seen = _seen(line, plan, after=after)
        axes.fill(*seen.T, facecolor=INK if after else "white", edgecolor="#109030", linewidth=1.2)
    marks = [_seen(line, plan, after=after) for line in strokes(plan, Role.WITNESS)]
    for seen in marks:
        axes.plot(seen[:, 0], seen[:, 1], MARK, linewidth=1.6)
    if marks:
        x, y = np.vstack(marks).mean(axis=0)
        words = "mark, underneath" if after else "witness mark"
        inward = -0.1 if y > plan.sheet.height / 2 else 0.1  # clear of a hole's number beside it
        spot = (x, y + inward * max(plan.sheet.width, plan.sheet.height))
        _label(axes, plan, spot, words, MARK)


_CARETS = {"left": 5, "right": 4, "bottom": 6, "top": 7}
"""matplotlib's carets whose tip is at the point and which come from outside the sheet."""


def _draw_stops(axes: Axes, plan: Plan, face: Face) -> None:
    """Draw a wedge outside the blank at each stop, its tip where the edge touches."""
    for stop in plan.registration.stops:
        if stop.face is face:
            spot = [stop.x - plan.sheet.dx], [stop.y - plan.sheet.dy]
            axes.plot(*spot, marker=_CARETS[stop.edge], markersize=11, color=STOP, clip_on=False)


def _label(
    axes: Axes, plan: Plan, at: tuple[float, float], words: str, colour: str, gap: float = 0.03
) -> None:
    """Write beside a mark, on the side of the sheet's middle; ``gap`` as a share of the sheet."""
    (x, y), span = at, max(plan.sheet.width, plan.sheet.height)
    leftward = x > plan.sheet.width / 2
    beside = x + (-gap if leftward else gap) * span
    aligned = "right" if leftward else "left"
    axes.text(beside, y, words, ha=aligned, va="center", fontsize=9, color=colour)


def _draw_arrow(axes: Axes, plan: Plan, span: float) -> None:
    w, h, off = plan.sheet.width, plan.sheet.height, 0.03 * span
    if plan.flip.kind == "left-right":
        start, end, bend = (0.25 * w, h + off), (0.75 * w, h + off), -0.35
    else:
        start, end, bend = (-off, 0.75 * h), (-off, 0.25 * h), 0.35
    arrow = {"arrowstyle": "-|>", "linewidth": 1.6, "color": INK}
    arrow["connectionstyle"] = f"arc3,rad={bend}"
    axes.annotate("", xy=end, xytext=start, arrowprops=arrow, annotation_clip=False)


def flip_picture(plan: Plan, name: str = "") -> bytes:
    """Return a PNG of the sheet before and after the flip, with what keeps it in register.

    name : the id that is written on the sheet.
    """
    with canvas.own_style():
        figure = canvas.figure(170, 84)
        for k, after in enumerate((False, True)):
            axes = canvas.flat_axes(figure, (0.02 + 0.49 * k, 0.02, 0.47, 0.96))
            draw(axes, plan, after=after, name=name)
        return canvas.png(figure)
