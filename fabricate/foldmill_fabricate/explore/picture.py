"""The map of a sweep: what becomes of each configuration, with the forms of some of them.

Two varied parameters make a map, one a strip. Colours differ in lightness as well as in hue, so
that they can be told apart without seeing colours.
"""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from foldmill.batch import Outcome
from foldmill_fabricate.errors import CannotExplore
from foldmill_fabricate.explore.chunk import FAULT
from foldmill_fabricate.explore.grid import Axis
from foldmill_fabricate.explore.stated import stated
from foldmill_fabricate.explore.sweep import Sweep
from foldmill_fabricate.explore.view import View, thumbnails, view
from foldmill_fabricate.pictures import canvas
from foldmill_fabricate.pictures.folded import draw as draw_form

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis as Side
    from matplotlib.figure import Figure

SUFFIXES = (".png", ".svg")
LINE = 110
"""Letters in a line of the title."""
ABOVE_LINES = 5
"""In the order of drawing."""
MOST_TICKS = 12
"""At counts and choices."""
PIXELS = 280
"""Of a form beside the map."""
Box = tuple[float, float, float, float]


class Look(NamedTuple):
    """How an outcome is drawn and called."""

    name: str
    colour: str


LOOKS = {
    Outcome.FREE.value: Look("free", "#2a7fba"),
    Outcome.PENETRATES.value: Look("passes through itself", "#e69f00"),
    Outcome.CROSSES_AXIS.value: Look("crosses the axis", "#d9a3c4"),
    Outcome.NO_CANDIDATE.value: Look("a point has no place", "#eeeeee"),
    Outcome.REFUSED.value: Look("refused", "#8c8c8c"),
    FAULT: Look("the family broke down", "#000000"),
}
"""In order of the legend."""


class Layout(NamedTuple):
    """Where things are: the size in mm, boxes as shares of the figure."""

    size: tuple[float, float]
    map: Box
    forms: list[Box]


def require_picture(file: Path) -> None:
    """Raise CannotExplore, before any work is done, where a picture cannot be written so."""
    if file.suffix.lower() not in SUFFIXES:
        raise CannotExplore(f"{file}: a map is written as .png or .svg.")


def sweep_picture(
    sweep: Sweep[Any], suffix: str = ".png", forms: Sequence[int] = (), row: int | None = None
) -> bytes:
    """Return the map of a sweep as PNG or SVG, the same bytes for the same sweep.

    forms : rows whose folded forms are shown, by default some free ones; row : through which the
    plane goes where more than two parameters vary, by default the first of the forms, or else the
    centre of the largest free region. Raises CannotExplore.
    """
    import matplotlib as mpl

    if row is None and forms:
        row = forms[0]
    seen = view(sweep, row)
    shown = thumbnails(seen, forms)
    with canvas.own_style():
        mpl.rcParams["svg.hashsalt"] = "foldmill"
        drawn = _drawn(seen, shown)
        out = BytesIO()
        if suffix == ".png":
            return canvas.png(drawn)
        drawn.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
        return out.getvalue()


def _drawn(seen: View, shown: list[int]) -> Figure:
    ordered = _ordered(seen, shown)
    layout = (_strip_layout if seen.is_strip else _map_layout)(len(shown))
    drawn = canvas.figure(*layout.size)
    _colour(drawn.add_axes(layout.map), seen)
    axes = _frame(drawn, seen, layout.map)
    for number, (row, box) in enumerate(zip(ordered, layout.forms, strict=True), start=1):
        _form(drawn, axes, seen, (row, number), box)
    _legend(axes, seen, layout)
    _title(drawn, seen)
    return drawn


def _map_layout(count: int) -> Layout:
    """Put the map in the middle, the first half of the forms on its left, the others right."""
    width, height = 320.0, 205.0
    left = (count + 1) // 2
    side = 0.23 if count else 0.10
    box = (side, 0.2, 1 - 2 * side - (0 if count > 1 else -0.13 * bool(count)), 0.66)
    boxes = _column(0.005, left, width / height) + _column(0.825, count - left, width / height)
    return Layout((width, height), box, boxes)


def _column(x: float, count: int, ratio: float) -> list[Box]:
    """Return boxes for so many forms one above the other, the first on top."""
    top, bottom = 0.9, 0.04
    each = (top - bottom) / max(count, 3)
    size = min(each - 0.055, 0.15 * ratio)
    start = top - (top - bottom - count * each) / 2
    return [
        (x + (0.17 - size / ratio) / 2, start - (k + 1) * each + 0.05, size / ratio, size)
        for k in range(count)
    ]


def _strip_layout(count: int) -> Layout:
    """Put the strip below, the forms in a line above it."""
    width, height = 320.0, 118.0 if count else 62.0
    each = 0.94 / max(count, 4)
    size = min(each, 0.44 * height / width)
    start = 0.5 - count * each / 2
    boxes = [
        (start + (k + 0.5) * each - size / 2, 0.46, size, size * width / height)
        for k in range(count)
    ]
    return Layout(
        (width, height), (0.05, 0.21 if count else 0.4, 0.9, 0.09 if count else 0.2), boxes
    )


def _ordered(seen: View, shown: list[int]) -> list[int]:
    """Order forms so that their lines cross little: left half and right half, from above."""
    across = sorted(shown, key=seen.place)
    if seen.is_strip:
        return across
    left = (len(across) + 1) // 2
    halves = (across[:left], across[left:])
    return [row for half in halves for row in sorted(half, key=lambda row: -seen.place(row)[1])]


