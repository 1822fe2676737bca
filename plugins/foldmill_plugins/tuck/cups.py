"""Forms that show the other kinds of flaps: flush with the surface, and of several corners."""

from __future__ import annotations

from math import cos, radians

from foldmill.axisymmetric.points import LinePoint
from foldmill_plugins.tuck.flush import flush

_FLUSH = {
    1: LinePoint(a=60),
    2: LinePoint(a=60 / cos(radians(30))),
    3: LinePoint(a=89.4, gamma=-116.5),
    4: LinePoint(a=129),
    6: LinePoint(a=202),
}
"""A flat hexagon, and walls of six flat panels whose surplus lies upon them."""

CUPS = {"flush-n6": flush(6, 90, _FLUSH, (5, 7))}
