"""The way of the tool along one stroke, repeats and overcut included."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

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


class Laid(NamedTuple):
    """Ways of the tool along many strokes, one behind the other."""

    points: Floats
    """(n, 2) mm"""
    counts: NDArray[np.intp]
    """(k,) points of each."""


def traversals(strokes: Sequence[Stroke], operation: Operation) -> Laid:
    """Return the ways along these strokes of an operation, as ``traversal`` does one by one.

    Open strokes with as many points are done together: a fine sheet has tens of thousands.
    """
    corners = np.array([len(stroke.points) for stroke in strokes], np.intp)
    closed = np.array([stroke.closed for stroke in strokes], bool)
    rounds = {k: traversal(strokes[k], operation) for k in np.flatnonzero(closed).tolist()}
    counts = 1 + operation.repeats * (corners - 1)
    counts[closed] = [len(path) for path in rounds.values()]
    begins = np.cumsum(counts) - counts
    points = np.zeros((int(counts.sum()), 2))
    for k, path in rounds.items():
        points[begins[k] : begins[k] + len(path)] = path
    for corner in np.unique(corners[~closed]).tolist():
        alike = np.flatnonzero((corners == corner) & ~closed)
        way = _there_and_back(corner, operation.repeats)
        flat = chain.from_iterable(strokes[k].points for k in alike.tolist())
        values = np.fromiter(chain.from_iterable(flat), float, 2 * corner * len(alike))
        places = begins[alike, None] + np.arange(len(way))
        points[places] = values.reshape(-1, corner, 2)[:, way]
    return Laid(points, counts)


def _there_and_back(corners: int, repeats: int) -> NDArray[np.intp]:
    """Return in which order the corners of an open stroke are passed."""
    there = np.arange(corners)
    laps = [(there, there[::-1])[lap % 2][min(lap, 1) :] for lap in range(repeats)]
    return np.concatenate(laps)


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
