"""The plan as a value: passes of a sheet, their set-ups, operations and strokes. No behaviour.

All positions are sheet coordinates: mm, x right, y up, origin in the blank's lower left corner,
the viewer looking at the FRONT face. They are never mirrored here; a writer mirrors the reverse.

Terminology: a *copy* is one part of several on a sheet; a *pass* is one face of the sheet; a
*set-up* is what is done without an operator's hand on the machine; an *operation* is all lines of
one role in it; a *stroke* is one motion with the tool down; a *repeat* is the knife going over a
stroke again without lifting.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Any, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    model_serializer,
)
from pydantic.dataclasses import dataclass

from foldmill.finding import Finding
from foldmill_fabricate.ladders import Coupon
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material

XY = tuple[float, float]


class Face(StrEnum):
    """A face of the sheet; the front is the outside of the folded form."""

    FRONT = "front"
    REVERSE = "reverse"


class Role(StrEnum):
    """What a line is for. Order of work on one face is the order given here."""

    HOLE = "hole"
    """registration hole, cut through"""
    MARK = "mark"
    """registration mark that the machine's own sensor finds, cut through"""
    VERNIER = "vernier"
    """lines of a coupon through the sheet, to be read against those of the other face"""
    LABEL = "label"
    """words on a coupon, drawn lightly"""
    RULER = "ruler"
    """lines of a coupon to measure by, drawn lightly"""
    WITNESS = "witness"
    """mark that tells a flipped sheet from one that was not flipped; scored"""
    SCORE = "score"
    RELIEF = "relief"
    """hole at a vertex in which grooves end"""
    CUT_INNER = "cut-inner"
    CUT_OUTER = "cut-outer"


class Gate(StrEnum):
    """What the operator does before a set-up starts; the last two follow from what has happened."""

    LOAD = "load"
    TOOL = "tool"
    FLIP = "flip"
    RE_REGISTER = "re-register"
    """before work goes on on a sheet that was left: is it where it was?"""
    REMOVE = "remove"
    """after the last set-up"""


