"""The lines of a file as they are drawn, before anybody knows whether they are a crease pattern.

Every reader of lines (CP, OPX, SVG, DXF) gives a Drawing in the file's own coordinates and says
which way its y axis points. There is one policy on that, here and for writers as well: what is up
on the screen is up on the sheet. So files with y downward have y negated, mountains stay mountains,
and a pattern that turns to the left still does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.pattern import Floats

Colour = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""
LARGEST = 1e9
"""In any unit; no drawing is larger, and areas beyond overflow."""


@dataclass(frozen=True)
class Look:
    """What a line is drawn in; what it means is said by its letter, its layer or its colour."""

    letter: str = ""
    """One of B M V F U where the format says it by itself; else empty."""
    layers: tuple[str, ...] = ()
    """Names of the groups it lies in, and its own; the innermost last."""
    colour: Colour | None = None
    opacity: float = 1.0
    """0 to 1; 180 times it is how far a mountain or valley folds."""

    @property
    def hex(self) -> str:
        """The colour as #rrggbb; empty without one."""
        return "" if self.colour is None else "#{:02x}{:02x}{:02x}".format(*self.colour)


@dataclass(frozen=True, eq=False)
class Drawing:
    """Straight lines and their looks."""

    segments: Floats
    """(n, 2, 2) in the file's units, as they stand in the file."""
    looks: Sequence[Look]
    """n of them."""
    down: bool
    """True where the file's y axis points down the screen."""
    millimetres: float | None = None
    """mm in a unit of the file; None where the file does not say."""
    notes: tuple[str, ...] = ()
    """Sentences for people on what was left out or drawn otherwise."""
    title: str = ""

    def upright(self) -> Floats:
        """Return the lines (n, 2, 2) with y up, as they are seen."""
        return flipped(self.segments) if self.down else self.segments


def flipped(points: Floats) -> Floats:
    """Return points (…, 2) with y turned: from a screen's y downward to the sheet's, or back."""
    return points * [1.0, -1.0] + 0.0  # so that no zero is negative


def drawing_of(
    segments: Sequence[Sequence[float]],
    looks: Sequence[Look],
    *,
    down: bool,
    millimetres: float | None = None,
    notes: Sequence[str] = (),
    title: str = "",
    limits: Limits = DEFAULT,
) -> Drawing:
    """Return a drawing of lines [x0, y0, x1, y1].

    Raises UnreadableFile without lines, with too many, or where one is not finite, by its number.
    """
    limits.check_lines(len(segments))
    if not len(segments):
        raise UnreadableFile("There are no lines in this file.")
    table = np.array(segments, float).reshape(-1, 2, 2)
    wrong = np.flatnonzero(~(np.abs(table) <= LARGEST).all(axis=(1, 2)))
    if len(wrong):
        raise UnreadableFile(
            f"The coordinates of line {wrong[0] + 1} are not all numbers within a billion."
        )
    return Drawing(table, tuple(looks), down, millimetres, tuple(notes), title)
