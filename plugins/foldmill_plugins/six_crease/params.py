"""What a user states of a tube of six-crease bases."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from foldmill import Angle, Coordinate, Count, InvalidParameters, Length, Params
from foldmill.axisymmetric.points import in_order
from foldmill.tolerances import COINCIDENT_MM

FARTHEST = 10_000.0
"""mm. Ten metres: no sheet is larger, and so far from 0 a double still tells 2e-12 mm."""


class HeightPoint(Params):
    """A point of the pattern on its line."""

    y: Coordinate = Field(ge=-FARTHEST, le=FARTHEST)
    """Height of p_i on its line, above that of p_{i-2}."""
    branch: Literal[-1, 1] = 1
    """Which of the two possible places P_i takes, from point 3 on; it decides mountain or valley of
    p_{i-2}p_i."""
    gamma: Angle | None = None
    """Direction of P_{i-2}P_i from +r towards +z, needed only where every direction is possible."""


def _enough(points: Mapping[int, HeightPoint]) -> Mapping[int, HeightPoint]:
    if list(points) != list(range(1, len(points) + 1)):
        raise ValueError(f"the points must be numbered 1, 2, 3 …, not {sorted(points)}")
    if len(points) < 4:
        raise ValueError(
            f"a tube needs points 1 to 4 (with fewer the sheet falls apart), not {len(points)} of "
            "them; add the missing ones"
        )
    return points


def _rising(points: Mapping[int, HeightPoint]) -> Mapping[int, HeightPoint]:
    for i in range(3, len(points) + 1):
        low, high = points[i - 2].y, points[i].y
        if high - low <= 2 * COINCIDENT_MM:
            raise ValueError(
                f"point {i} must lie above point {i - 2} on its line: points.{i}.y = {high:g} mm, "
                f"but points.{i - 2}.y = {low:g} mm. Give point {i} more than {low:g} mm"
            )
    return points


HeightPoints = Annotated[
    dict[int, HeightPoint],
    AfterValidator(in_order),
    AfterValidator(_enough),
    AfterValidator(_rising),
]
"""p_1 … p_T, by number, T ≥ 4."""


def points_of(heights: str, branches: str) -> dict[int, HeightPoint]:
    """Read points from heights, mm, "0 6.5 28.2 …", and branches from point 3 on, "-+…".

    Raises InvalidParameters for another number of branches, or other signs than + and -.
    """
    y = [float(word) for word in heights.split()]
    if len(branches) != len(y) - 2 or set(branches) - {"+", "-"}:
        raise InvalidParameters(
            f"{len(y)} points need {max(len(y) - 2, 0)} branches, each + or -, for the points from "
            f"3 on, not {branches!r}."
        )
    signs = "++" + branches
    return {i: HeightPoint(y=y[i - 1], branch=_sign(signs[i - 1])) for i in range(1, len(y) + 1)}


def _sign(letter: str) -> Literal[-1, 1]:
    return -1 if letter == "-" else 1


def _candlestick() -> dict[int, HeightPoint]:
    return points_of("0 6.5 28.2 32.7 59.7 67 92.1 105.5 129.2", "-+--+--")


class SixCreaseParams(Params):
    """N wedges, the points of one half of a wedge, and where the first two of them are in space."""

    n: Count = Field(default=10, ge=3, le=72)
    """Order of rotational symmetry: how many wedges go round."""
    w: Length = Field(default=10.0, le=FARTHEST)
    """Distance of the lines l1 and l2: the sheet is 2·N·w wide."""
    L: Coordinate = Field(default=42.0, ge=0, le=FARTHEST)
    """Distance of P_1 from the origin, which lies on the axis."""
    phi: Angle = Field(default=147.5, ge=0, le=180)
    """Angle between the axis and the line from the origin to P_1."""
    beta: Angle = Field(default=292.9, ge=-360, le=360)
    """Where P_2 is on its circle: angle between the axis and C_2P_2, from +z towards +r."""
    points: HeightPoints = Field(default_factory=_candlestick)
    """Points p_1, p_2 … upwards: odd ones on line l1, even ones on line l2."""
    tab: Coordinate = Field(default=0.0, ge=0)
    """Width of the paper that closes the seam; 0 for none."""
    seam: Literal["tabs", "overlap"] = "tabs"
    """What closes it: a glue tab at every edge of the seam, or one overlap along all of it, with
    the creases of the facets that it lies upon."""
    taper: Angle = Field(default=30.0, ge=0, le=75)
    """By how much the ends of a tab, or of the overlap, lean inwards; where the facet they are
    glued upon is narrower, they lean as much as that facet needs."""
