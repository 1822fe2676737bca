"""The inner loops of ordering: 2-opt and Or-opt moves on a closed tour of strokes, then kicks.

Plain arrays and scalars only, so that the same functions run compiled and uncompiled, to the same
result. A stroke s has the nodes 2s and 2s + 1; ``side[s]`` tells at which it is entered. Nodes that
lie nowhere (nan) are at no distance from any. The last stroke is the depot.

Methods: 2-opt (Croes 1958) and Or-opt (Or 1976) over neighbour lists with a queue of strokes to
look at (Bentley 1992); kicks by a double bridge within a short stretch (Martin, Otto, Felten 1991).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from foldmill.kernels.jit import jit
from foldmill_fabricate.toolpath.arrays import RUN, flip, gap, leave, put, reverse, shift

_LEAST = 1e-9
"""mm. A smaller gain is rounding."""
_SEED = 20261122
"""Of the dice, so that the same strokes are always kicked alike."""
_FEW = 6
"""Strokes, the depot among them, below which kicks have nothing to swap."""
_STRETCH = 50
"""Strokes in each of the two runs that a kick swaps, at the most."""


@jit
def _two_opt(
    xy: Any, near: Any, seq: Any, pos: Any, side: Any, touched: Any, returns: bool, s: int, out: Any
) -> float:
    """Try to reverse a run that begins or ends at stroke s; return what it gains, mm."""
    n = len(seq)
    p = pos[s]
    for ahead in (True, False):
        t = seq[(p + 1) % n] if ahead else seq[(p - 1) % n]
        a = leave(side, returns, s) if ahead else 2 * s + side[s]
        c = 2 * t + side[t] if ahead else leave(side, returns, t)
        old = gap(xy, a, c)
        for k in range(near.shape[1]):
            b = near[a, k]
            if b < 0:
                continue
            gain = old - gap(xy, a, b)
            if gain <= _LEAST:
                break
            q = b // 2
            if q == s or b != (leave(side, returns, q) if ahead else 2 * q + side[q]):
                continue
            r = seq[(pos[q] + 1) % n] if ahead else seq[(pos[q] - 1) % n]
            d = 2 * r + side[r] if ahead else leave(side, returns, r)
            gain += gap(xy, b, d) - gap(xy, c, d)
            if gain > _LEAST:
                if ahead:
                    reverse(seq, pos, side, touched, returns, pos[t], pos[q])
                else:
                    reverse(seq, pos, side, touched, returns, pos[q], pos[t])
                out[0], out[1], out[2], out[3] = s, t, q, r
                return gain
    return 0.0


@jit
def _beside(
    xy: Any,
    seq: Any,
    pos: Any,
    side: Any,
    touched: Any,
    returns: bool,
    i: int,
    count: int,
    which: int,
    b: int,
    freed: float,
    out: Any,
) -> float:
    """Try to move a run so that its head or tail lies beside node b; return what it gains, mm."""
    n, q = len(seq), b // 2
    first, last = seq[i], seq[(i + count - 1) % n]
    before, after = seq[(i - 1) % n], seq[(i + count) % n]
    head, tail = 2 * first + side[first], leave(side, returns, last)
    a, other = (head, tail) if which == 0 else (tail, head)
    for behind in (True, False):
        node = leave(side, returns, q) if behind else 2 * q + side[q]
        if b != node or (behind and q == before) or (not behind and q == after):
            continue
        r = seq[(pos[q] + 1) % n] if behind else seq[(pos[q] - 1) % n]
        c = 2 * r + side[r] if behind else leave(side, returns, r)
        gain = freed - gap(xy, a, b) - gap(xy, other, c) + gap(xy, b, c)
        if gain > _LEAST:
            back = behind != (which == 0) and head != tail
            shift(seq, pos, side, touched, returns, i, count, pos[q] if behind else pos[r], back)
            out[0], out[1], out[2], out[3], out[4], out[5] = first, last, q, r, before, after
            return gain
    return 0.0


@jit
def _or_opt(
    xy: Any, near: Any, seq: Any, pos: Any, side: Any, touched: Any, returns: bool, s: int, out: Any
) -> float:
    """Try to move a run of strokes that begins or ends at s; return what it gains, mm."""
    n = len(seq)
    for count in range(1, min(RUN, n - 2) + 1):
        for at_front in (True, False):
            i = pos[s] if at_front else (pos[s] - count + 1) % n
            first, last = seq[i], seq[(i + count - 1) % n]
            before, after = seq[(i - 1) % n], seq[(i + count) % n]
            head, tail = 2 * first + side[first], leave(side, returns, last)
            x, y = leave(side, returns, before), 2 * after + side[after]
            freed = gap(xy, x, head) + gap(xy, tail, y) - gap(xy, x, y)
            if freed <= _LEAST:
                continue
            for which in range(2):
                a = head if which == 0 else tail
                for k in range(near.shape[1]):
                    b = near[a, k]
                    if b >= 0 and freed - gap(xy, a, b) <= _LEAST:
                        break
                    if b < 0 or (pos[b // 2] - i) % n < count:
                        continue
                    gain = _beside(
                        xy, seq, pos, side, touched, returns, i, count, which, b, freed, out
                    )
                    if gain > 0.0:
                        return gain
    return 0.0


@jit
def _other_end(
    xy: Any, near: Any, seq: Any, pos: Any, side: Any, touched: Any, s: int, out: Any
) -> float:
    """Try to begin a returning stroke at its other end, here or elsewhere; return the gain, mm."""
    n = len(seq)
    p = pos[s]
    before, after = seq[(p - 1) % n], seq[(p + 1) % n]
    x, y = leave(side, True, before), 2 * after + side[after]
    here, there = 2 * s + side[s], 2 * s + 1 - side[s]
    old = gap(xy, x, here) + gap(xy, here, y)
    gain = old - gap(xy, x, there) - gap(xy, there, y)
    if gain > _LEAST:
        flip(xy, seq, pos, side, touched, p)
        out[0], out[1], out[2], out[3] = s, before, after, s
        return gain
    freed = old - gap(xy, x, y)
    for k in range(near.shape[1]):
        b = near[there, k]
        if b < 0:
            continue
        gain = freed - gap(xy, there, b)
        if gain <= _LEAST:
            break
        q = b // 2
        for behind in (True, False):
            node = leave(side, True, q) if behind else 2 * q + side[q]
            if b != node or (behind and q == before) or (not behind and q == after):
                continue
            r = seq[(pos[q] + 1) % n] if behind else seq[(pos[q] - 1) % n]
            c = 2 * r + side[r] if behind else leave(side, True, r)
            total = gain - gap(xy, there, c) + gap(xy, b, c)
            if total > _LEAST:
                side[s] = 1 - side[s]
                place = pos[q] if behind else pos[r]
                shift(seq, pos, side, touched, True, p, 1, place, False)
                out[0], out[1], out[2], out[3] = s, before, q, r
                out[4] = after
                return total
    return 0.0


@jit
def _settle(
    xy: Any,
    near: Any,
    seq: Any,
    pos: Any,
    side: Any,
    touched: Any,
    returns: bool,
    queue: Any,
    size: int,
) -> float:
    """Improve until no stroke in the queue can be; return the gain, mm.

    queue : (2n,) strokes, of which the first ``size`` count, then (n,) flags of who waits.
    """
    n = len(seq)
    out = np.zeros(6, np.int64)
    total, head = 0.0, 0
    while size > 0:
        s = queue[head]
        head = (head + 1) % n
        size -= 1
        queue[n + s] = 0
        while True:
            out[:] = -1
            gain = _two_opt(xy, near, seq, pos, side, touched, returns, s, out)
            if gain <= 0.0:
                gain = _or_opt(xy, near, seq, pos, side, touched, returns, s, out)
            if gain <= 0.0 and returns and s != n - 1:
                gain = _other_end(xy, near, seq, pos, side, touched, s, out)
            if gain <= 0.0:
                break
            total += gain
            for k in range(6):
                if out[k] >= 0 and queue[n + out[k]] == 0:
                    queue[n + out[k]] = 1
                    queue[(head + size) % n] = out[k]
                    size += 1
    return total


@jit
def _kick(
    xy: Any, seq: Any, pos: Any, side: Any, touched: Any, returns: bool, dice: Any, queue: Any
) -> float:
    """Swap two short runs that follow each other; return what that costs, mm.

    Where strokes return, those at the seams are begun at their other end half of the time.
    """
    n = len(seq)
    most = min(_STRETCH, (n - 1) // 2)
    p = _roll(dice, n)
    one, other = 1 + _roll(dice, most), 1 + _roll(dice, most)
    cost = 0.0
    for k in (p, p + 1, p + 1 + one):
        if returns and seq[k % n] != n - 1 and _roll(dice, 2) == 0:
            cost += flip(xy, seq, pos, side, touched, k % n)
    run = np.zeros(one, np.int64)
    for k in range(one):
        run[k] = seq[(p + 1 + k) % n]
    marks = np.zeros(6, np.int64)
    marks[0], marks[1], marks[2] = seq[p], run[0], run[one - 1]
    marks[3], marks[4] = seq[(p + 1 + one) % n], seq[(p + one + other) % n]
    marks[5] = seq[(p + 1 + one + other) % n]
    a, b = leave(side, returns, marks[0]), 2 * marks[1] + side[marks[1]]
    c, d = leave(side, returns, marks[2]), 2 * marks[3] + side[marks[3]]
    e, f = leave(side, returns, marks[4]), 2 * marks[5] + side[marks[5]]
    for k in range(other):
        put(seq, pos, touched, (p + 1 + k) % n, seq[(p + 1 + one + k) % n])
    for k in range(one):
        put(seq, pos, touched, (p + 1 + other + k) % n, run[k])
    for k in range(6):
        queue[k] = marks[k]
    old = gap(xy, a, b) + gap(xy, c, d) + gap(xy, e, f)
    return cost + gap(xy, a, d) + gap(xy, e, b) + gap(xy, c, f) - old


@jit
def _roll(dice: Any, sides: int) -> int:
    """Return a number below ``sides``, by Marsaglia's xorshift (2003) of 32 bits."""
    x = dice[0]
    x ^= (x << 13) & 0xFFFFFFFF
    x ^= x >> 17
    x ^= (x << 5) & 0xFFFFFFFF
    dice[0] = x
    return int(x % sides)