class _Value(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


def _without(written: dict[str, Any], **usual: object) -> dict[str, Any]:
    """Leave out what is as it is for a sheet that holds one part."""
    return {
        name: value
        for name, value in written.items()
        if name not in usual or value not in (usual[name], ())
    }


@dataclass(frozen=True, slots=True, config=ConfigDict(extra="forbid", allow_inf_nan=False))
class Stroke:
    """One motion with the tool down, once along it. A closed stroke ends where it begins.

    With r repeats an open stroke is followed there and back, r times in all; a closed one is gone
    round r times and then on by the operation's overcut. The tool is not lifted in between. Large
    sheets have hundreds of thousands: with slots each takes half the memory.
    """

    points: tuple[XY, ...] = Field(min_length=2)
    piece: int = Field(default=0, ge=0)
    """Which copy it belongs to: 1, 2, 3 …; 0 where the sheet holds one part, and in the waste."""

    @model_serializer(mode="wrap")
    def _written(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return _without(write(self), piece=0)

    @property
    def closed(self) -> bool:
        """Whether it returns to its start."""
        return len(self.points) > 3 and self.points[0] == self.points[-1]


class Operation(_Value):
    """All strokes of one role in a set-up, in order of work."""

    role: Role
    repeats: int
    overcut: float = 0.0
    """mm; for closed strokes."""
    strokes: tuple[Stroke, ...]


class SetUp(_Value):
    """What is done with one tool, exposure, force and speed."""

    number: int
    """1, 2, 3 … over the whole job."""
    name: str
    """Such as "front-holes"; with the number it names the program."""
    process: Literal["score", "cut"]
    tool: int
    """Number after SP; 0 where SP means nothing."""
    exposure: float
    """mm"""
    force: float
    """gf"""
    speed: float
    """mm/s"""
    gates: tuple[Gate, ...]
    """What the operator does before it, in this order; empty where the machine changes tools."""
    lead_in: tuple[XY, ...] = ()
    """The holder's way in the waste, before the first stroke, that turns a blade of which nobody
    knows how it points; empty where the program need not make up for the blade's offset."""
    swivel_force: float = 0.0
    """gf with which the blade is set down, out of the groove, to be turned at a sharp corner; 0
    where it is turned in the material."""
    operations: tuple[Operation, ...]


class Pass(_Value):
    """Everything done to one face."""

    face: Face
    setups: tuple[SetUp, ...]


class Placement(_Value):
    """Pattern to sheet: turn by ``angle`` degrees about the pattern's origin, then shift."""

    angle: float
    dx: float
    dy: float


class Flip(_Value):
    """How the sheet is turned over, about an axis of the blank."""

    kind: Literal["left-right", "end-over-end"]
    axis: float
    """X0 for left-right (x' = 2·X0 − x), Y0 for end-over-end (y' = 2·Y0 − y), mm."""


class Sheet(_Value):
    """The blank, and where it lies on its carrier."""

    width: float
    height: float
    carrier_width: float
    carrier_height: float
    dx: float
    """Carrier coordinates of the blank's lower left corner, mm."""
    dy: float


class Hole(_Value):
    """A registration hole."""

    x: float
    y: float
    diameter: float


class Mark(_Value):
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


class Stop(_Value):
    """A stop on the carrier that an edge of the blank is pushed against."""

    face: Face
    """The face that is up then."""
    edge: Literal["left", "right", "bottom", "top"]
    """Which edge of the blank it is, as the blank lies then."""
    x: float
    """Where it touches, carrier coordinates, mm."""
    y: float


RegistrationKind = Literal["holes", "l-marks", "edge", "pins", "none"]


class Register(_Value):
    """By what the reverse is brought into register with the front; holes stand in the plan."""

    kind: RegistrationKind = "holes"
    marks: tuple[Mark, ...] = ()
    stops: tuple[Stop, ...] = ()
    pins: tuple[XY, ...] = ()
    """Where pins stand on the carrier when the reverse is up, mm."""


class Share(_Value):
    """What one cause adds to the error between both faces."""

    name: str
    error: float
    """mm, plus or minus."""
    because: str
    """How it comes about, for people."""


class Budget(_Value):
    """How far the reverse may land from the front, at the point where it is worst."""

    shares: tuple[Share, ...]
    likely: float
    """mm; the shares are independent: the root of the sum of their squares."""
    worst: float
    """mm; all of them at once in one direction: their sum."""
    limit: float
    """mm; half the sheet's thickness."""


class Tie(_Value):
    """A bridge left in the outline; its middle and its width along the cut."""

    x: float
    y: float
    width: float


class Fit(_Value):
    """How a flipped sheet really lies: seen = turn(expected) by ``angle`` degrees + (dx, dy).

    Both in carrier coordinates, as the machine sees the reverse; turned about the carrier's origin.
    """

    angle: float
    dx: float
    dy: float


class ProgramFile(_Value):
    """A program on disk: which face and set-ups it holds, and its SHA-256."""

    name: str
    face: Face
    setups: tuple[int, ...]
    sha256: str


class Figures(_Value):
    """How much work the plan is."""

    strokes: int
    lifts: int
    drawn: float
    """mm with the tool down, repeats included"""
    travel: float
    """mm with the tool up"""
    travel_bound: float
    """mm that no order of these strokes can go below; 0 where nobody looked for it"""
    seconds: float
    """by the machine's own speeds and accelerations"""

    @property
    def travel_gap(self) -> float | None:
        """mm of travel above that bound; None where nobody looked for it."""
        return round(self.travel - self.travel_bound, 3) if self.travel_bound else None


class Plan(_Value):
    """Everything that is done to one sheet, and what it was made from."""

    version: Literal[1] = 1
    title: str
    pattern_sha256: str
    """of the bytes of pattern.fold"""
    material: Material
    machine: Machine
    sheet: Sheet
    placement: Placement
    """Of the part; of copies, the first."""
    quantity: int = Field(default=1, ge=1)
    """How many copies of the part the sheet holds."""
    copies: tuple[Placement, ...] = ()
    """Of the second copy, the third …"""
    flip: Flip
    unassigned: Literal["front", "reverse", "skip"] | None = None
    """On which face U creases are scored; None where there are none."""
    holes: tuple[Hole, ...]
    """Registration holes; with pins, those that go over them."""
    registration: Register = Register()
    temperatures: tuple[float, float] | None = None
    """°C, of the sheet at the front pass and at the reverse pass; None where not known yet."""
    budget: Budget | None = None
    """None where the sheet is not turned over."""
    ties: tuple[Tie, ...]
    reliefs: tuple[Hole, ...] = ()
    """Holes at vertices."""
    coupon: Coupon | None = None
    """What is tried on it, where it is a coupon and not a fold."""
    passes: tuple[Pass, ...]
    figures: Figures
    findings: tuple[Finding, ...] = ()
    programs: tuple[ProgramFile, ...] = ()
    drawings: tuple[str, ...] = ()
    """Names of the other files that were written beside it."""

    @property
    def placements(self) -> tuple[Placement, ...]:
        """Where each copy lies, the first one first."""
        return (self.placement, *self.copies)

    @model_serializer(mode="wrap")
    def _written(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return _without(write(self), quantity=1, copies=[])
