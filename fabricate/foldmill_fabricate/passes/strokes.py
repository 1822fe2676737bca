"""What is done to a sheet: passes, their set-ups, operations and strokes."""

from __future__ import annotations

from enum import StrEnum
from typing import Any, Literal

from pydantic import ConfigDict, Field, SerializerFunctionWrapHandler, model_serializer
from pydantic.dataclasses import dataclass

from foldmill_fabricate.passes.value import XY, Value, without


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
        return without(write(self), piece=0)

    @property
    def closed(self) -> bool:
        """Whether it returns to its start."""
        return len(self.points) > 3 and self.points[0] == self.points[-1]


class Operation(Value):
    """All strokes of one role in a set-up, in order of work."""

    role: Role
    repeats: int
    overcut: float = 0.0
    """mm; for closed strokes."""
    strokes: tuple[Stroke, ...]


class SetUp(Value):
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


class Pass(Value):
    """Everything done to one face."""

    face: Face
    setups: tuple[SetUp, ...]
