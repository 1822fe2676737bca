"""In which order strokes are drawn, and how near that is to the best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Stroke
from foldmill_fabricate.toolpath import sequence

Floats = NDArray[np.float64]


def sorted_strokes(strokes: Sequence[Stroke], repeats: int, start: Floats) -> tuple[Stroke, ...]:
    """Return the strokes in order of work and direction; start : (2,) where the tool is.

    An even number of repeats ends an open stroke where it began.
    """
    ends = np.array([[s.points[0], s.points[-1]] for s in strokes]).reshape(-1, 2, 2)
    return tuple(
        Stroke(points=strokes[k].points[::-1]) if backwards else strokes[k]
        for k, backwards in sequence.order(ends, start, returns=repeats % 2 == 0)
    )


def travel(paths: Sequence[Floats], start: Floats) -> float:
    """Return the length of the pen-up moves between polylines drawn in this order, mm."""
    at, total = start, 0.0
    for path in paths:
        total += float(np.hypot(*(path[0] - at)))
        at = path[-1]
    return total
