"""A crease as a row of cuts: real strokes, because most senders cut a drawn dash line solid.

    n = max(1, round((L − g) / (c + g))),   s = L / (n·c + (n + 1)·g)

A row of n cuts c and n + 1 gaps g is stretched by s to the crease's length L, so that both ends are
gaps (lands) of one size. Where such a land would be shorter than asked, the lands are as asked and
the rest is stretched.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.errors import InvalidInput

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Dashes:
    """How a line is perforated, mm."""

    cut: float
    gap: float
    land: float
    """Least length left whole at both ends, so that no cut reaches a vertex."""

    def __post_init__(self) -> None:
        for name in ("cut", "gap", "land"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise InvalidInput(f"A perforation's {name} must be more than 0 mm, not {value:g}.")


def perforated(start: Floats, end: Floats, dashes: Dashes) -> Floats:
    """Return the cuts (n, 2, 2) of a straight line, mm; none where its lands leave no room.

    start, end : (2,) mm.
    """
    length = float(np.hypot(*(end - start)))
    spans = _spans(length, dashes)
    if not len(spans):
        return np.zeros((0, 2, 2))
    cuts: Floats = start + (spans / length)[:, :, None] * (end - start)
    return cuts


def shortest(dashes: Dashes) -> float:
    """Return the length, mm, below which a line has no room for half a cut between its lands."""
    return 2 * dashes.land + dashes.cut / 2


def _spans(length: float, dashes: Dashes) -> Floats:
    """Return where cuts begin and end (n, 2), mm from the start."""
    if length < shortest(dashes):
        return np.zeros((0, 2))
    cut, gap = dashes.cut, dashes.gap
    count = max(1, round((length - gap) / (cut + gap)))
    stretch = length / (count * cut + (count + 1) * gap)
    if gap * stretch >= dashes.land:
        first, cut, gap = gap * stretch, cut * stretch, gap * stretch
    else:
        first, inner = dashes.land, length - 2 * dashes.land
        count = max(1, round((inner + gap) / (cut + gap)))
        stretch = inner / (count * cut + (count - 1) * gap)
        cut, gap = cut * stretch, gap * stretch
    begin = first + (cut + gap) * np.arange(count)
    return np.column_stack([begin, begin + cut])
