"""What a coupon holds, as a value: ladders of trials, verniers, bars and words. No behaviour.

All positions are sheet coordinates: mm, x right, y up, the viewer looks at the FRONT face.

Terminology: a *ladder* is one thing tried in steps; a *rung* is one of its trials, in a cell of its
own; a *strip* is a tongue that is cut on three sides and folds at its root; a *patch* is a square
that hangs on ties, with creases that meet in its middle; a *vernier* is two rows of lines, one on
each face, of slightly different pitch.
"""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

XY = tuple[float, float]
LadderKind = Literal["depth", "force", "repeats", "gap", "spacing", "hinge", "relief"]
Side = Literal["front", "reverse"]


class _Value(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Rung(_Value):
    """One trial: its value, and the lower left corner of its cell."""

    value: float
    """mm of blade, gf, times, mm of land, mm apart, degrees to fold or mm of diameter, by the kind
    of its ladder."""
    at: XY
    face: Side
    """On which face its scores are made; of a patch, those that are mountains."""


class Ladder(_Value):
    """One thing tried in steps."""

    kind: LadderKind
    rungs: tuple[Rung, ...] = Field(min_length=1)


class Vernier(_Value):
    """Lines on the front beside lines on the reverse: the pair that meets reads the offset.

    Line k (−each_way … each_way) is at front_pitch·k on the front and at shift + reverse_pitch·k on
    the reverse. It carries the number −10·shift − k: where the two meet in one straight line, that
    is how far the reverse lies along the axis, in tenths of a millimetre.
    """

    axis: Literal["x", "y"]
    at: XY
    """Where the front's line 0 meets the place of the reverse's, were there no shift."""
    shift: float
    each_way: int = Field(ge=2)
    front_pitch: float
    reverse_pitch: float
    tick: float
    """Length of each line, mm."""


class Bars(_Value):
    """Crosses A, B, C, D at the corners of a rectangle, counter-clockwise from the lower left."""

    at: XY
    """Where A is."""
    width: float
    height: float
    reach: float
    """Half the size of a cross, mm."""


class Words(_Value):
    """A line of words, drawn in single strokes, to be read with its face up."""

    text: str
    at: XY
    """The left end of its baseline, as one reads it."""
    height: float
    """of capitals, mm"""
    face: Side


class Lettering(_Value):
    """How words and lines to measure by are drawn: as lightly as the machine can."""

    process: str
    """Kind of the process, such as "half-cut" or "pen"."""
    tool: int
    exposure: float
    force: float
    speed: float


class Coupon(_Value):
    """Everything on a coupon, beside registration holes and witness mark."""

    degree: Literal[4, 6]
    """How many creases meet in the middle of a patch."""
    strip_width: float
    strip_length: float
    patch: float
    """Side of a patch, mm."""
    ladders: tuple[Ladder, ...]
    verniers: tuple[Vernier, ...]
    slits: bool
    """Whether the verniers' lines go through the sheet; else they are lines to be seen through it.
    """
    bars: Bars
    words: tuple[Words, ...]
    lettering: Lettering
    left_out: tuple[str, ...] = ()
    """What is not on it, and why; one sentence each."""
