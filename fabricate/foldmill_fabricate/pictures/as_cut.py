"""A sheet as its record says: both faces as one looks at them, certain, doubtful and left."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import fill, wrap
from typing import TYPE_CHECKING, Any

from foldmill_fabricate.as_cut import FaceAsCut, Kind, Line, as_cut
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.plotter.ledger import SheetRecord, State
from foldmill_fabricate.remaking.words import listed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WORDS = {Kind.CERTAIN: "cut for certain", Kind.DOUBTFUL: "in doubt", Kind.LEFT: "left"}
LOOKS: dict[Kind, list[tuple[str, float, str]]] = {
    Kind.LEFT: [("#707070", 0.9, ":")],
    Kind.DOUBTFUL: [("#f0a030", 6.0, "-"), ("#000000", 1.3, "--")],
    Kind.CERTAIN: [("#102a80", 1.9, "-")],
}
"""Colour, width in points and style of each, one over the other: told apart in black and white."""
NAMED = 24
"""Strokes in doubt that are still named one by one."""
LETTERS = 110
"""Letters in a line of the title."""


def as_cut_picture(plan: Plan, programs: Mapping[str, bytes], sheet: SheetRecord) -> bytes:
    """Return a PNG of both faces of a sheet, each as one looks at it.

    plan, programs : what the sheet was begun from. Strokes in doubt carry their numbers. Raises
    CannotPlan for another job's sheet.
    """
    faces = as_cut(plan, programs, sheet)
    with canvas.own_style():
        figure = canvas.figure(130 * len(faces) + 10, 165)
        width = 1 / len(faces)
        for k, face in enumerate(faces):
            axes = canvas.flat_axes(figure, (k * width + 0.02, 0.12, width - 0.04, 0.70))
            _draw(axes, plan, face)
        _legend(figure, [line for face in faces for line in face.lines])
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


def _draw(axes: Axes, plan: Plan, face: FaceAsCut) -> None:
    w, h = face.width, face.height
    span = max(w, h)
    axes.fill([0, w, w, 0], [0, 0, h, h], facecolor="#fcfcfc", edgecolor="#404040", linewidth=0.9)
    for kind, looks in LOOKS.items():
        lines = [line.points for line in face.of(kind)]
        for colour, width, style in looks if lines else ():
            canvas.add_lines(axes, lines, color=colour, linewidth=width, linestyle=style)
    _name_doubts(axes, face)
    turned = f", turned over {plan.flip.kind}" if face.face is Face.REVERSE else ""
    words = [f"{face.face.value.upper()} as it is seen{turned}", *wrap(_told(face), 60)[:4]]
    axes.set_title("\n".join(words), fontsize=8.5)
    canvas.scale_bar(axes, 0, -0.045 * span, span)
    axes.set_xlim(-0.03 * span, w + 0.12 * span)
    axes.set_ylim(-0.07 * span, h + 0.02 * span)


def counts(lines: Sequence[Line]) -> dict[str, int]:
    """Return how many strokes are certain, in doubt and left."""
    kinds = [line.kind for line in lines]
    return {word: kinds.count(kind) for kind, word in WORDS.items()}


def _name_doubts(axes: Axes, face: FaceAsCut) -> None:
    """Write the numbers of strokes in doubt beside the sheet, each with a line to its stroke."""
    doubts = face.of(Kind.DOUBTFUL)
    if not 0 < len(doubts) <= NAMED:
        return
    middles = {line: line.points[:2].mean(axis=0) for line in doubts}
    step = face.height / (len(doubts) + 1)
    upwards = sorted(doubts, key=lambda line: float(middles[line][1]))
    for place, line in enumerate(upwards, 1):
        axes.annotate(
            str(line.number),
            xy=tuple(middles[line].tolist()),
            xytext=(1.03 * face.width, place * step),
            fontsize=8,
            va="center",
            arrowprops={"arrowstyle": "-", "linewidth": 0.7, "color": "#a06000"},
        )


def _told(face: FaceAsCut) -> str:
    """Say what is certain, in doubt, with the numbers that a person says them by, and left."""
    told = [f"{n} {word}" for word, n in counts(face.lines).items() if n]
    doubts = face.of(Kind.DOUBTFUL)
    for program in dict.fromkeys(line.program for line in doubts):
        mine = [line.number - 1 for line in doubts if line.program == program]
        told.append(f"in doubt of {program}: {listed(mine)}")
    return "; ".join(told)


def _legend(figure: Any, lines: Sequence[Line]) -> None:
    from matplotlib.legend_handler import HandlerTuple
    from matplotlib.lines import Line2D

    line: Any = Line2D
    entries = [
        tuple(line([], [], color=c, linewidth=w, linestyle=s) for c, w, s in LOOKS[kind])
        for kind in WORDS
    ]
    names = [f"{word}: {count}" for word, count in counts(lines).items()]
    over = {tuple: HandlerTuple(ndivide=1)}  # both looks of one kind over each other
    look = {"loc": "lower center", "ncols": 3, "frameon": False, "handlelength": 4}
    figure.legend(entries, names, handler_map=over, **look)
