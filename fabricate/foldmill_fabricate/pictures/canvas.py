"""Figures without global state and without a clock in their bytes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from foldmill import Fold
from foldmill.exchange.marking import warning

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM_PER_INCH = 25.4
ALARM = "#c00000"
DPI = 120
MANY = 4000
"""Lines of one look that a page can still show one by one."""
THINNEST = 0.2
"""Share of their usual width that lines keep, however many they are."""


@contextmanager
def own_style() -> Iterator[None]:
    """Draw with matplotlib's defaults, whatever the user's own settings are; restores them."""
    import matplotlib as mpl

    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams["svg.hashsalt"] = "foldmill"  # names inside an SVG are else drawn by lot
        mpl.rcParams["pdf.fonttype"] = 42  # whole letters, so that the words can be searched
        yield


def figure(width: float, height: float) -> Figure:
    """Return an empty white figure of this size in mm."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width / MM_PER_INCH, height / MM_PER_INCH), dpi=DPI)


def warn(on: Figure, fold: Fold) -> None:
    """Write in red at the foot of a figure that a fold which was marked does not fold."""
    on.text(0.5, 0.012, warning(fold), ha="center", color=ALARM, fontsize=11, weight="bold")


def flat_axes(on: Figure, box: tuple[float, float, float, float]) -> Axes:
    """Add axes without frame and ticks, one mm as long upward as sideways.

    box : left, bottom, width, height as shares of the figure.
    """
    axes = on.add_axes(box)
    axes.set_axis_off()
    axes.set_aspect("equal")
    return axes


def png(drawn: Figure) -> bytes:
    """Return the figure as PNG without a word on when and by what it was made."""
    out = BytesIO()
    drawn.savefig(out, format="png", metadata={"Software": None})
    return out.getvalue()


def svg(drawn: Figure) -> bytes:
    """Return the figure as SVG without a word on when and by what it was made."""
    out = BytesIO()
    drawn.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    return out.getvalue()


def add_lines(axes: Axes, lines: ArrayLike | list[ArrayLike], **look: object) -> None:
    """Draw many lines, each (n, 2), in one look and with round ends.

    Very many become dots inside a PDF or SVG, thinner: each by itself would fill megabytes, and
    they would run into each other.
    """
    from matplotlib.collections import LineCollection

    if (count := len(lines)) > MANY:  # type: ignore[arg-type]
        width = float(look.get("linewidth", 1.0)) * max((MANY / count) ** 0.5, THINNEST)  # type: ignore[arg-type]
        look |= {"rasterized": True, "linewidth": width}
    axes.add_collection(LineCollection(lines, capstyle="round", **look))  # type: ignore[arg-type]


def legend_entry(axes: Axes, label: str, **look: object) -> None:
    """Add a line to the legend that is nowhere in the drawing."""
    axes.plot([], [], label=label, **look)  # type: ignore[arg-type]


def scale_bar(axes: Axes, x: float, y: float, span: float) -> None:
    """Draw a bar of a round number of mm, about a fifth of ``span``, its left end at x, y."""
    length = round_length(span / 5)
    tick = span / 120
    look = {"color": "black", "linewidth": 1.2}
    axes.plot([x, x + length], [y, y], **look)  # type: ignore[arg-type]
    for end in (x, x + length):
        axes.plot([end, end], [y - tick, y + tick], **look)  # type: ignore[arg-type]
    axes.text(x + length + 2 * tick, y, f"{length:g} mm", va="center", fontsize=9)


def round_length(about: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20, 50 … (and 0.5, 0.2 …) that is at most ``about``."""
    from math import floor, log10

    decade = 10.0 ** floor(log10(about))
    return max(step * decade for step in (1, 2, 5) if step * decade <= about * (1 + 1e-9))
