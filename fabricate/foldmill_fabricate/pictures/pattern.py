"""The crease pattern as a picture: mountains red, valleys blue, the outline black."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from foldmill import Assignment, CreasePattern, Fold
from foldmill.slits import sewn
from foldmill_fabricate.pictures import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Look(NamedTuple):
    """How a kind of edge is drawn and called."""

    name: str
    colour: str
    width: float
    """points"""
    style: str | tuple[float, tuple[float, ...]] = "-"
    """of matplotlib: a name, or where the dashes begin and their lengths in line widths"""


LOOKS = {
    Assignment.F: Look("flat", "#b0b0b0", 0.6),
    Assignment.U: Look("unassigned", "#c000c0", 1.2, "--"),
    Assignment.V: Look("valley", "#1f4fd8", 1.4),
    Assignment.M: Look("mountain", "#d62020", 1.4),
    Assignment.C: Look("inner cut", "#109030", 1.6),
    Assignment.B: Look("outline", "#000000", 1.6),
}
"""In order of drawing: what matters most comes last, on top."""
PRINTED = {
    **LOOKS,
    Assignment.V: Look("valley", "#1f4fd8", 1.1, (0, (3.2, 2.0))),
    Assignment.M: Look("mountain", "#c01010", 1.3),
}
"""For paper, and copies of it in black and white: mountains are solid, valleys dashed."""


def pattern_picture(fold: Fold) -> bytes:
    """Return a PNG of the crease pattern with legend, counts and a scale bar."""
    with canvas.own_style():
        figure = canvas.figure(190, 200)
        draw(canvas.flat_axes(figure, (0.02, 0.05, 0.96, 0.88)), fold.pattern)
        figure.suptitle(str(fold.meta.get("title", "Crease pattern")), fontsize=12)
        canvas.warn(figure, fold)
        return canvas.png(figure)


def draw(
    axes: Axes,
    pattern: CreasePattern,
    *,
    legend: bool = True,
    thickness: float = 1.0,
    looks: Mapping[Assignment, Look] = LOOKS,
) -> None:
    """Draw a pattern into axes in its own mm; with legend and scale bar below, or bare.

    thickness : of the lines, as a share of their usual one. looks : how each kind is drawn.

    A slit is drawn once, as an inner cut.
    """
    pattern = sewn(pattern).pattern
    ends = pattern.vertices[pattern.edges]
    for kind, look in looks.items():
        chosen = pattern.assignments == kind
        if chosen.any():
            width = thickness * look.width
            canvas.add_lines(
                axes, ends[chosen], color=look.colour, linewidth=width, linestyle=look.style
            )
    low, high = pattern.vertices.min(axis=0), pattern.vertices.max(axis=0)
    margin = 0.02 * pattern.size
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - (4 if legend else 1) * margin, high[1] + margin)
    if legend:
        canvas.scale_bar(axes, low[0], low[1] - 2.5 * margin, pattern.size)
        _add_legend(axes, pattern)


def _add_legend(axes: Axes, pattern: CreasePattern) -> None:
    for kind, look in reversed(LOOKS.items()):
        number = int(np.count_nonzero(pattern.assignments == kind))
        if number:
            style = {"color": look.colour, "linewidth": look.width, "linestyle": look.style}
            canvas.legend_entry(axes, f"{number} {look.name}", **style)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=6, frameon=False, fontsize=9)
