"""The points of the stools, each a flat seat with N straight sides, a waist, and feet at p_5."""

from __future__ import annotations

from math import cos, radians

from foldmill.axisymmetric.points import FreePoint, LinePoint


def _seat(n: int, half_width: float) -> dict[int, LinePoint | FreePoint]:
    """Return p_1 and p_2 of a flat seat with N straight sides, ``half_width`` from the centre."""
    return {1: LinePoint(a=half_width), 2: LinePoint(a=half_width / cos(radians(180 / n)))}


STOOL_N8_POINTS: dict[int, LinePoint | FreePoint] = {
    **_seat(8, 110),
    3: LinePoint(a=172.48, gamma=-108.2),
    4: FreePoint(r=97.27, z=-79.29),
    5: LinePoint(a=265.2),
    6: LinePoint(a=238.7, branch=-1),
}
"""Flat octagonal seat, 220 mm across flats, on eight feet."""

STOOL_N6_POINTS: dict[int, LinePoint | FreePoint] = {
    **_seat(6, 98.85),
    3: LinePoint(a=149.62, gamma=-107.3),
    4: FreePoint(r=96.46, z=-64.36),
    5: LinePoint(a=253.97),
    6: LinePoint(a=225.55, branch=-1),
}
"""Flat hexagonal seat, 198 mm across flats, on six feet."""

STOOL_N4_POINTS: dict[int, LinePoint | FreePoint] = {
    **_seat(4, 77.1),
    3: LinePoint(a=110.17, gamma=-117.6),
    4: FreePoint(r=87.98, z=-50.11),
    5: LinePoint(a=241.15),
    6: LinePoint(a=207.47, branch=-1),
}
"""Flat square seat, 154 mm wide, on four splayed feet."""
