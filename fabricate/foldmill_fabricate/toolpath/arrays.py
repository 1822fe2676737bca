"""Arrays of a closed tour of strokes, and how runs of it are turned round and moved.

Plain arrays and scalars only, so that the same functions run compiled and uncompiled, to the same
result. ``seq`` (n,) the strokes in order, ``pos`` (n,) the place of each, ``side`` (n,) the end at
which each is entered; stroke s has the nodes 2s and 2s + 1, the last stroke is the depot.
``touched`` (2n + 1,) lists the places that were written: first which, then flags, then how many.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from foldmill.kernels.jit import jit

RUN = 3
"""Strokes that are moved together, at the most."""


@jit
def gap(xy: Any, a: int, b: int) -> float:
    """Return the distance of two nodes, mm."""
    dx = xy[a, 0] - xy[b, 0]
    dy = xy[a, 1] - xy[b, 1]
    apart = sqrt(dx * dx + dy * dy)
    return apart if apart == apart else 0.0  # nan: nowhere, so no way


@jit
def leave(side: Any, returns: bool, s: int) -> int:
    """Return the node at which a stroke leaves the tool."""
    if returns and s != len(side) - 1:
        return 2 * s + int(side[s])
    return 2 * s + 1 - int(side[s])


@jit
def put(seq: Any, pos: Any, touched: Any, p: int, s: int) -> None:
    """Place a stroke in the tour, and note that the place was touched."""
    seq[p] = s
    pos[s] = p
    if touched[len(seq) + p] == 0:
        touched[len(seq) + p] = 1
        touched[touched[2 * len(seq)]] = p
        touched[2 * len(seq)] += 1


@jit
def turn(side: Any, returns: bool, s: int) -> None:
    """Draw a stroke the other way; one that returns is the same both ways."""
    if not returns or s == len(side) - 1:
        side[s] = 1 - side[s]


@jit
def reverse(seq: Any, pos: Any, side: Any, touched: Any, returns: bool, i: int, j: int) -> None:
    """Reverse the run from place i to place j, or, where that is shorter, all the others."""
    n = len(seq)
    inside = (j - i) % n + 1
    if 2 * inside > n:
        i, j = (j + 1) % n, (i - 1) % n
        inside = n - inside
    for _ in range(inside // 2):
        one, other = seq[i], seq[j]
        put(seq, pos, touched, i, other)
        put(seq, pos, touched, j, one)
        turn(side, returns, one)
        turn(side, returns, other)
        i, j = (i + 1) % n, (j - 1) % n
    if inside % 2:
        put(seq, pos, touched, i, seq[i])
        turn(side, returns, seq[i])


@jit
def shift(
    seq: Any,
    pos: Any,
    side: Any,
    touched: Any,
    returns: bool,
    i: int,
    count: int,
    q: int,
    back: bool,
) -> None:
    """Move the run of ``count`` strokes at place i to behind place q, turned round or not."""
    n = len(seq)
    run = np.zeros(RUN, np.int64)
    for k in range(count):
        run[k] = seq[(i + k) % n]
    last = (i + count - 1) % n
    ahead, behind = (q - last) % n, (i - 1 - q) % n
    if ahead <= behind:
        for k in range(ahead):
            put(seq, pos, touched, (i + k) % n, seq[(last + 1 + k) % n])
        first = (i + ahead) % n
    else:
        for k in range(behind):
            put(seq, pos, touched, (last - k) % n, seq[(i - 1 - k) % n])
        first = (q + 1) % n
    for k in range(count):
        s = run[count - 1 - k] if back else run[k]
        if back:
            turn(side, returns, s)
        put(seq, pos, touched, (first + k) % n, s)


@jit
def flip(xy: Any, seq: Any, pos: Any, side: Any, touched: Any, p: int) -> float:
    """Begin a stroke that returns at its other end; return what that costs, mm."""
    n, s = len(seq), seq[p]
    x = leave(side, True, seq[(p - 1) % n])
    y = 2 * seq[(p + 1) % n] + side[seq[(p + 1) % n]]
    here, there = 2 * s + side[s], 2 * s + 1 - side[s]
    side[s] = 1 - side[s]
    put(seq, pos, touched, p, s)
    return gap(xy, x, there) + gap(xy, there, y) - gap(xy, x, here) - gap(xy, here, y)
