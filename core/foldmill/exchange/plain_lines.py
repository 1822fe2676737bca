"""A fold as ORIPA's two formats hold it: lines with y downward, of four types and no fold angle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from foldmill.design import Fold
from foldmill.errors import InvalidInput
from foldmill.exchange.drawing import Look, flipped
from foldmill.pattern import Assignment, CreasePattern, Floats
from foldmill.slits import sewn
from foldmill.tolerances import CLOSED_DEG

AUXILIARY, CUT, MOUNTAIN, VALLEY = range(4)
_TYPES = {
    Assignment.B: CUT,
    Assignment.C: CUT,
    Assignment.M: MOUNTAIN,
    Assignment.V: VALLEY,
    Assignment.F: AUXILIARY,
}
LOOKS = {AUXILIARY: Look("F"), CUT: Look("B"), MOUNTAIN: Look("M"), VALLEY: Look("V")}
"""What each type is taken for; a cut with paper on both its sides becomes an inner cut later."""
CANVAS = 400.0
"""Units: the side of ORIPA's sheet, whose middle is (0, 0)."""


class Line(NamedTuple):
    """A line in the file: its type and its two ends, y downward."""

    type: int
    x0: float
    y0: float
    x1: float
    y1: float


def lines_of(fold: Fold, canvas: float | None) -> list[Line]:
    """Return the lines of a fold, mm; or scaled and moved to fill a canvas about (0, 0).

    Raises InvalidInput for creases that are neither mountain nor valley: ORIPA refuses such files.
    """
    pattern = sewn(fold.pattern).pattern
    _refuse_unassigned(pattern)
    own = np.flatnonzero(~np.asarray(pattern.added, bool))
    places = flipped(_on_canvas(pattern.vertices, canvas))
    ends = places[pattern.edges[own]].reshape(-1, 4).tolist()
    codes = pattern.assignments[own].tolist()
    return [Line(_TYPES[Assignment(code)], *end) for code, end in zip(codes, ends, strict=True)]


def losses(fold: Fold) -> tuple[str, ...]:
    """Return sentences on what of a fold these formats do not hold."""
    pattern = fold.pattern
    partly = np.count_nonzero(
        (np.abs(pattern.fold_angles) > 0) & (np.abs(pattern.fold_angles) < 180 - CLOSED_DEG)
    )
    cuts = pattern.count(Assignment.C)
    said = [
        f"{partly} creases fold only partly; the file holds no fold angles." if partly else "",
        f"{cuts} inner cuts are written as the outline is." if cuts else "",
        "The folded form is left out." if fold.folded is not None else "",
    ]
    return tuple(sentence for sentence in said if sentence)


def _refuse_unassigned(pattern: CreasePattern) -> None:
    count = pattern.count(Assignment.U)
    if count:
        raise InvalidInput(
            f"{count} creases are neither mountain nor valley, and this format has no letter for "
            f"them. Assign them, or write .fold or .svg."
        )


def _on_canvas(points: Floats, canvas: float | None) -> Floats:
    if canvas is None:
        return points
    low, high = points.min(axis=0), points.max(axis=0)
    placed: Floats = (points - (low + high) / 2) * (canvas / float((high - low).max()))
    return placed
