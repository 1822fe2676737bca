"""Strokes that leave the tool where they began: at which of its ends each does.

An even number of repeats ends a stroke where it began. Both its nodes lie at the end that is chosen
for it; the arrays are those of ``arrays`` and ``moves``.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from foldmill.kernels.jit import jit
from foldmill_fabricate.toolpath.arrays import gap, mate, wrap
from foldmill_fabricate.toolpath.moves import ALL, LAST, LEAST


@jit
def flip(ends: Any, xy: Any, at: Any, s: int, log: Any) -> None:
    """Begin a stroke that returns at its other end."""
    e = at[2 * s] ^ 1
    for node in (2 * s, 2 * s + 1):
        at[node] = e
        xy[node, 0], xy[node, 1] = ends[e, 0], ends[e, 1]
    count = log[0]
    if 2 * count + 2 < len(log):
        log[2 * count + 1] = -1 - s
    log[0] = count + 1


@jit
def other_end(
    ends: Any,
    xy: Any,
    at: Any,
    near: Any,
    far: Any,
    tour: Any,
    pos: Any,
    most: int,
    a: int,
    log: Any,
    move: Any,
) -> float:
    """Try to begin the returning stroke of a node at its other end, here or elsewhere.

    Returns the gain, mm, or 0; move : written as by ``search``.
    """
    n, s = len(tour), a // 2
    x, z = mate(tour, pos, a), mate(tour, pos, a ^ 1)
    there = at[a] ^ 1
    old = gap(xy, a, x) + gap(xy, a, z)
    move[0], move[1], move[2], move[3], move[4] = a, a ^ 1, z, x, 0
    here = old - _apart(ends, xy, there, x) - _apart(ends, xy, there, z)
    best, freed = max(here, LEAST), old - gap(xy, x, z)
    start = pos[a]
    ahead = 1 if start % 2 else -1
    for k in range(near.shape[1]):
        e = near[there, k]
        if e < 0 or freed - far[there, k] <= best:
            break
        for twin in range(2):
            b = e ^ twin
            j = wrap(ahead * (pos[b] - start), n)
            if at[b] != e or min(j, n - j) > most:
                continue
            c = mate(tour, pos, b)
            if c == a or c == a ^ 1:
                continue
            gain = freed - far[there, k] - _apart(ends, xy, there, c) + gap(xy, b, c)
            if gain > best:
                best = gain
                move[3], move[4] = b if j % 2 else c, ALL + LAST
    if best <= LEAST:
        return 0.0
    flip(ends, xy, at, s, log)
    return best


@jit
def _apart(ends: Any, xy: Any, e: int, a: int) -> float:
    """Return the distance of an end from a node, mm."""
    dx = ends[e, 0] - xy[a, 0]
    dy = ends[e, 1] - xy[a, 1]
    apart = sqrt(dx * dx + dy * dy)
    return apart if apart == apart else 0.0
