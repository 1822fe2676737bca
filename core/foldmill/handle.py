"""A handle: a point of a fold that a person can drag, and what that does to the parameters.

A page can offer every handle of every family without knowing the family: it shows ``position``,
keeps the pointer on ``locus`` and calls ``drag``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from foldmill.errors import InvalidParameters
from foldmill.refusals import explain

Floats = NDArray[np.float64]


class Space(StrEnum):
    """Where a handle is seen."""

    PATTERN = "pattern"
    """on the flat pattern: positions (2,) mm"""
    FOLDED = "folded"
    """on the folded form: positions (3,) mm"""


@dataclass(frozen=True, eq=False)
class Line:
    """A straight line through ``origin`` along the unit vector ``along``."""

    origin: Floats
    along: Floats

    def nearest(self, point: Floats) -> Floats:
        """Return the point of the line nearest to a point."""
        spot: Floats = self.origin + float((point - self.origin) @ self.along) * self.along
        return spot


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane through ``origin`` along the orthonormal vectors ``u`` and ``v``."""

    origin: Floats
    u: Floats
    v: Floats

    def nearest(self, point: Floats) -> Floats:
        """Return the point of the plane nearest to a point."""
        step = point - self.origin
        spot: Floats = self.origin + float(step @ self.u) * self.u + float(step @ self.v) * self.v
        return spot


@dataclass(frozen=True, eq=False)
class Circle:
    """A circle about ``centre`` with ``radius`` mm, from ``u`` towards ``v``, orthonormal."""

    centre: Floats
    radius: float
    u: Floats
    v: Floats

    def nearest(self, point: Floats) -> Floats:
        """Return the point of the circle nearest to a point; its start for the centre itself."""
        angle = self.angle(point)
        spot: Floats = self.centre + self.radius * (np.cos(angle) * self.u + np.sin(angle) * self.v)
        return spot

    def angle(self, point: Floats) -> float:
        """Return the angle of a point about the centre, rad, from u towards v."""
        step = point - self.centre
        return float(np.arctan2(step @ self.v, step @ self.u))


@dataclass(frozen=True, eq=False)
class Handle:
    """A draggable point."""

    name: str
    """The dotted name of the parameter it moves, such as ``points.3.a``."""
    title: str
    space: Space
    position: Floats
    """(2,) or (3,) mm."""
    locus: Line | Plane | Circle
    drag: Callable[[Any, Floats], Any]
    """(parameters, point) → parameters: pure. The point is brought onto the locus and the value
    within its bounds. InvalidParameters where a point has the wrong length or is not finite.
    Whether a form exists there is for ``Design.run`` to say: a page keeps the last one that did."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "drag", self._guarded(self.drag))

    def _guarded(self, drag: Callable[[Any, Floats], Any]) -> Callable[[Any, Floats], Any]:
        """Refuse points that are none, so that no family meets one."""
        size = len(self.position)

        def guarded(params: Any, point: Floats) -> Any:
            try:
                spot = np.asarray(point, np.float64)
            except (TypeError, ValueError):
                spot = np.zeros(0)
            if spot.shape != (size,) or not np.isfinite(spot).all():
                raise InvalidParameters(
                    f"The handle {self.name} is dragged to {point!r}; give {size} finite numbers "
                    "in mm."
                )
            try:
                return drag(params, spot)
            except ValidationError as error:
                raise InvalidParameters(explain(error, type(params))) from None

        return guarded
