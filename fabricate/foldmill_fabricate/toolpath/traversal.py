"""The way of the tool along one stroke, repeats and overcut included."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Operation, Stroke

Floats = NDArray[np.float64]


def traversal(stroke: Stroke, operation: Operation) -> Floats:
    """Return the polyline (n, 2) the tool follows without lifting, mm.

    An open stroke is followed there and back; a closed one round and round, then on by the overcut.
    """
    once = np.asarray(stroke.points, float)
    laps = range(operation.repeats)
    if stroke.closed:
        path = np.vstack([once if lap == 0 else once[1:] for lap in laps])
        return np.vstack([path, first_part(once, operation.overcut)[1:]])
    there_and_back = (once, once[::-1])
    return np.vstack([there_and_back[lap % 2][min(lap, 1) :] for lap in laps])


def first_part(points: Floats, length: float) -> Floats:
    """Return the first ``length`` mm of a polyline (n, 2), its start included."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    reached = np.concatenate([[0.0], np.cumsum(steps)])
    if length <= 0:
        return points[:1]
    length = min(length, float(reached[-1]))
    whole = points[reached < length]
    end = [np.interp(length, reached, points[:, k]) for k in (0, 1)]
    return np.vstack([whole, end])
