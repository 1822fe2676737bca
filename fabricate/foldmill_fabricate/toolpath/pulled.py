"""Ways of a tool that may only pull the sheet: a machine that feeds it without a cutting mat.

Rollers hold such a sheet along one line. A tool that goes away from them along the feed pulls the
sheet taut; one that comes towards them pushes it into a bulge, and scores nothing. Across the feed
it may go either way. So a stroke is divided where it turns back along the feed, each part begins
at the end from which it is pulled, and a repeat lifts and goes back instead of there and back.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Operation, Stroke
from foldmill_fabricate.toolpath.traversal import first_part, traversal

Floats = NDArray[np.float64]
Pull = Literal["up", "down"]

LEVEL_MM = 1e-6
"""mm. A side that rises by less lies across the feed; it is rounding."""


def ways(stroke: Stroke, seen: Floats, operation: Operation, pull: Pull) -> list[Floats]:
    """Return what the tool does with itself down along one stroke, in order, repeats included.

    seen : (n, 2) mm, the stroke's points as they lie on the carrier, y along the feed.
    """
    if not _sides(seen, pull).any():  # across the feed all the way
        return [traversal(_as(stroke, seen), operation)]
    found = [part for part in parts(seen, pull) for _ in range(operation.repeats)]
    if stroke.closed and operation.overcut > 0:
        found += parts(first_part(seen, operation.overcut), pull)
    return found


def parts(way: Floats, pull: Pull) -> list[Floats]:
    """Divide a way (n, 2) where it turns back along the feed; each part is one that pulls."""
    sides = _sides(way, pull)
    ahead = sides[sides != 0]
    if not len(ahead):
        return [way]
    # A side across the feed goes on as the one before it, or at the start as the first that rises.
    last = np.maximum.accumulate(np.where(sides != 0, np.arange(len(sides)), -1))
    goes = np.where(last < 0, ahead[0], sides[last])
    cuts = [0, *(np.flatnonzero(np.diff(goes)) + 1).tolist(), len(sides)]
    return [
        way[low : high + 1] if goes[low] > 0 else way[low : high + 1][::-1]
        for low, high in pairwise(cuts)
    ]


def _sides(way: Floats, pull: Pull) -> NDArray[np.int64]:
    """Return of each side whether it pulls (1), pushes (-1) or lies across the feed (0)."""
    rise = np.diff(way[:, 1]) * (1 if pull == "up" else -1)
    return np.where(np.abs(rise) <= LEVEL_MM, 0, np.sign(rise)).astype(np.int64)


def _as(stroke: Stroke, seen: Floats) -> Stroke:
    return replace(stroke, points=tuple((x, y) for x, y in seen.tolist()))
