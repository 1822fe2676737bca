"""In which order strokes are drawn, and how near that is to the best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Stroke
from foldmill_fabricate.toolpath import closed, sequence

Floats = NDArray[np.float64]


def sorted_strokes(
    strokes: Sequence[Stroke],
    repeats: int,
    start: Floats,
    *,
    nested: bool = False,
    turned: bool = True,
) -> tuple[Stroke, ...]:
    """Return the strokes in order of work and direction; start : (2,) where the tool is.

    nested : whether what lies inside a closed stroke comes before it, as it must where that is cut
    through; turned : whether a closed stroke begins at the vertex that saves most travel. An even
    number of repeats ends an open stroke where it began.
    """
    returns = repeats % 2 == 0
    depth = closed.depths(strokes) if nested else np.zeros(len(strokes), np.intp)
    found: list[Stroke] = []
    at = np.asarray(start, float)
    for level in sorted(set(depth.tolist()), reverse=True):
        own = [stroke for stroke, deep in zip(strokes, depth, strict=True) if deep == level]
        done = _ordered(own, at, returns)
        at = np.array(done[-1].points[0 if returns or done[-1].closed else -1])
        found += done
    return tuple(closed.begun(found, start, returns) if turned else found)


def _ordered(strokes: Sequence[Stroke], start: Floats, returns: bool) -> list[Stroke]:
    ends = np.array([[s.points[0], s.points[-1]] for s in strokes]).reshape(-1, 2, 2)
    return [
        _backwards(strokes[k]) if backwards and not strokes[k].closed else strokes[k]
        for k, backwards in sequence.order(ends, start, returns=returns)
    ]


def by_middles(strokes: Sequence[Stroke], start: Floats) -> tuple[Stroke, ...]:
    """Return strokes whose direction is not ours to choose in an order of near middles.

    start : (2,) where the tool is.
    """
    middles = np.array([np.mean([s.points[0], s.points[-1]], axis=0) for s in strokes])
    ends = np.repeat(middles.reshape(-1, 1, 2), 2, axis=1)
    return tuple(strokes[k] for k, _ in sequence.order(ends, start, returns=True))


def _backwards(stroke: Stroke) -> Stroke:
    return replace(stroke, points=stroke.points[::-1])


def travel(paths: Sequence[Floats], start: Floats) -> float:
    """Return the length of the pen-up moves between polylines drawn in this order, mm."""
    at, total = start, 0.0
    for path in paths:
        total += float(np.hypot(*(path[0] - at)))
        at = path[-1]
    return total
