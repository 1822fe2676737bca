"""What a user states of a tucked form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field

from foldmill import Angle, Count, Length, Params
from foldmill.axisymmetric.points import FreePoint, LinePoint, Points
from foldmill_plugins.tuck.stool_points import STOOL_N8_POINTS

Lies = Literal["inside", "outside"]


class Tuck(Params):
    """How the corner t_i beside one point off its line is placed; a blank has one such corner for
    each of its points off the line, in their order."""

    point: Count
    """Number i of the point beside which the corner lies."""
    t: Length | None = None
    """Distance of the corner from the centre; left out, the middle of what penetrates nothing."""
    side: Literal[-1, 1] | None = None
    """Which of two mirror images the corner takes in space: 1 leans counter-clockwise seen from
    above, -1 clockwise; beyond a blank's first corner, 1 is the side from which the corner before
    and the next two points are seen counter-clockwise. Left out, whichever penetrates nothing."""
    lies: Lies | None = None
    """Whether the flap lies inside or outside the form; left out, whatever the shape allows."""


def _default_points() -> dict[int, LinePoint | FreePoint]:
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
    """How blanks are folded away; a corner that is not named is placed automatically."""

    @classmethod
    def renumbered(
        cls, values: dict[str, Any], name: str, moved: Mapping[int, int]
    ) -> dict[str, Any]:
        """Keep every tuck beside its point; one whose point is gone goes with it."""
        if name != "points":
            return values
        kept = [tuck for tuck in values["tucks"] if tuck["point"] in moved]
        return {**values, "tucks": [{**tuck, "point": moved[tuck["point"]]} for tuck in kept]}
