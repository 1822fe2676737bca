"""The stools: 150 mm high, folded from one 500 × 500 mm sheet of 0.75 mm polypropylene."""

from __future__ import annotations

from math import cos, radians

from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill_plugins.tuck.params import Tuck, TuckParams

STOOL_N8_POINTS: dict[int, LinePoint | FreePoint] = {
    1: LinePoint(a=110),
    2: LinePoint(a=110 / cos(radians(22.5))),
    3: LinePoint(a=172.48, gamma=-108.2),
    4: FreePoint(r=97.27, z=-79.29),
    5: LinePoint(a=265.2, branch=1),
    6: LinePoint(a=238.7, branch=-1),
}
"""Flat octagonal seat, 220 mm across flats, on eight feet."""

STOOLS = {
    "stool-n8": TuckParams(n=8, phi=90, points=STOOL_N8_POINTS, tucks=(Tuck(point=4, t=189.2),)),
}
