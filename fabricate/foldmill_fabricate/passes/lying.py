"""How the blank lies on the machine, and how it lies again once it was turned over."""

from __future__ import annotations

from typing import Literal

from foldmill_fabricate.kinds import FlipKind, RegistrationKind
from foldmill_fabricate.passes.strokes import Face
from foldmill_fabricate.passes.value import XY, Value


class Placement(Value):
    """Pattern to sheet: turn by ``angle`` degrees about the pattern's origin, then shift."""

    angle: float
    dx: float
    dy: float


class Flip(Value):
    """How the sheet is turned over, about an axis of the blank."""

    kind: FlipKind
    axis: float
    """X0 for left-right (x' = 2·X0 − x), Y0 for end-over-end (y' = 2·Y0 − y), mm."""


class Sheet(Value):
    """The blank, and where it lies on its carrier."""

    width: float
    height: float
    carrier_width: float
    carrier_height: float
    dx: float
    """Carrier coordinates of the blank's lower left corner, mm."""
    dy: float


class Hole(Value):
    """A registration hole."""

    x: float
    y: float
    diameter: float


class Mark(Value):
    """A mark that a machine's own sensor looks for on the reverse: a window in the sheet."""

    shape: Literal["square", "ell"]
    x: float
    """Its outer corner, from which machines count distances, mm."""
    y: float
    across: Literal[-1, 1]
    """Whether it lies to the right (1) or to the left (-1) of that corner, seen from the front."""
    upward: Literal[-1, 1]
    """Whether it lies above (1) or below (-1) that corner."""
    size: float
    """Side of the square, or length of the arms, mm."""
    width: float
    """Of the arms, mm; of a square its side."""


class Stop(Value):
    """A stop on the carrier that an edge of the blank is pushed against."""

    face: Face
    """The face that is up then."""
    edge: Literal["left", "right", "bottom", "top"]
    """Which edge of the blank it is, as the blank lies then."""
    x: float
    """Where it touches, carrier coordinates, mm."""
    y: float


class Register(Value):
    """By what the reverse is brought into register with the front; holes stand in the plan."""

    kind: RegistrationKind = "holes"
    marks: tuple[Mark, ...] = ()
    stops: tuple[Stop, ...] = ()
    pins: tuple[XY, ...] = ()
    """Where pins stand on the carrier when the reverse is up, mm."""


class Tie(Value):
    """A bridge left in the outline; its middle and its width along the cut."""

    x: float
    y: float
    width: float


class Fit(Value):
    """How a flipped sheet really lies: seen = turn(expected) by ``angle`` degrees + (dx, dy).

    Both in carrier coordinates, as the machine sees the reverse; turned about the carrier's origin.
    """

    angle: float
    dx: float
    dy: float