@jit
def _keep_or_restore(
    seq: Any, pos: Any, side: Any, touched: Any, best: Any, best_side: Any, better: bool
) -> None:
    """Take over what was touched into the best tour, or put it back as it was there."""
    count = touched[2 * len(seq)]
    for k in range(count):
        p = touched[k]
        if better:
            best[p] = seq[p]
            best_side[seq[p]] = side[seq[p]]
        else:
            seq[p] = best[p]
            pos[best[p]] = p
    for k in range(count):
        side[seq[touched[k]]] = best_side[seq[touched[k]]]


@jit
def improve(xy: Any, near: Any, seq: Any, side: Any, returns: bool, kicks: int) -> None:
    """Shorten a closed tour of strokes in place.

    xy : (2n, 2) mm, the nodes; near : (2n, k) nodes to try beside each, nearest first, −1 for none;
    seq : (n,) the strokes in order; side : (n,) the end at which each is entered; returns : whether
    strokes leave the tool where they began; kicks : how often the tour is disturbed and mended.
    """
    n = len(seq)
    pos = np.zeros(n, np.int64)
    touched = np.zeros(2 * n + 1, np.int64)
    queue = np.zeros(2 * n, np.int64)
    for p in range(n):
        pos[seq[p]] = p
        queue[p] = seq[p]
        queue[n + p] = 1
    _settle(xy, near, seq, pos, side, touched, returns, queue, n)
    best, best_side = seq.copy(), side.copy()
    dice = np.full(1, _SEED, np.int64)
    if n < _FEW:
        return
    for _ in range(kicks):
        for k in range(touched[2 * n]):
            touched[n + touched[k]] = 0
        touched[2 * n] = 0
        cost = _kick(xy, seq, pos, side, touched, returns, dice, queue)
        size = 0
        for k in range(6):
            if queue[n + queue[k]] == 0:
                queue[n + queue[k]] = 1
                queue[size] = queue[k]
                size += 1
        cost -= _settle(xy, near, seq, pos, side, touched, returns, queue, size)
        _keep_or_restore(seq, pos, side, touched, best, best_side, cost < 0.0)
