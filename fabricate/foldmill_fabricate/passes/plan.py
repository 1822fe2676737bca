"""The plan of one sheet: all that is done to it, and what it was made from."""

from __future__ import annotations

import hashlib
from typing import Any, Literal

from pydantic import Field, SerializerFunctionWrapHandler, model_serializer

from foldmill.finding import Finding
from foldmill_fabricate.kinds import Unassigned
from foldmill_fabricate.ladders import Coupon
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes.lying import Flip, Hole, Placement, Register, Sheet, Tie
from foldmill_fabricate.passes.reckoned import Budget, Figures
from foldmill_fabricate.passes.strokes import Face, Pass, Role
from foldmill_fabricate.passes.value import Value, without


class ProgramFile(Value):
    """A program on disk: which face and set-ups it holds, and its SHA-256."""

    name: str
    face: Face
    setups: tuple[int, ...]
    sha256: str


class PenUse(Value):
    """What one pen of a foreign drawing draws."""

    pen: int
    role: Role | None
    """None where its lines are left out."""


class Source(Value):
    """A drawing from elsewhere that a plan was made from: no pattern proves it."""

    name: str
    sha256: str
    """of its bytes"""
    pens: tuple[PenUse, ...]
    tolerance: float
    """How far lines may leave the drawing's, mm: arcs became chords, and near corners one."""


class There(Value):
    """Strokes of one operation that are on the sheet already."""

    setup: int
    """Number of its set-up in the origin."""
    role: Role
    strokes: tuple[int, ...]
    """1, 2, 3 … over the operation's strokes."""


class Remakes(Value):
    """A sheet that was left half made: this plan holds only what was missing on it."""

    sheet: str
    """Its id in the ledger."""
    origin: Plan
    """What it was begun from; without the strokes that are there, and but for set-ups that are left
    out, this plan."""
    origin_sha256: str
    """``digest`` of the origin: what the ledger knows the sheet's job by."""
    record_sha256: str
    """``digest`` of the ledger's record of it when this was planned."""
    there: tuple[There, ...]

    @property
    def written(self) -> str:
        """The id that is written on the sheet: the one it was begun with."""
        return self.origin.written(self.sheet)


class Plan(Value):
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
    unassigned: Unassigned | None = None
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
    source: Source | None = None
    """The drawing it was made from, where it was not made from a pattern."""
    remakes: Remakes | None = None
    """Which sheet it goes on with; None where it begins one."""
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

    @property
    def whole(self) -> Plan:
        """The plan that its sheet was begun from: itself, where it goes on with none."""
        return self.remakes.origin.whole if self.remakes else self

    def written(self, sheet: str) -> str:
        """Return the id that is written on a sheet: the one it was begun with."""
        return self.remakes.written if self.remakes else sheet

    @property
    def digest(self) -> str:
        """SHA-256 of the plan: what the ledger knows a job by."""
        return hashlib.sha256(self.model_dump_json().encode()).hexdigest()

    @model_serializer(mode="wrap")
    def _written(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return without(write(self), quantity=1, copies=[], remakes=None, source=None)
