"""The order of few strokes: some that lie together are taken out, and put back one by one.

Ruin and recreate (Schrimpf et al. 2000): strings of strokes that pass near each other are taken
out, and each stroke is put back at the cheapest place, of which one in a hundred is overlooked
(Christiaens, Vanden Berghe 2020); the new way is kept where it is shorter, or by chance hardly
longer, the less the later (Dueck, Scheuer 1990). A stroke is put back in the better direction, or,
where it returns, begun at the better of its ends: so strokes that meet change their ends together,
which exchanges of hops cannot do without first making the way much longer.

Plain arrays and scalars only, so that the same functions run compiled and uncompiled, to the same
result. The way is a ring of strokes, each ``after`` another, the last of them the depot; ``after``
(n + 1,) is −1 for a stroke that is taken out. ``into`` and ``out`` (n + 1,) are the ends at which
each is entered and left; ``gaps`` (2n + 2, 2n + 2) how far ends are apart, mm.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.kernels.jit import jit
from foldmill_fabricate.toolpath.arrays import roll

Floats = NDArray[np.float64]
Way = list[tuple[int, bool]]

_SEED = 20261122
"""Of the dice, so that the same strokes are always taken out alike."""
_STRINGS, _LONG = 3, 10
"""Strings that are taken out at the most, and strokes in each."""
_NEAR, _BESIDE = 12, 30
"""Ends beside which a stroke is put back; strokes through which strings pass, of one place."""
_BLINK = 200
"""Places that are looked at, at the most, until one is overlooked: 100 in the mean."""
_HEAT = 5.0
"""Mean hops by which the way may become longer, at the most, the first time; less and less until
the last, by the square of the rounds that are left."""
_LEAST = 1e-9
"""mm. A smaller gain is rounding."""


def rebuilt(ends: Floats, way: Way, returns: bool, rounds: int) -> Way:
    """Return a way that is as short as this one or shorter.

    ends : (2n + 2, 2) mm, those of stroke s at 2s and 2s + 1, then where the way may end and where
    it begins, nan for anywhere; way : all n strokes in order of work, each with whether it is drawn
    backwards; returns : whether strokes leave the tool where they began; rounds : how often some
    are taken out.
    """
    count = len(way)
    into, after = np.zeros((2, count + 1), np.int64)
    place = count
    for stroke, backwards in way:
        after[place], into[stroke] = stroke, 2 * stroke + int(backwards)
        place = stroke
    after[place], into[count] = count, 2 * count
    gaps = np.nan_to_num(np.hypot(*(ends[:, None] - ends).transpose(2, 0, 1)))
    near, beside = _neighbours(gaps[:-2, :-2])
    _improve(gaps, near, beside, after, into, returns, rounds)
    found, stroke = [], int(after[count])
    while stroke != count:
        found.append((stroke, bool(into[stroke] % 2)))
        stroke = int(after[stroke])
    return found


def _neighbours(gaps: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return of each end those of other strokes nearest to it, of each stroke itself and others."""
    count = len(gaps) // 2
    apart = gaps.reshape(count, 2, count, 2).min(axis=(1, 3))
    np.fill_diagonal(apart, -1.0)
    beside = np.argsort(apart, axis=1, kind="stable")[:, :_BESIDE]
    own = np.kron(np.eye(count), np.ones((2, 2))) > 0
    near = np.argsort(np.where(own, np.inf, gaps), axis=1, kind="stable")
    return near[:, : min(_NEAR, 2 * count - 2)], beside


@jit
def _remove(s: int, after: Any, before: Any) -> None:
    p, q = before[s], after[s]
    after[p], before[q], after[s] = q, p, -1


@jit
def _insert(s: int, p: int, after: Any, before: Any) -> None:
    q = after[p]
    after[p], after[s], before[q], before[s] = s, q, s, p


@jit
def _detour(gaps: Any, into: Any, out: Any, p: int, e: int, f: int, q: int) -> float:
    """Return by how much it is longer to go from p to q by a stroke entered at e, left at f, mm."""
    leave, enter = out[p], into[q]
    return float(gaps[leave, e] + gaps[f, enter] - gaps[leave, enter])


