"""In which order strokes are drawn, and how near that is to the best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Stroke

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ROUNDS = 50
"""Sweeps of 2-opt at the most; it settles in a handful."""


def sorted_strokes(strokes: Sequence[Stroke], repeats: int, start: Floats) -> tuple[Stroke, ...]:
    """Return the strokes in order of work and direction; start : (2,) where the tool is."""
    ends = np.array([[s.points[0], s.points[-1]] for s in strokes]).reshape(-1, 2, 2)
    return tuple(
        Stroke(points=strokes[k].points[::-1]) if backwards else strokes[k]
        for k, backwards in order(ends, start, returns=repeats % 2 == 0)
    )


def order(ends: Floats, start: Floats, *, returns: bool) -> list[tuple[int, bool]]:
    """Return strokes in order of work, each with whether it is drawn backwards.

    ends : (n, 2, 2) first and last point of each stroke, mm; start : (2,) where the tool is;
    returns : whether a stroke leaves the tool where it began (an even number of repeats).
    Nearest end first, then 2-opt until no reversal of a run shortens the travel.
    """
    if not len(ends):
        return []
    sequence, side = _nearest_first(ends, start, returns)
    for _ in range(_ROUNDS):
        turned = _reverse_runs(ends, start, sequence, side, returns)
        swapped = returns and _swap_ends(ends, start, sequence, side)
        if not (turned or swapped):
            break
    return [(int(s), bool(b)) for s, b in zip(sequence, side, strict=True)]


def _nearest_first(ends: Floats, start: Floats, returns: bool) -> tuple[Indices, Indices]:
    left = np.ones(len(ends), bool)
    sequence, side, at = [], [], start
    for _ in range(len(ends)):
        away = np.hypot(*(ends - at).transpose(2, 0, 1))
        away[~left] = np.inf
        stroke, end = np.unravel_index(int(np.argmin(away)), away.shape)
        left[stroke] = False
        sequence.append(stroke)
        side.append(end)
        at = ends[stroke, end if returns else 1 - end]
    return np.array(sequence, np.intp), np.array(side, np.intp)


def _reverse_runs(
    ends: Floats, start: Floats, sequence: Indices, side: Indices, returns: bool
) -> bool:
    """Reverse, in place, the best run from each position on; tell whether anything changed."""
    improved = False
    for i in range(len(sequence)):
        entry = ends[sequence, side]
        leave = entry if returns else ends[sequence, 1 - side]
        before = start if i == 0 else leave[i - 1]
        old_in = np.hypot(*(entry[i] - before))
        new_in = np.hypot(*(leave[i:] - before).T)
        after = entry[i + 1 :]
        old_out = np.append(np.hypot(*(after - leave[i:-1]).T), 0.0)
        new_out = np.append(np.hypot(*(after - entry[i]).T), 0.0)
        gain = old_in + old_out - new_in - new_out
        j = int(np.argmax(gain))
        if gain[j] > 1e-9:
            run = slice(i, i + j + 1)
            sequence[run] = sequence[run][::-1].copy()
            side[run] = side[run][::-1].copy() if returns else 1 - side[run][::-1]
            improved = True
    return improved


def _swap_ends(ends: Floats, start: Floats, sequence: Indices, side: Indices) -> bool:
    """Begin strokes, in place, at their other end where that is nearer to both neighbours."""
    improved = False
    for i, stroke in enumerate(sequence):
        near = [start if i == 0 else ends[sequence[i - 1], side[i - 1]]]
        near += [ends[sequence[i + 1], side[i + 1]]] if i + 1 < len(sequence) else []
        cost = [sum(float(np.hypot(*(end - spot))) for spot in near) for end in ends[stroke]]
        if cost[1 - side[i]] < cost[side[i]] - 1e-9:
            side[i] = 1 - side[i]
            improved = True
    return improved


def travel(paths: Sequence[Floats], start: Floats) -> float:
    """Return the length of the pen-up moves between polylines drawn in this order, mm."""
    at, total = start, 0.0
    for path in paths:
        total += float(np.hypot(*(path[0] - at)))
        at = path[-1]
    return total


def travel_bound(strokes: Sequence[Floats], start: Floats) -> float:
    """Return a length, mm, that the pen-up moves cannot go below in any order and direction.

    strokes : polylines (n, 2), each once along, without repeats.

    The moves join all strokes and the start into one connected whole, so together they are at least
    the minimum spanning tree over the strokes, weighed by the distance of their nearest ends.
    """
    from scipy.sparse.csgraph import minimum_spanning_tree

    if not strokes:
        return 0.0
    ends = np.array([[start, start], *([stroke[0], stroke[-1]] for stroke in strokes)])
    gaps = np.full((len(ends), len(ends)), np.inf)
    for a in (0, 1):
        for b in (0, 1):
            steps = ends[:, None, a] - ends[None, :, b]
            gaps = np.minimum(gaps, np.hypot(steps[..., 0], steps[..., 1]))
    # The tree routine takes a zero for "no edge": strokes that touch get a hair instead.
    tree = minimum_spanning_tree(np.maximum(gaps, 1e-12))
    return float(tree.sum())
