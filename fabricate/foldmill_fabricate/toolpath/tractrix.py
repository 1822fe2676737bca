"""The search for steps that keep a dragged tip where it should be, in loops worth compiling.

Plain arrays and scalars only, so that the same functions run compiled and uncompiled, to the same
result. Along a straight way the angle φ between blade and motion obeys tan(φ/2) = tan(φ0/2)·
exp(−s/offset). The search is a beam: of all ways so far the cheapest few go on, each to every step
near the next point. A way costs the sum of (straying / step)^8, which is as good as its maximum.

The columns of a state are where the holder stands (x, y), how the blade points, how far the tip has
strayed at the most, and the cost.
"""

from __future__ import annotations

from math import atan, atan2, cos, exp, floor, hypot, isnan, pi, sin, tan
from typing import Any

import numpy as np

from foldmill.kernels.jit import jit

_STATIONS = (0.5, 1.0, 2.0)
"""Offsets along a move where the tip is looked at, besides its end."""
_POWER = 8
_ALIKE = 0.005
"""rad. Of two ways that lead to one place with the blade alike, the cheaper goes on."""


@jit
def _beside(x: float, y: float, line: Any) -> float:
    """Return the distance of a point from a segment (2, 2)."""
    ax, ay = line[0, 0], line[0, 1]
    dx, dy = line[1, 0] - ax, line[1, 1] - ay
    square = dx * dx + dy * dy
    share = ((x - ax) * dx + (y - ay) * dy) / square if square > 0.0 else 0.0
    share = min(1.0, max(0.0, share))
    return hypot(x - ax - share * dx, y - ay - share * dy)


@jit
def _strays(x: float, y: float, lines: Any) -> float:
    """Return the distance of a point from the nearer of two segments (2, 2, 2)."""
    return min(_beside(x, y, lines[0]), _beside(x, y, lines[1]))


@jit
def _move(state: Any, x: float, y: float, offset: float, lines: Any) -> tuple[float, float]:
    """Return the heading after a straight move of the holder, and how far the tip strays on it."""
    heading = state[2]
    dx, dy = x - state[0], y - state[1]
    length = hypot(dx, dy)
    if length == 0.0:
        return heading, 0.0
    course = atan2(dy, dx)
    left = tan(((heading - course + pi) % (2 * pi) - pi) / 2)
    worst = 0.0
    for station in _STATIONS:
        back = length - station * offset
        if back > 0.0:
            at = course + 2 * atan(left * exp(-station))
            u = x - back / length * dx - offset * cos(at)
            v = y - back / length * dy - offset * sin(at)
            worst = max(worst, _strays(u, v, lines))
    heading = course + 2 * atan(left * exp(-length / offset))
    u, v = x - offset * cos(heading), y - offset * sin(heading)
    return heading, max(worst, _strays(u, v, lines))


@jit
def _next(state: Any, x: float, y: float, tip: Any, lines: Any, blade: Any, out: Any) -> None:
    """Fill ``out`` with the state after going to (x, y); a blade is (offset, step)."""
    offset = blade[0]
    heading, far = state[2], 0.0
    if not isnan(state[0]):
        heading, far = _move(state, x, y, offset, lines)
    if not isnan(tip[0]):
        far = max(
            far, hypot(x - offset * cos(heading) - tip[0], y - offset * sin(heading) - tip[1])
        )
    out[0], out[1], out[2], out[3] = x, y, heading, max(state[3], far)
    out[4] = state[4] + (far / blade[1]) ** _POWER


@jit
def _like(best: Any, count: int, state: Any) -> int:
    """Return which kept state stands there too and points nearly the same way; -1 for none."""
    for k in range(count):
        if (
            best[k, 0] == state[0]
            and best[k, 1] == state[1]
            and abs(best[k, 2] - state[2]) < _ALIKE
        ):
            return k
    return -1


@jit
def _keep(best: Any, picks: Any, count: int, state: Any, parent: int, choice: int) -> int:
    """Keep a state where it is among the cheapest; return how many are kept."""
    k = _like(best, count, state)
    if k < 0 and count < len(best):
        k, count = count, count + 1
    elif k < 0:
        k = count - 1
        if state[4] >= best[k, 4]:
            return count
    elif state[4] >= best[k, 4]:
        return count
    while k > 0 and best[k - 1, 4] > state[4]:
        best[k] = best[k - 1]
        picks[k] = picks[k - 1]
        k -= 1
    best[k] = state
    picks[k, 0], picks[k, 1] = parent, choice
    return count


@jit
def search(
    wanted: Any, tips: Any, lines: Any, choices: Any, back: Any, blade: Any, first: Any, found: Any
) -> None:
    """Fill ``found`` (n, 2) with steps for a holder's way, ``first[0]`` with the state after it.

    wanted : (n, 2) the way in steps, not rounded; tips : (n, 2) mm where the tip should be on
    arrival, nan where only near; lines : (n, 2, 2, 2) mm, two segments near which it should be on
    the way there; choices : (m, 2) what is added in turn before rounding down; back : (2, 2) from
    steps to mm; blade : (offset, step) mm; first : (width, 5) the state before it in its first row,
    nan for where the lifted holder stands.
    """
    count, width = len(wanted), len(first)
    picks = np.zeros((count, width, 2), np.int64)
    states, best, out = first.copy(), first.copy(), np.zeros(5)
    alive = 1
    for k in range(count):
        kept = 0
        for parent in range(alive):
            for choice in range(len(choices)):
                u = floor(wanted[k, 0] + choices[choice, 0])
                v = floor(wanted[k, 1] + choices[choice, 1])
                x, y = back[0, 0] * u + back[0, 1] * v, back[1, 0] * u + back[1, 1] * v
                _next(states[parent], x, y, tips[k], lines[k], blade, out)
                kept = _keep(best, picks[k], kept, out, parent, choice)
        states[:] = best
        alive = kept
    first[0] = states[0]
    state = 0
    for k in range(count - 1, -1, -1):
        for axis in range(2):
            found[k, axis] = floor(wanted[k, axis] + choices[picks[k, state, 1], axis])
        state = picks[k, state, 0]
