"""Which boxes of the plane meet, which points lie in which: by sorting along x, then looking at y.

For lines of a sheet, whose boxes are short, this is quicker than building a tree, and needs no
library; n boxes spread evenly over a sheet have about n·√n neighbours along x.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


_BLOCK = 1_000_000
"""Neighbours along x looked at in one go: about 50 MB, however many boxes lie side by side."""


def meeting(low: Floats, high: Floats) -> Indices:
    """Return the pairs (k, 2), lower number first, of boxes that overlap or touch.

    low, high : (n, 2) corners of the boxes.
    """
    order = np.argsort(low[:, 0], kind="stable")
    low, high = low[order], high[order]
    stops = np.searchsorted(low[:, 0], high[:, 0], side="right")
    found = [np.zeros((0, 2), np.intp)]
    for one, two in _spread(np.arange(1, len(order) + 1), stops):
        meets = (low[one, 1] <= high[two, 1]) & (high[one, 1] >= low[two, 1])
        a, b = order[one[meets]], order[two[meets]]
        found.append(np.column_stack([np.minimum(a, b), np.maximum(a, b)]))
    return np.concatenate(found)


def within(points: Floats, low: Floats, high: Floats) -> Indices:
    """Return the pairs (k, 2) of a point (n, 2) and a box it lies in; low, high : (m, 2)."""
    order = np.argsort(points[:, 0], kind="stable")
    x, y = points[order].T
    starts, stops = np.searchsorted(x, low[:, 0], "left"), np.searchsorted(x, high[:, 0], "right")
    found = [np.zeros((0, 2), np.intp)]
    for box, spot in _spread(starts, stops):
        inside = (y[spot] >= low[box, 1]) & (y[spot] <= high[box, 1])
        found.append(np.column_stack([order[spot[inside]], box[inside]]))
    return np.concatenate(found)


def _spread(starts: Indices, stops: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Yield the row and the number of everything in the ranges starts[row] … stops[row] - 1."""
    counts = np.maximum(stops - starts, 0)
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    for begin in range(0, total, _BLOCK):
        place = np.arange(begin, min(begin + _BLOCK, total))
        row = np.searchsorted(ends, place, side="right")
        yield row, place - (ends - counts)[row] + starts[row]
