"""What a user states of a tucked form."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from foldmill import Angle, Count, Length, Params
from foldmill.axisymmetric.points import FreePoint, LinePoint, Points


class Tuck(Params):
    """How the blank beside one free point is folded away."""

    point: Count
    """Number of the free point beside which the blank lies."""
    t: Length | None = None
    """Distance of the tuck's corner from the centre; left out, the middle of the longest run of
    places where the tuck penetrates nothing."""
    side: Literal[-1, 1] = 1
    """Which of two mirror images all the tucks take: 1 leans counter-clockwise seen from above."""


def _default_points() -> dict[int, LinePoint | FreePoint]:
    from foldmill_plugins.tuck.stools import STOOL_N8_POINTS

    return dict(STOOL_N8_POINTS)


class TuckParams(Params):
    """N wedges, an opening angle, the points of one half wedge, and the tucks."""

    n: Count = Field(default=8, ge=3, le=72)
    """Order of rotational symmetry: how many wedges go round."""
    phi: Angle = Field(default=90.0, ge=0, le=180)
    """Angle between the innermost crease and the axis; 90 is a flat centre."""
    points: Points = Field(default_factory=_default_points)
    """Points p_1, p_2 … outwards, odd ones on line l1, even ones on line l2; a point given by r and
    z is placed in space by hand, and leaves a blank to tuck."""
    tucks: tuple[Tuck, ...] = ()
    """How blanks are folded away; a blank that is not named gets an automatic tuck."""