@jit
def _take_out(
    gaps: Any, beside: Any, after: Any, before: Any, into: Any, out: Any, log: Any, dice: Any
) -> tuple[int, float]:
    """Take out strings that pass near each other; return how many strokes, and what it saves, mm.

    log : (4, n) written: the strokes, before each the one it came after, and its ends.
    """
    n = len(after) - 1
    first, left = roll(dice, n), 1 + roll(dice, _STRINGS)
    most = 1 + roll(dice, min(_LONG, n // 2))
    count, saved = 0, 0.0
    for k in range(beside.shape[1]):
        s = beside[first, k]
        if after[s] < 0:
            continue
        length = 1 + roll(dice, most)
        for _ in range(roll(dice, length)):
            s = before[s]
        for _ in range(length):
            following = after[s]
            if s < n:
                p, e, f = before[s], into[s], out[s]
                saved += _detour(gaps, into, out, p, e, f, following)
                log[0, count], log[1, count], log[2, count], log[3, count] = s, p, e, f
                count += 1
                _remove(s, after, before)
            s = following
        left -= 1
        if left == 0:
            break
    return count, saved


@jit
def _put_back(
    gaps: Any,
    near: Any,
    after: Any,
    before: Any,
    into: Any,
    out: Any,
    returns: bool,
    s: int,
    dice: Any,
) -> float:
    """Put a stroke where the way becomes least longer; return by how much, mm.

    dice : (2,), the second of them the places to look at until one is overlooked.
    """
    depot, turn = len(after) - 1, 0 if returns else 1
    best_p, best_e = depot, 2 * s
    best = _detour(gaps, into, out, depot, best_e, best_e ^ turn, after[depot])
    for e in (2 * s, 2 * s + 1):
        for k in range(-1, near.shape[1]):
            f = near[e, k] if k >= 0 else 2 * depot
            t = f // 2
            if after[t] < 0:
                continue
            for side in range(2):  # after the stroke t, which is left at f, or before it
                if k >= 0 and f != (into[t] if side else out[t]):
                    continue
                dice[1] -= 1
                if dice[1] <= 0:
                    dice[1] = 1 + roll(dice, _BLINK)
                    continue
                p = before[t] if side else t
                entered = e ^ turn if side else e
                longer = _detour(gaps, into, out, p, entered, entered ^ turn, after[p])
                if longer < best:
                    best, best_p, best_e = longer, p, entered
    into[s], out[s] = best_e, best_e ^ turn
    _insert(s, best_p, after, before)
    return best


@jit
def _shuffle(some: Any, count: int, dice: Any) -> None:
    for k in range(count - 1, 0, -1):
        other = roll(dice, k + 1)
        some[k], some[other] = some[other], some[k]


@jit
def _undo(after: Any, before: Any, into: Any, out: Any, log: Any, count: int) -> None:
    """Put strokes back where the log says they were, the last first."""
    for k in range(count):
        _remove(log[0, k], after, before)
    for k in range(count - 1, -1, -1):
        s = log[0, k]
        into[s], out[s] = log[2, k], log[3, k]
        _insert(s, log[1, k], after, before)


@jit
def _improve(
    gaps: Any, near: Any, beside: Any, after: Any, into: Any, returns: bool, rounds: int
) -> None:
    """Shorten the way in place."""
    n = len(after) - 1
    before, out = np.zeros(n + 1, np.int64), into.copy()
    total = 0.0
    for s in range(n + 1):
        before[after[s]] = s
        if s == n or not returns:
            out[s] = into[s] ^ 1
    for s in range(n + 1):
        total += gaps[out[s], into[after[s]]]
    warm = _HEAT * total / n
    kept, kept_into = after.copy(), into.copy()
    log, order = np.zeros((4, n), np.int64), np.zeros(n, np.int64)
    dice = np.full(2, _SEED, np.int64)
    dice[1] = _BLINK
    longer, least = 0.0, -_LEAST
    for number in range(rounds):
        count, saved = _take_out(gaps, beside, after, before, into, out, log, dice)
        order[:count] = log[0, :count]
        _shuffle(order, count, dice)
        cost = -saved
        for k in range(count):
            cost += _put_back(gaps, near, after, before, into, out, returns, order[k], dice)
        chance, left = roll(dice, 1024) / 1024.0, 1.0 - number / rounds
        if cost >= warm * left * left * chance * chance * chance:
            _undo(after, before, into, out, log, count)
            continue
        longer += cost
        if longer < least:
            least = longer - _LEAST
            kept[:], kept_into[:] = after, into
    after[:], into[:] = kept, kept_into
