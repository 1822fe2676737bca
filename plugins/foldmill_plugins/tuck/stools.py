"""The stools: 150 mm high, folded from one 500 × 500 mm sheet of 0.75 mm polypropylene.

Each is a flat seat, a waist and feet at p_5; the paper beside p_4 is tucked away inside. The seat
is bounded by p_1 and p_2, where a_2 = a_1 / cos(180°/N) leaves the direction γ of p_3 free.

The six- and four-footed ones were found by a seeded differential evolution over a_1, a_3, γ_3, P_4,
a_5, a_6 and t, with penalties for: another height than 150 mm, widths outside 208…226 mm (232 with
six feet), a turned sheet over 491 mm, feet less than 12 mm below all else, folded-in flaps nearer
than 10 mm to the seat, creases under 30 mm, corners under 19°, a tuck outside, a penetration, and a
short range of t that is free of it. Then rounded to 0.01 mm and 0.1°.

=========  ===============  ======  ===============  ===============  ================
feet       folded, mm       sheet   shortest crease  sharpest corner  free range of t
=========  ===============  ======  ===============  ===============  ================
8          220 × 220 × 150  490.0   38.8 mm          22.5°            133…235 mm
6          216 × 228 × 150  490.6   42.0 mm          28.5°            140…216 mm
4          225 × 225 × 150  405.6   33.1 mm          23.2°            115…205 mm
=========  ===============  ======  ===============  ===============  ================
"""

from __future__ import annotations

from math import cos, radians

from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill_plugins.tuck.params import Tuck, TuckParams


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

STOOLS = {
    "stool-n4": TuckParams(n=4, phi=90, points=STOOL_N4_POINTS, tucks=(Tuck(point=4, t=160),)),
    "stool-n6": TuckParams(n=6, phi=90, points=STOOL_N6_POINTS, tucks=(Tuck(point=4, t=178),)),
    "stool-n8": TuckParams(n=8, phi=90, points=STOOL_N8_POINTS, tucks=(Tuck(point=4, t=189.2),)),
}
