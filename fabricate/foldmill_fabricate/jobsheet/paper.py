"""A sheet of A4 whose coordinates are mm from its lower left corner, printed at true scale."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from foldmill_fabricate.pictures import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT = 210.0, 297.0
LEFT, RIGHT, TOP, BOTTOM = 15.0, 195.0, 283.0, 12.0
LINE = 1.45
"""Distance of baselines, in heights of the letters."""
BOLD = 0.69
"""Width of bold letters, in heights."""
MM_PER_POINT = canvas.MM_PER_INCH / 72


class Paper:
    """One page. ``y`` is where the next line goes, mm; it wanders down as things are added."""

    def __init__(self) -> None:
        self.figure = canvas.figure(WIDTH, HEIGHT)
        self.axes = self.figure.add_axes((0, 0, 1, 1))
        self.axes.set_axis_off()
        self.axes.set_xlim(0, WIDTH)
        self.axes.set_ylim(0, HEIGHT)
        self.y = TOP

    def line(self, words: str, size: float = 9, indent: float = 0.0, **look: object) -> None:
        """Add words, broken into lines that fit the page, ``indent`` mm from the margin."""
        for part in textwrap.wrap(words, _letters(RIGHT - LEFT - indent, size)):
            self.axes.text(LEFT + indent, self.y, part, fontsize=size, va="baseline", **look)  # type: ignore[arg-type]
            self.y -= size * MM_PER_POINT * LINE

    def title(self, words: str, stamp: str = "") -> None:
        """Add the page's title; stamp : what must not be overlooked, in a red frame beside it."""
        if stamp:
            frame = {"facecolor": "#ffe0e0", "edgecolor": "#c00000", "boxstyle": "round,pad=0.35"}
            look = {"fontsize": 13, "weight": "bold", "color": "#c00000", "ha": "right"}
            self.axes.text(RIGHT - 2, self.y - 1, stamp, bbox=frame, **look)  # type: ignore[arg-type]
        room = RIGHT - LEFT - (32 if stamp else 0)
        size = room / (BOLD * MM_PER_POINT * max(1, len(words)))
        self.axes.text(LEFT, self.y, words, fontsize=min(16.0, size), va="baseline", weight="bold")
        self.y -= 16 * MM_PER_POINT * LINE

    def listed(self, sentences: Sequence[str], size: float, more: str) -> None:
        """Add sentences as far as the page has room; then how many are left, and ``more``."""
        for k, sentence in enumerate(sentences):
            if self.y - self.height_of([sentence, "and more"], size) < BOTTOM:
                self.line(f"•  {len(sentences) - k} {more}.", size)
                return
            self.line(f"•  {sentence}", size)

    def foot(self, words: str) -> None:
        """Add words at the page's foot: what it belongs to, should the pages part."""
        self.axes.text(RIGHT, 6, words, fontsize=7, color="#606060", ha="right", va="baseline")

    def height_of(self, sentences: Sequence[str], size: float = 9) -> float:
        """Return how much room sentences take, mm."""
        rows = (len(textwrap.wrap(said, _letters(RIGHT - LEFT, size))) for said in sentences)
        return sum(rows) * size * MM_PER_POINT * LINE

    def heading(self, words: str) -> None:
        """Add a heading with air above it."""
        self.y -= 3.5
        self.line(words, 11, weight="bold")
        self.y -= 0.5

    def row(
        self, cells: Sequence[str], stops: Sequence[float], size: float = 8.5, **look: object
    ) -> None:
        """Add one row of a table; ``stops`` are the columns' left ends, mm from the margin."""
        for cell, stop in zip(cells, stops, strict=True):
            self.axes.text(LEFT + stop, self.y, cell, fontsize=size, va="baseline", **look)  # type: ignore[arg-type]
        self.y -= size * MM_PER_POINT * LINE

    def rule(self, indent: float = 0.0) -> None:
        """Add a thin line under a table's head, ``indent`` mm from the margin."""
        height = self.y + 2.6
        self.axes.plot([LEFT + indent, RIGHT], [height, height], color="#808080", linewidth=0.5)
        self.y -= 0.8

    def window(self, x: float, y: float, width: float, height: float) -> Axes:
        """Return axes for a picture, lower left corner and size in mm of the page."""
        box = (x / WIDTH, y / HEIGHT, width / WIDTH, height / HEIGHT)
        return canvas.flat_axes(self.figure, box)

    def check_bar(self, y: float) -> None:
        """Draw 100 mm that measure 100 mm where the page is printed at its own size."""
        look = {"color": "black", "linewidth": 0.8, "solid_capstyle": "butt"}
        self.axes.plot([LEFT, LEFT + 100], [y, y], **look)  # type: ignore[arg-type]
        for tenth in range(11):
            tick = 3.0 if tenth % 5 == 0 else 1.5
            self.axes.plot([LEFT + 10 * tenth] * 2, [y, y + tick], **look)  # type: ignore[arg-type]
        said = "100 mm: measure it. If not, print at 100 %."
        self.axes.text(LEFT + 104, y, said, fontsize=9, va="baseline")


def _letters(width: float, size: float) -> int:
    """Return how many letters of this size surely fit: words take 0.52 of their height."""
    return int(width / (0.52 * size * MM_PER_POINT))
