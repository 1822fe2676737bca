"""What a user states of each point of a strip."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, TypeVar

from pydantic import AfterValidator, Discriminator, Field, Tag

from foldmill.design import Angle, Coordinate, Length, Params

MOST_POINTS = 200
"""Points of one half wedge. Designs have 4 to 20; ten times as many are a slip of the hand."""


class LinePoint(Params):
    """A point on its symmetry line: the flat pattern drives the folded form."""

    a: Length
    """Distance of p_i from the centre, along its line."""
    branch: Literal[-1, 1] = 1
    """Which of the two possible places P_i takes; it decides mountain or valley of p_{i-2}p_i."""
    gamma: Angle | None = None
    """Direction of P_{i-2}P_i from +r towards +z, needed only where every direction is possible."""


class FreePoint(Params):
    """A point placed in its plane by hand: the folded form drives the flat pattern."""

    r: Coordinate
    """Distance of P_i from the axis, negative beyond it."""
    z: Coordinate
    """Height of P_i."""


Point = TypeVar("Point", bound=Params)


def consecutive(points: Mapping[int, Point]) -> Mapping[int, Point]:
    """Refuse points that are not numbered 1, 2, 3 …, fewer than two, or more than MOST_POINTS."""
    if list(points) != list(range(1, len(points) + 1)):
        raise ValueError(f"the points must be numbered 1, 2, 3 …, not {sorted(points)}")
    if len(points) < 2:
        raise ValueError("a facet needs points 1 and 2 beside the centre; add the missing ones")
    if len(points) > MOST_POINTS:
        raise ValueError(
            f"a half wedge takes {MOST_POINTS} points at most, not {len(points)}; leave out some"
        )
    return points


def in_order(points: Mapping[int, Point]) -> dict[int, Point]:
    """Sort points by their number."""
    return dict(sorted(points.items()))


def _kind(value: object) -> str:
    given = value if isinstance(value, Mapping) else getattr(value, "__dict__", {})
    return "free" if "r" in given or "z" in given else "line"


AnyPoint = Annotated[
    Annotated[LinePoint, Tag("line")] | Annotated[FreePoint, Tag("free")], Discriminator(_kind)
]
"""A point on its line, by a; or one placed by hand, by r and z."""
LinePoints = Annotated[
    dict[int, LinePoint], AfterValidator(in_order), AfterValidator(consecutive), Field(min_length=2)
]
"""p_1 … p_T, by number; all on their lines."""
Points = Annotated[
    dict[int, AnyPoint],
    AfterValidator(in_order),
    AfterValidator(consecutive),
    Field(min_length=2),
]
"""p_1 … p_T, by number; each on its line or placed by hand."""
