"""What lies inside a closed line is cut before it: once that is cut, it is loose."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Stroke
from foldmill_fabricate.toolpath import order

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

FEW = 200
"""Corners of a closed line up to which it may begin at any of them, where that saves travel."""
_CHUNK = 500


def inside_first(strokes: Sequence[Stroke], repeats: int, start: Floats) -> tuple[Stroke, ...]:
    """Return the strokes in order of work, those inside others first.

    What lies inside another has its box inside the other's. By boxes alone some come first that
    need not, which costs travel only; and it stays quick however many corners there are.

    start : (2,) where the tool is.
    """
    turned = max(len(stroke.points) for stroke in strokes) <= FEW
    depth = depths(strokes)
    found: list[Stroke] = []
    at = start
    for level in sorted(set(depth.tolist()), reverse=True):
        own = [stroke for stroke, deep in zip(strokes, depth, strict=True) if deep == level]
        found += order.sorted_strokes(own, repeats, at, turned=turned)
        at = np.array(found[-1].points[-1])
    return tuple(found)


def depths(strokes: Sequence[Stroke]) -> Indices:
    """Return (n,) in how many boxes of closed strokes the box of each one lies."""
    import shapely

    corners = [np.asarray(stroke.points, float) for stroke in strokes]
    low = np.array([spots.min(axis=0) for spots in corners])
    high = np.array([spots.max(axis=0) for spots in corners])
    boxes = shapely.box(*low.T, *high.T)
    closed = np.flatnonzero([stroke.closed for stroke in strokes])
    found = np.zeros(len(strokes), np.intp)
    tree = shapely.STRtree(boxes[closed])
    for begin in range(0, len(strokes), _CHUNK):
        i, j = tree.query(boxes[begin : begin + _CHUNK])
        i, j = i + begin, closed[j]
        within = ((low[i] >= low[j]) & (high[i] <= high[j])).all(axis=1) & (i != j)
        within &= ((low[i] > low[j]) | (high[i] < high[j])).any(axis=1)
        found += np.bincount(i[within], minlength=len(strokes))
    return found
