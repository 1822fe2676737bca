"""How a blade points that trails its holder, and how it is turned in the waste to point otherwise.

On a straight line the angle φ between blade and motion obeys tan(φ/2) = tan(φ0/2)·exp(−s/offset);
with the tool up it stays. Where the holder swings on a circle about the resting tip, the blade
turns with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import atan, atan2, ceil, cos, exp, hypot, pi, radians, sin, tan

XY = tuple[float, float]

_CHORD = radians(8.0)
"""Longest arc that one chord of a swing stands for."""


def heading(ways: Iterable[Sequence[XY]], offset: float, before: float = 0.0) -> float:
    """Return how a blade points after its holder's ways, rad, from tip to holder.

    offset : in the unit of the ways; before : how it pointed before the first of them.
    """
    for way in ways:
        for (x, y), (u, v) in pairwise(way):
            length = hypot(u - x, v - y)
            if length:
                course = atan2(v - y, u - x)
                astray = (before - course + pi) % (2 * pi) - pi
                before = course + 2 * atan(tan(astray / 2) * exp(-length / offset))
    return before


def swung(holder: XY, now: float, wanted: float, offset: float) -> list[XY]:
    """Return the holder's way about the resting tip that turns a blade, without where it stands.

    now, wanted : rad, from tip to holder; the shorter way round, in whole steps.
    """
    x, y = holder[0] - offset * cos(now), holder[1] - offset * sin(now)
    turn = (wanted - now + pi) % (2 * pi) - pi
    count = ceil(abs(turn) / _CHORD)
    angles = [now + turn * k / count for k in range(1, count + 1)]
    return [(float(round(x + offset * cos(a))), float(round(y + offset * sin(a)))) for a in angles]
