"""Forms that show the other kinds of flaps: flush with the surface, and of several corners."""

from __future__ import annotations

from math import cos, radians

from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill_plugins.tuck.flush import flush
from foldmill_plugins.tuck.params import Tuck, TuckParams

_FLUSH = {
    1: LinePoint(a=60),
    2: LinePoint(a=60 / cos(radians(30))),
    3: LinePoint(a=89.4, gamma=-116.5),
    4: LinePoint(a=129),
    6: LinePoint(a=202),
}
"""A flat hexagon, and walls of six flat panels whose surplus lies upon them."""

_BASKET: dict[int, LinePoint | FreePoint] = {
    1: LinePoint(a=66.1, branch=-1),
    2: LinePoint(a=86.8, branch=-1),
    3: LinePoint(a=121.3),
    4: LinePoint(a=162.1),
    5: FreePoint(r=93.9, z=121.9),
    6: LinePoint(a=233.4, branch=-1),
    7: FreePoint(r=85.2, z=193.5),
    8: LinePoint(a=308.2, branch=-1),
    9: LinePoint(a=346.7),
}
"""Ten petals; between them the surplus beside p_5 and p_7 is tucked away in one flap."""

CUPS = {
    "basket-n10": TuckParams(
        n=10, phi=76.4, points=_BASKET, tucks=(Tuck(point=5, t=240), Tuck(point=7, t=280))
    ),
    "flush-n6": flush(6, 90, _FLUSH, (5, 7)),
}
