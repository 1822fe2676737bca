"""The sheet with what is done to either face, in sheet coordinates: seen from the front."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Face, Flip, Plan, Role, Sheet
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.sheet import strokes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
Key = tuple[Role, Face | None]
"""A role, and the face where it makes a difference."""

LOOKS: dict[Key, tuple[str, str, float]] = {
    (Role.SCORE, Face.FRONT): ("front scores", "#0050d0", 1.2),
    (Role.SCORE, Face.REVERSE): ("reverse scores", "#f07800", 1.2),
    (Role.RELIEF, None): ("relief holes", "#00a0a0", 1.4),
    (Role.CUT_INNER, None): ("inner cuts", "#a09000", 1.4),
    (Role.CUT_OUTER, None): ("outline", "#d01010", 1.6),
    (Role.HOLE, None): ("holes", "#109030", 1.4),
    (Role.MARK, None): ("registration marks", "#109030", 1.4),
    (Role.WITNESS, None): ("witness mark", "#8000a0", 1.8),
    (Role.VERNIER, Face.FRONT): ("front vernier lines", "#109030", 0.9),
    (Role.VERNIER, Face.REVERSE): ("reverse vernier lines", "#b00060", 0.9),
    (Role.RULER, Face.FRONT): ("front lines to measure by", "#404040", 0.8),
    (Role.RULER, Face.REVERSE): ("reverse lines to measure by", "#a08060", 0.8),
    (Role.LABEL, Face.FRONT): ("words on the front", "#0050d0", 0.7),
    (Role.LABEL, Face.REVERSE): ("words on the reverse", "#f07800", 0.7),
}
"""Name, colour and width in points; both faces are drawn unmirrored."""
LETTERS = 105
"""Letters in a line of the title."""
LEAD_IN = ("#c000c0", 1.4)
"""Colour and width of the ways in the waste that turn a blade."""


def sheet_picture(plan: Plan) -> bytes:
    """Return a PNG of the blank with the strokes of both passes, holes and ties labelled."""
    with canvas.own_style():
        figure = canvas.figure(200, 215)
        draw(canvas.flat_axes(figure, (0.03, 0.08, 0.94, 0.85)), plan)
        turned = f"turned by {plan.placement.angle:.2f}° on its blank, seen from the front"
        copies = f"{plan.quantity} copies, " if plan.quantity > 1 else ""
        figure.suptitle(fill(f"{plan.title}, {copies}{turned}", LETTERS), fontsize=11)
        return canvas.png(figure)


def draw(axes: Axes, plan: Plan, letters: float = 9) -> None:
    """Draw the sheet into axes, with labels, legend and scale bar; ``letters`` in points."""
    sheet = plan.sheet
    span = max(sheet.width, sheet.height)
    _draw_blank(axes, sheet, plan.flip if len(plan.passes) > 1 else None, span)
    for (role, face), (name, colour, width) in LOOKS.items():
        lines = strokes(plan, role, face)
        if lines:
            canvas.add_lines(axes, lines, color=colour, linewidth=width)
            label = f"{name}: {len(lines)}" if role is not Role.WITNESS else name
            canvas.legend_entry(axes, label, color=colour, linewidth=width)
    draw_lead_ins(axes, lead_ins(plan))
    _label_places(axes, plan, span, letters)
    canvas.scale_bar(axes, 0, -0.035 * span, span)
    axes.set_xlim(-0.03 * span, sheet.width + 0.03 * span)
    axes.set_ylim(-0.06 * span, sheet.height + 0.05 * span)
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=3, frameon=False, fontsize=letters
    )


def copies(plan: Plan) -> list[tuple[int, tuple[float, float]]]:
    """Return the number of each copy and a place beside its middle, mm; none where there is one."""
    corners: dict[int, list[tuple[float, float]]] = {}
    for work in plan.passes:
        for stroke in (s for setup in work.setups for op in setup.operations for s in op.strokes):
            if stroke.piece:
                corners.setdefault(stroke.piece, []).extend(stroke.points)
    found = []
    for number, points in sorted(corners.items()):
        low, high = np.min(points, axis=0), np.max(points, axis=0)
        x, y = (low + (high - low) * (0.42, 0.58)).tolist()
        found.append((number, (x, y)))
    return found


def lead_ins(plan: Plan, face: Face | None = None) -> list[Floats]:
    """Return the ways that turn a blade in the waste, (n, 2) mm each, of one face or of both."""
    return [
        np.asarray(setup.lead_in, float)
        for work in plan.passes
        if face is None or work.face is face
        for setup in work.setups
        if setup.lead_in
    ]


def draw_lead_ins(axes: Axes, ways: list[Floats]) -> None:
    """Draw lead-ins into axes, an entry of the legend included; nothing where there are none."""
    if ways:
        colour, width = LEAD_IN
        canvas.add_lines(axes, ways, color=colour, linewidth=width)
        canvas.legend_entry(axes, f"lead-ins: {len(ways)}", color=colour, linewidth=width)


def axis_line(sheet: Sheet, flip: Flip, beyond: float) -> tuple[list[float], list[float]]:
    """Return xs and ys of the line that the sheet is turned over about, a little too long."""
    if flip.kind == "left-right":
        return [flip.axis, flip.axis], [-beyond, sheet.height + beyond]
    return [-beyond, sheet.width + beyond], [flip.axis, flip.axis]


def _draw_blank(axes: Axes, sheet: Sheet, flip: Flip | None, span: float) -> None:
    w, h = sheet.width, sheet.height
    axes.fill([0, w, w, 0], [0, 0, h, h], facecolor="#fafafa", edgecolor="#606060", linewidth=0.8)
    if flip is None:
        return
    across, along = axis_line(sheet, flip, 0.02 * span)
    axes.plot(across, along, color="#808080", linewidth=0.7, linestyle="-.")
    look: dict[str, Any] = {"fontsize": 8, "color": "#606060"}
    if flip.kind == "end-over-end":  # along the edge: beside it there is no room for words
        look |= {"rotation": 90, "va": "center"}
    axes.text(across[1], along[1], f" turned over {flip.kind}", **look)


def _label_places(axes: Axes, plan: Plan, span: float, letters: float) -> None:
    for k, hole in enumerate(plan.holes, start=1):
        x, y = hole.x + 0.7 * hole.diameter, hole.y + 0.7 * hole.diameter
        axes.text(x, y, str(k), fontsize=9, color="#0a6020")
    for k, mark in enumerate(plan.registration.marks, start=1):
        x, y = mark.x + 0.3 * mark.across * mark.size, mark.y + 0.3 * mark.upward * mark.size
        axes.text(x, y, str(k), fontsize=9, color="#0a6020")
    for tie in plan.ties:
        axes.plot([tie.x], [tie.y], marker="o", markersize=7, color="#d01010", fillstyle="none")
    if plan.ties:
        look = {"marker": "o", "color": "#d01010", "fillstyle": "none", "linestyle": "none"}
        canvas.legend_entry(axes, f"ties: {len(plan.ties)}", **look)
    for number, middle in copies(plan):
        x, y = middle
        frame = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "edgecolor": "#808080"}
        axes.text(x, y, str(number), fontsize=letters, ha="center", va="center", bbox=frame)
    marks = strokes(plan, Role.WITNESS)
    if marks:
        x, y = np.vstack(marks).max(axis=0)
        axes.text(x + 0.015 * span, y, "witness mark", fontsize=8, color="#8000a0", va="top")
