"""Arrays of a closed tour of strokes, and how a run of it is turned round.

Plain arrays and scalars only, so that the same functions run compiled and uncompiled, to the same
result. Stroke s has the nodes 2s and 2s + 1; the last stroke is the depot. ``tour`` (2n,) lists the
nodes in the order in which the tool comes to them, shifted by one: at the places 2k and 2k + 1 are
the two nodes of a hop, left and entered; ``pos`` (2n,) the place of each node. So the other node of
a hop is at place p ^ 1, and a run of strokes has one node at an odd place and one at an even place
at its ends: it begins, in the order of the array, at the odd one.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from foldmill.kernels.jit import jit


@jit
def wrap(p: int, n: int) -> int:
    """Return a place of a tour of n, of one that lies at most n beyond either end."""
    if p >= n:
        return p - n
    return p + n if p < 0 else p


@jit
def gap(xy: Any, a: int, b: int) -> float:
    """Return the distance of two nodes, mm; one that lies nowhere (nan) is at none from any."""
    dx = xy[a, 0] - xy[b, 0]
    dy = xy[a, 1] - xy[b, 1]
    apart = sqrt(dx * dx + dy * dy)
    return apart if apart == apart else 0.0


@jit
def mate(tour: Any, pos: Any, a: int) -> int:
    """Return the node at the other end of a node's hop."""
    return int(tour[pos[a] ^ 1])


@jit
def reverse(tour: Any, pos: Any, i: int, j: int) -> None:
    """Reverse the places from i to j, round the end of the array where j lies before i."""
    n = len(tour)
    left = (wrap(j - i, n) + 1) // 2
    while left > 0:
        run = min(left, n - i, j + 1)  # until an end of the array
        for k in range(run):
            one, other = tour[i + k], tour[j - k]
            tour[i + k], tour[j - k] = other, one
            pos[other], pos[one] = i + k, j - k
        left -= run
        i, j = wrap(i + run, n), wrap(j - run, n)


@jit
def turn(tour: Any, pos: Any, u: int, v: int, log: Any) -> None:
    """Turn round the run of strokes between its ends u and v, or, where that is shorter, the rest.

    log : how many were turned, then the places of each, in pairs; it may be full.
    """
    n = len(tour)
    i, j = (pos[u], pos[v]) if pos[u] % 2 else (pos[v], pos[u])
    if 2 * (wrap(j - i, n) + 1) > n:
        i, j = wrap(j + 1, n), wrap(i - 1, n)
    reverse(tour, pos, i, j)
    count = log[0]
    if 2 * count + 2 < len(log):
        log[2 * count + 1], log[2 * count + 2] = i, j
    log[0] = count + 1


@jit
def roll(dice: Any, sides: int) -> int:
    """Return a number below ``sides``, by Marsaglia's xorshift (2003) of 32 bits."""
    x = dice[0]
    x ^= (x << 13) & 0xFFFFFFFF
    x ^= x >> 17
    x ^= (x << 5) & 0xFFFFFFFF
    dice[0] = x
    return int(x % sides)
