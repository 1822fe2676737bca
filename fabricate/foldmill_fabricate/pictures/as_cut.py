"""A sheet as its record says: both faces as one looks at them, certain, doubtful and left."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill, wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Face, Fit, Plan
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.plotter.ledger import SheetRecord, State
from foldmill_fabricate.remaking.strokes import Account, Standing, lying
from foldmill_fabricate.remaking.words import listed
from foldmill_fabricate.sheet import flipped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]

CERTAIN, DOUBTFUL, LEFT = "cut for certain", "in doubt", "left"
_KINDS = {
    Standing.CERTAIN: CERTAIN,
    Standing.DOUBTFUL: DOUBTFUL,
    Standing.HALF: DOUBTFUL,
    Standing.LEFT: LEFT,
}
LOOKS: dict[str, list[tuple[str, float, str]]] = {
    LEFT: [("#707070", 0.9, ":")],
    DOUBTFUL: [("#f0a030", 6.0, "-"), ("#000000", 1.3, "--")],
    CERTAIN: [("#102a80", 1.9, "-")],
}
"""Colour, width in points and style of each, one over the other: told apart in black and white."""
NAMED = 24
"""Strokes in doubt that are still named one by one."""
LETTERS = 110
"""Letters in a line of the title."""


def as_cut_picture(plan: Plan, sheet: SheetRecord, fit: Fit | None = None) -> bytes:
    """Return a PNG of both faces of a sheet, each as one looks at it.

    plan : what the sheet was begun from; fit : how its reverse lay, where it was fitted to marks.
    Strokes in doubt carry their numbers. Raises CannotPlan for another job's sheet.
    """
    found = lying(plan, sheet, fit)
    faces = [face for face in Face if any(account.face is face for account in found)]
    with canvas.own_style():
        figure = canvas.figure(130 * len(faces) + 10, 165)
        width = 1 / len(faces)
        for k, face in enumerate(faces):
            axes = canvas.flat_axes(figure, (k * width + 0.02, 0.12, width - 0.04, 0.70))
            _draw(axes, plan, sheet, face, [each for each in found if each.face is face])
        _legend(figure, found)
        figure.suptitle(_title(plan, sheet), fontsize=10)
        return canvas.png(figure)


def _title(plan: Plan, sheet: SheetRecord) -> str:
    written = plan.written(sheet.id)
    name = f"Sheet {sheet.id}" + (f", on which {written} is written" if written != sheet.id else "")
    states = ", ".join(f"{one.program.name} {one.state.value}" for one in sheet.records)
    lost = any(one.state is State.SPOILED for one in sheet.records)
    told = "given up" if lost else states
    title = plan.whole.title or "job without a name"
    return "\n".join(fill(line, LETTERS) for line in (f"{name}: {title}", told))


def _draw(axes: Axes, plan: Plan, sheet: SheetRecord, face: Face, own: Sequence[Account]) -> None:
    w, h = plan.sheet.width, plan.sheet.height
    span = max(w, h)
    axes.fill([0, w, w, 0], [0, 0, h, h], facecolor="#fcfcfc", edgecolor="#404040", linewidth=0.9)
    for kind, looks in LOOKS.items():
        lines = [_seen(plan, each) for each in own if _KINDS[each.standing] == kind]
        for colour, width, style in looks if lines else ():
            canvas.add_lines(axes, lines, color=colour, linewidth=width, linestyle=style)
    _name_doubts(axes, plan, own)
    turned = f", turned over {plan.flip.kind}" if face is Face.REVERSE else ""
    words = [f"{face.value.upper()} as it is seen{turned}", *wrap(_told(sheet, own), 60)[:4]]
    axes.set_title("\n".join(words), fontsize=8.5)
    canvas.scale_bar(axes, 0, -0.045 * span, span)
    axes.set_xlim(-0.03 * span, w + 0.12 * span)
    axes.set_ylim(-0.07 * span, h + 0.02 * span)


def counts(found: Sequence[Account]) -> dict[str, int]:
    """Return how many strokes are certain, in doubt and left."""
    kinds = [_KINDS[account.standing] for account in found]
    return {kind: kinds.count(kind) for kind in (CERTAIN, DOUBTFUL, LEFT)}


def _seen(plan: Plan, account: Account) -> Floats:
    points = np.asarray(account.stroke.points, float)
    return flipped(points, plan.flip) if account.face is Face.REVERSE else points


def _name_doubts(axes: Axes, plan: Plan, own: Sequence[Account]) -> None:
    """Write the numbers of strokes in doubt beside the sheet, each with a line to its stroke."""
    doubts = [each for each in own if _KINDS[each.standing] == DOUBTFUL]
    if not 0 < len(doubts) <= NAMED:
        return
    w, h = plan.sheet.width, plan.sheet.height
    middles = [_seen(plan, each)[:2].mean(axis=0) for each in doubts]
    room = np.linspace(0, h, len(doubts) + 2)[1:-1]
    order = sorted(range(len(doubts)), key=lambda k: float(middles[k][1]))
    for height, k in zip(room.tolist(), order, strict=True):
        axes.annotate(
            listed(_numbers(doubts[k])),
            xy=tuple(middles[k].tolist()),
            xytext=(1.03 * w, height),
            fontsize=8,
            va="center",
            arrowprops={"arrowstyle": "-", "linewidth": 0.7, "color": "#a06000"},
        )


def _numbers(account: Account) -> list[int]:
    return [k for k, how in account.standings.items() if _KINDS[how] == DOUBTFUL]


def _told(sheet: SheetRecord, own: Sequence[Account]) -> str:
    """Say what is certain, in doubt, with the numbers that a person says them by, and left."""
    told = [f"{n} {kind}" for kind, n in counts(own).items() if n]
    for record in sheet.records:
        mine = [k for each in own if each.program == record.number for k in _numbers(each)]
        if mine:
            told.append(f"in doubt of {record.program.name}: {listed(mine)}")
    return "; ".join(told)


def _legend(figure: Any, found: Sequence[Account]) -> None:
    from matplotlib.legend_handler import HandlerTuple
    from matplotlib.lines import Line2D

    line: Any = Line2D
    every = counts(found)
    entries = [
        tuple(line([], [], color=c, linewidth=w, linestyle=s) for c, w, s in LOOKS[kind])
        for kind in every
    ]
    names = [f"{kind}: {count}" for kind, count in every.items()]
    over = {tuple: HandlerTuple(ndivide=1)}  # both looks of one kind over each other
    look = {"loc": "lower center", "ncols": 3, "frameon": False, "handlelength": 4}
    figure.legend(entries, names, handler_map=over, **look)
