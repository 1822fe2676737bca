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

from foldmill_plugins.tuck.params import Tuck, TuckParams
from foldmill_plugins.tuck.stool_points import STOOL_N4_POINTS, STOOL_N6_POINTS, STOOL_N8_POINTS


def _tuck(t: float) -> Tuck:
    return Tuck(point=4, t=t, side=1)


STOOLS = {
    "stool-n4": TuckParams(n=4, phi=90, points=STOOL_N4_POINTS, tucks=(_tuck(160),)),
    "stool-n6": TuckParams(n=6, phi=90, points=STOOL_N6_POINTS, tucks=(_tuck(178),)),
    "stool-n8": TuckParams(n=8, phi=90, points=STOOL_N8_POINTS, tucks=(_tuck(189.2),)),
}
