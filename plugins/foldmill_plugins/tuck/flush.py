"""Flaps that lie exactly on the surface (thesis 4.1.2).

Where P_i is the middle between P_{i-1} and its mirror image, the facets on both sides of P_{i-2}P_i
lie in one plane, and so do those beyond, if P_{i+2} is such a middle as well. With the corner t_i
on the continued line p_{i-1}p_i, the angle p_{i-2}p_it_i is a right one, and the flap lies upon the
facets beside it, as long as |p_i t_i| ≤ |p_i p_{i-1}|.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric import strip
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill_plugins.tuck.params import Tuck, TuckParams


def flush(
    n: int, phi: float, lines: Mapping[int, LinePoint], middles: tuple[int, ...]
) -> TuckParams:
    """Return a form whose points ``middles`` are middles, and whose flaps lie on the surface.

    lines : all other points, by number, mm; phi : deg.
    Raises ImpossibleGeometry where the surplus paper is too wide to lie on the facet beside it.
    """
    points: dict[int, LinePoint | FreePoint] = dict(lines)
    for i in middles:
        solved = strip.solve(n, phi, {k: points[k] for k in range(1, i)})
        r, z = solved.meridian[i - 1]
        points[i] = FreePoint(r=float(r * np.cos(solved.theta)), z=float(z))
    solved = strip.solve(n, phi, {k: points[k] for k in sorted(points)})
    tucks = tuple(Tuck(point=i, t=_extended(solved, i)) for i in middles)
    return TuckParams(n=n, phi=phi, points=points, tucks=tucks)


def _extended(solved: strip.Strip, i: int) -> float:
    """Return where the line p_{i-1}p_i meets the line of p_i, mm from the centre."""
    azimuth = solved.theta if i % 2 == 0 else 0.0
    along = np.array([np.cos(azimuth), np.sin(azimuth)])
    across = np.array([-along[1], along[0]])
    before, here = solved.flat[i - 1], solved.flat[i]
    share = float((before @ across) / ((before - here) @ across))
    corner = before + share * (here - before)
    width, room = (float(np.linalg.norm(end - here)) for end in (corner, before))
    if width > room:
        raise ImpossibleGeometry(
            f"The flap beside point {i} is {width:.4g} mm wide, but the facet it would lie on only "
            f"{room:.4g} mm; bring point {i - 1} farther from the axis."
        )
    return float(corner @ along)
