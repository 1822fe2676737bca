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
    """(parameters, point) → parameters: pure; the point is first brought onto the locus, the value
    clamped to what is valid, or InvalidParameters raised with the sentence."""
