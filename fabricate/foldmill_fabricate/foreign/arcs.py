"""Arcs and circles as chords that leave them by no more than a tolerance."""

from __future__ import annotations

from math import acos, ceil, cos, pi, radians, sin

XY = tuple[float, float]


def chords(radius: float, sweep: float, tolerance: float) -> int:
    """Return into how many chords an arc is divided; radius and tolerance in one unit, sweep deg.

    A chord that spans the angle a leaves its arc by radius·(1 − cos(a/2)).
    """
    if radius <= tolerance:
        return max(1, ceil(abs(sweep) / 90))
    widest = 2 * acos(1 - tolerance / radius)
    return max(1, ceil(abs(radians(sweep)) / widest - 1e-9))


def arc(centre: XY, start: XY, sweep: float, count: int) -> list[XY]:
    """Return the ends of ``count`` chords after ``start``; sweep in deg, counter-clockwise > 0."""
    dx, dy = start[0] - centre[0], start[1] - centre[1]
    found = []
    for k in range(1, count + 1):
        turn = radians(sweep) * k / count
        c, s = cos(turn), sin(turn)
        found.append((centre[0] + c * dx - s * dy, centre[1] + s * dx + c * dy))
    if abs(sweep) % 360 == 0:
        found[-1] = start  # round: it ends exactly where it began
    return found


def circle(centre: XY, radius: float, count: int) -> list[XY]:
    """Return a closed circle of at least four chords, its first point to the right."""
    size = max(4, count)
    angles = (2 * pi * k / size for k in range(size))
    rim = [(centre[0] + radius * cos(a), centre[1] + radius * sin(a)) for a in angles]
    return [*rim, rim[0]]