def _colour(axes: Axes, seen: View) -> None:
    from matplotlib.colors import ListedColormap

    kinds = list(LOOKS)
    cells = np.searchsorted(np.sort(kinds), seen.codes)
    colours = ListedColormap([LOOKS[kind].colour for kind in sorted(kinds)])
    across = seen.axes[0]
    upward = np.array([0.0, 1.0]) if seen.is_strip else _edges(seen.axes[1])
    cells = cells.reshape(len(across.values), -1).T
    axes.pcolormesh(
        _edges(across), upward, cells, cmap=colours, vmin=-0.5, vmax=len(kinds) - 0.5,
        rasterized=True,
    )  # fmt: skip
    axes.set_axis_off()


def _frame(drawn: Figure, seen: View, box: Box) -> Axes:
    """Return axes over the map with frame, ticks and names: the lines to the forms pass between."""
    axes = drawn.add_axes(box, zorder=ABOVE_LINES, facecolor="none")
    across, upward = seen.axes[0], seen.axes[-1]
    axes.set_xlim(*_edges(across)[[0, -1]])
    axes.set_xlabel(across.label, fontsize=11)
    if not seen.is_strip:
        axes.set_ylim(*_edges(upward)[[0, -1]])
        axes.set_ylabel(upward.label, fontsize=11)
    else:
        axes.set_yticks([])
    _tick(axes.xaxis, across)
    if not seen.is_strip:
        _tick(axes.yaxis, upward)
    axes.tick_params(labelsize=9)
    for text in (*axes.get_yticklabels(), axes.yaxis.label):
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 1.5})
    return axes


def _tick(side: Side, axis: Axis) -> None:
    """Put ticks at values of a count or a choice, where the usual ones may fall between them."""
    if axis.is_whole:
        step = -(-len(axis.values) // MOST_TICKS)
        side.set_ticks(axis.values[::step], labels=[f"{value:g}" for value in axis.values[::step]])


def _edges(axis: Axis) -> NDArray[np.float64]:
    """Return the borders (k + 1,) of the cells: halfway between values."""
    values = axis.values
    if len(values) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middles = (values[1:] + values[:-1]) / 2
    return np.array([2 * values[0] - middles[0], *middles, 2 * values[-1] - middles[-1]])


def _form(drawn: Figure, axes: Axes, seen: View, which: tuple[int, int], box: Box) -> None:
    """Draw a form in its box, its number at its place, and a line between them."""
    row, number = which
    fold = seen.sweep.fold(row)
    form = canvas.flat_axes(drawn, box)
    draw_form(form, fold, pixels=PIXELS)
    place = seen.place(row)
    form.text(
        0.5, -0.02, f"{number}: row {row}\n{_caption(seen, row)}",
        transform=form.transAxes, ha="center", va="top", fontsize=8, linespacing=1.25,
    )  # fmt: skip
    _join(drawn, axes, form, place, is_strip=seen.is_strip)
    _dot(axes, place, number, LOOKS[int(seen.sweep.outcomes.codes[row])].colour)


def _caption(seen: View, row: int) -> str:
    values = seen.sweep.grid.values(row)
    return ", ".join(f"{axis.name} {values[axis.name]:.6g}" for axis in seen.axes)


def _join(
    drawn: Figure, axes: Axes, form: Axes, place: tuple[float, float], *, is_strip: bool
) -> None:
    from matplotlib.patches import ConnectionPatch

    is_left = form.get_position().x0 < axes.get_position().x0
    start = (0.5, -0.21) if is_strip else (1.0, 0.5) if is_left else (0.0, 0.5)
    for width, colour in ((2.6, "white"), (1.0, "#222222")):
        drawn.add_artist(
            ConnectionPatch(
                xyA=start, coordsA=form.transAxes, xyB=place, coordsB=axes.transData,
                color=colour, linewidth=width, capstyle="round", zorder=ABOVE_LINES - 1,
            )
        )  # fmt: skip


def _dot(axes: Axes, place: tuple[float, float], number: int, colour: str) -> None:
    """Number a place in a ring of its outcome's colour, which its cell may be too small to show."""
    for edge, width in (("#222222", 3.4), (colour, 1.8)):
        look = {
            "boxstyle": "circle,pad=0.22",
            "facecolor": "white",
            "edgecolor": edge,
            "linewidth": width,
        }
        _number(axes, place, number, look)


def _number(axes: Axes, place: tuple[float, float], number: int, look: dict[str, Any]) -> None:
    axes.annotate(
        str(number), place, ha="center", va="center", fontsize=8, weight="bold",
        bbox=look, annotation_clip=False, zorder=10,
    )  # fmt: skip


def _legend(axes: Axes, seen: View, layout: Layout) -> None:
    from matplotlib.patches import Patch

    number = np.bincount(seen.codes.ravel(), minlength=FAULT + 1)
    entries = [
        Patch(facecolor=look.colour, edgecolor="#444444", linewidth=0.6,
              label=f"{look.name}: {number[kind]:,}")
        for kind, look in LOOKS.items()
        if number[kind]
    ]  # fmt: skip
    below = -16.0 / (layout.map[3] * layout.size[1])
    axes.legend(
        handles=entries, loc="upper center", bbox_to_anchor=(0.5, below), frameon=False,
        fontsize=9.5, ncols=3 if not seen.is_strip and len(entries) > 3 else len(entries),
    )  # fmt: skip


def _title(drawn: Figure, seen: View) -> None:
    sweep = seen.sweep
    cells = f"{seen.rows.size:,} configurations"
    where = f"{cells} of {len(sweep):,}, those with {seen.fixed}" if seen.fixed else cells
    head = "\n".join(
        line
        for words in (f"{sweep.design.title}: {stated(sweep)}", where)
        for line in wrap(words, LINE)
    )
    drawn.suptitle(head, fontsize=12, y=0.98 if seen.is_strip else 0.975)
