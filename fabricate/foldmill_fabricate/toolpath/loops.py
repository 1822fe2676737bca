"""The inner loop of ordering: moves that shorten a closed tour of strokes, then kicks.

Plain arrays and scalars only, so that the same functions run compiled and uncompiled, to the same
result; the arrays are those of ``arrays``. Nodes that lie nowhere (nan) are at no distance from
any.

Methods: the moves of ``moves`` over neighbour lists with a queue of nodes to look at (Bentley
1992); kicks by a double bridge within a short stretch (Martin, Otto, Felten 1991), kept where the
mended tour is shorter, or by chance hardly longer, the less the later (Dueck, Scheuer 1990), and
else taken back turn by turn. Mending may not put back the longest hop that was taken out: else
seven of eight kicks only lead back to the tour before. What is kicked, mended and taken back lies
close together, so that a kick costs the same on every sheet.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from foldmill.kernels.jit import jit
from foldmill_fabricate.toolpath.arrays import gap, mate, reverse, roll, turn, wrap
from foldmill_fabricate.toolpath.moves import apply, search
from foldmill_fabricate.toolpath.returning import flip, other_end

_SEED = 20261122
"""Of the dice, so that the same strokes are always kicked alike."""
_FEW = 6
"""Strokes, the depot among them, below which kicks have nothing to swap."""
_FAR = 100_000
"""Nodes that are turned round at the most, so that a move does not take as long as a sheet."""
_LOCAL = 2000
"""Nodes that are turned round to mend a kick, at the most."""
_SHORT, _STRETCH = 12, 16
"""Strokes in each of the three runs that a kick swaps, at the most: on a small sheet, and else."""
_HEAT = 6.0
"""Median hops by which a tour may become longer, at the most, when it is kicked for the first time;
less and less until the last, by the square of the kicks that are left. Tried beside a fifth of a
hop, evenly less: the tours are half as far above the best ones known, in the same time."""
_WARM = 1000
"""Strokes below which there is less heat, in proportion: fewer kicks must cool it down."""
_COLD = 200
"""Strokes up to which a kicked tour is never kept when it is longer: on a sheet of a few long
strokes that touch, a usual hop says nothing of what a kick may cost."""
_LOG = 500
"""Turns that can be taken back."""


@jit
def _undo(ends: Any, xy: Any, at: Any, tour: Any, pos: Any, log: Any) -> None:
    """Take back what the log holds, the last first."""
    for k in range(log[0] - 1, -1, -1):
        i, j = log[2 * k + 1], log[2 * k + 2]
        if i < 0:
            flip(ends, xy, at, -1 - i, log)
        else:
            reverse(tour, pos, i, j)
    log[0] = 0


@jit
def _settle(
    ends: Any,
    xy: Any,
    at: Any,
    near: Any,
    far: Any,
    tour: Any,
    pos: Any,
    returns: bool,
    most: int,
    queue: Any,
    size: int,
    log: Any,
    ban: Any,
    move: Any,
) -> float:
    """Improve until no node in the queue can be; return the gain, mm.

    queue : (2n,) nodes, of which the first ``size`` count, then (2n,) flags of who waits; ban : as
    for ``search``.
    """
    n = len(tour)
    total, head = 0.0, 0
    twins = 2 if returns else 1
    while size > 0:
        a = queue[head]
        head = wrap(head + 1, n)
        size -= 1
        queue[n + a] = 0
        while len(log) == 1 or 2 * log[0] + 10 < len(log):
            gain = search(xy, at, near, far, tour, pos, twins, most, a, ban, move)
            if gain <= 0.0 and returns and a < n - 2:
                gain = other_end(ends, xy, at, near, far, tour, pos, most, a, log, move)
            if gain <= 0.0:
                break
            total += gain
            move[5], move[6] = mate(tour, pos, a), mate(tour, pos, move[3])
            apply(tour, pos, move, log)
            for k in (0, 1, 2, 3, 5, 6):
                b = move[k]
                if queue[n + b] == 0:
                    queue[n + b] = 1
                    queue[wrap(head + size, n)] = b
                    size += 1
    return total


@jit
def _kick(
    ends: Any, xy: Any, at: Any, tour: Any, pos: Any, returns: bool, dice: Any, queue: Any, log: Any
) -> tuple[float, int, int]:
    """Swap the first and the last of three short runs that follow each other.

    Returns what that costs, mm, how many nodes are in the queue, those at the seams, and which
    of the four hops was the longest. Where strokes return, those at the seams are begun at their
    other end half of the time.
    """
    n = len(tour)
    most = min(_STRETCH if n > 2 * _COLD else _SHORT, (n // 2 - 2) // 3)
    p = 2 * roll(dice, n // 2)
    cost = 0.0
    for k in range(4):  # the four hops, and the seams
        queue[2 * k], queue[2 * k + 1] = tour[p], tour[p ^ 1]
        p = wrap(p + 2 * (1 + roll(dice, most)), n)
    if returns:
        for k in range(0, 8, 2):
            a = queue[k]
            if a < n - 2 and roll(dice, 2) == 0:
                x, z = mate(tour, pos, a), mate(tour, pos, a ^ 1)
                cost -= gap(xy, a, x) + gap(xy, a, z)
                flip(ends, xy, at, a // 2, log)
                cost += gap(xy, a, x) + gap(xy, a, z)
    longest, most_taken = 0, -1.0
    for k in range(4):
        taken = gap(xy, queue[2 * k], queue[2 * k + 1])
        if taken > most_taken:
            longest, most_taken = k, taken
        cost -= taken
    turn(tour, pos, queue[1], queue[6], log)
    for k in (1, 3, 5):
        turn(tour, pos, queue[k], queue[k + 1], log)
    for a, b in ((0, 5), (6, 3), (4, 1), (2, 7)):
        cost += gap(xy, queue[a], queue[b])
    for k in range(8):
        queue[n + queue[k]] = 1
    return cost, 8, longest


@jit
def improve(ends: Any, at: Any, near: Any, tour: Any, returns: bool, kicks: int) -> None:
    """Shorten a closed tour of strokes in place.

    ends : (2n, 2) mm, of the strokes; at : (2n,) the end at which each node lies; near : (2n, k)
    ends to try beside each, nearest first, −1 for none; tour : (2n,) nodes; returns : whether
    strokes leave the tool where they began; kicks : how often the tour is disturbed and mended.
    """
    n = len(tour)
    pos = np.zeros(n, np.int32)
    xy = np.zeros((n, 2))
    queue = np.zeros(2 * n, np.int32)
    for p in range(n):
        pos[tour[p]] = p
        queue[p] = tour[p]
        queue[n + p] = 1
        xy[p, 0], xy[p, 1] = ends[at[p], 0], ends[at[p], 1]
    far = _gaps(ends, near)
    move = np.zeros(7, np.int64)
    ban = np.full(n, -1, np.int32)
    log = np.zeros(1, np.int64)
    _settle(ends, xy, at, near, far, tour, pos, returns, _FAR, queue, n, log, ban, move)
    if n < 2 * _FEW:
        return
    log = np.zeros(_LOG, np.int64)
    settled, settled_at = tour.copy(), at.copy()
    dice = np.full(1, _SEED, np.int64)
    warm = _HEAT * min(1.0, n / 2 / _WARM) * _usual_hop(xy, tour) if n > 2 * _COLD else 0.0
    longer = 0.0
    for number in range(kicks):
        cost, size, longest = _kick(ends, xy, at, tour, pos, returns, dice, queue, log)
        one, other = queue[2 * longest], queue[2 * longest + 1]
        ban[one], ban[other] = other, one
        cost -= _settle(
            ends, xy, at, near, far, tour, pos, returns, _LOCAL, queue, size, log, ban, move
        )
        ban[one], ban[other] = -1, -1
        chance, left = roll(dice, 1024) / 1024.0, 1.0 - number / kicks
        if cost < warm * left * left * chance * chance * chance:
            longer += cost
            log[0] = 0
        else:
            _undo(ends, xy, at, tour, pos, log)
    if longer > 0.0:
        tour[:], at[:] = settled, settled_at


@jit
def _gaps(xy: Any, near: Any) -> Any:
    """Return the distance (2n, k) to each neighbour, mm."""
    far = np.zeros(near.shape)
    for a in range(near.shape[0]):
        for k in range(near.shape[1]):
            if near[a, k] >= 0:
                far[a, k] = gap(xy, a, near[a, k])
    return far


@jit
def _usual_hop(xy: Any, tour: Any) -> float:
    """Return the median length of the hops of a closed tour, mm: none where most strokes touch."""
    hops = np.zeros(len(tour) // 2)
    for k in range(len(hops)):
        hops[k] = gap(xy, tour[2 * k], tour[2 * k + 1])
    hops.sort()
    return float(hops[len(hops) // 2])
