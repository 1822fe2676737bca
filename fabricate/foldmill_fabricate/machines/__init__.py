"""Cutting plotters, as TOML presets and the model they are read into."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator

from foldmill_fabricate.kinds import FlipKind, Kind
from foldmill_fabricate.presets import INFORMATION, Preset, Sourced
from foldmill_fabricate.units import (
    Deg,
    DegPerSecond,
    GramForce,
    Mm,
    MmPerSecond,
    MmPerSecond2,
    Seconds,
    StepsPerMm,
)


class Bed(Preset):
    """What the machine can reach, in its own coordinates."""

    width: Mm = Field(gt=0)
    length: Mm = Field(gt=0)
    margin: Mm = Field(ge=0)
    """Strip along every edge of the carrier that the tool cannot reach."""
    left: Mm | None = Field(None, ge=0)
    """That strip on the left, where it differs; so do the next three."""
    right: Mm | None = Field(None, ge=0)
    lead: Mm | None = Field(None, ge=0)
    """At the end that goes in first: the bottom of the sheet."""
    trail: Mm | None = Field(None, ge=0)
    """At the end that goes in last: the rollers let go of it."""
    carrier_width: Mm = Field(gt=0)
    carrier_height: Mm = Field(gt=0)
    """Size of the cutting mat that carries the blank; its lower left corner is the origin."""
    pinch_rollers: tuple[Mm, ...] = Field((), json_schema_extra=INFORMATION)
    """Where rollers press on the sheet, from the left; empty where the operator sets them."""

    pull: Literal["up", "down"] | None = None
    """Which way alone the tool may go along the feed, seen on the carrier with y up, because it can
    pull the sheet but not push it: a roll-feed machine without a mat. None where either will do."""

    @model_serializer(mode="wrap")
    def _written(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return {k: v for k, v in write(self).items() if k != "pull" or v is not None}

    @property
    def margins(self) -> tuple[float, float, float, float]:
        """The strips on the left, at the lead, on the right and at the trail, mm."""
        given = (self.left, self.lead, self.right, self.trail)
        left, lead, right, trail = (self.margin if each is None else each for each in given)
        return left, lead, right, trail


class Axes(Preset):
    """From sheet coordinates on the carrier (x right, y up) to machine steps."""

    units_per_mm: StepsPerMm = Field(ge=1, le=10_000)
    swap: bool = False
    """Whether the machine calls y what the sheet calls x."""
    lowest: int = 0
    """Least coordinate that the firmware accepts, steps."""
    highest: int = 32767
    """Greatest coordinate that the firmware accepts, steps."""
    top: Annotated[Mm | None, Field(gt=0)] = None
    """Where y is counted downwards from the upper edge of the carrier: the carrier's height. Each
    plan puts that of its own carrier there. None where y is counted upwards, from the lower edge.
    """
    scale_x: Annotated[float, Field(ge=0.9, le=1.1)] = 1.0
    """What lengths along the sheet's x are multiplied with, because the machine makes them off."""
    scale_y: Annotated[float, Field(ge=0.9, le=1.1)] = 1.0
    """The same along y."""
    skew: Annotated[Deg, Field(ge=-5, le=5)] = 0.0
    """By how much a line along y is turned clockwise, because the machine leans it the other way.

    Scale and skew are applied last, to carrier coordinates: x' = scale_x·(x + y·tan skew),
    y' = scale_y·y, or scale_y·(top - y).
    """


class Tools(Preset):
    """Which tool makes which line, and who changes it."""

    change: Literal["operator", "select"]
    """By an operator's hand between set-ups, or by SP from the program."""
    stations: dict[Kind, int]
    """Which processes it offers, and the number after SP of each; 0 where SP means nothing."""
    max_thickness: Mm = Field(gt=0)
    """Thickest sheet that passes under it."""
    max_force: GramForce | None = Field(None, gt=0)
    """None where no force is set: a laser has none."""
    min_force: GramForce = Field(0.0, ge=0)
    """Least force that it can set."""
    force_unit: GramForce = Field(1.0, gt=0)
    """What one unit of the machine's own force setting is worth."""
    speed_unit: MmPerSecond = Field(10.0, gt=0)
    """What one unit of the machine's own speed setting is worth."""
    blade: Literal["drag", "tangential", "none"] = "drag"
    """Whether a blade swivels by itself behind its axis, is turned by the machine, or is none."""
    trails: bool = True
    """Whether the tool follows the way and must be turned: a knife or wheel; not a pen or laser."""
    conditions: int = Field(1, ge=1, json_schema_extra=INFORMATION)
    """How many sets of force and speed it stores."""
    firmware_offset: bool = True
    """Whether the machine itself makes up for the blade's offset."""
    blade_offset: Mm = Field(0.25, ge=0)
    """From the holder's axis to the tip that trails it."""

    @model_validator(mode="after")
    def _has_forces(self) -> Self:
        """Refuse a least force above the greatest."""
        if self.max_force is not None and self.min_force > self.max_force:
            raise ValueError("min_force must be at most max_force")
        return self

    @property
    def host_offset(self) -> float:
        """The offset that programs make up for, mm; 0 where the machine does, or nothing trails."""
        return self.blade_offset if self.trails and not self.firmware_offset else 0.0

    def station(self, kind: str) -> int:
        """Return the number after SP for a process; 0 where SP means nothing."""
        return next((n for each, n in self.stations.items() if each == kind), 0)

    @property
    def selects(self) -> bool:
        """Whether any process has a number after SP."""
        return any(self.stations.values())

    def force(self, wanted: float) -> float:
        """Return what is set of a wanted force, within what there is; 0 where none is set."""
        if self.max_force is None:
            return 0.0
        return min(max(wanted, self.min_force), self.max_force)


class Dialect(Preset):
    """How the machine wants its HP-GL."""

    preamble: str = "IN;DF;PA;"
    """Exactly one IN, in front: on some machines a second one cancels the job."""
    trailer: str = "PU;SP0;"
    """What a program ends with."""
    speed: bool = True
    """Whether VS (cm/s) is understood."""
    force: bool = True
    """Whether FS (gf) is understood."""
    lifts_apart: bool = False
    """Whether PU and the way to the next stroke are two instructions, PU and PA."""
    line_end: str = "\n"
    """What stands after each instruction."""
    max_instruction: int = Field(240, ge=32)
    """Longest instruction, bytes."""
    second_in_cancels: bool = False
    """Whether an IN that arrives later cancels what the machine has not begun."""
    controls: Literal["hp-7475", "hp-7550"] = "hp-7475"
    """Which ESC sequences it knows; the HP 7550A has more."""


class Gcode(Preset):
    """How a machine that speaks G-code brings its tool into the sheet."""

    lowers: Literal["z", "beam"] = "z"
    """By its Z axis, which is 0 on the sheet's upper face; or by switching a beam on."""
    clear: Mm = Field(5.0, gt=0)
    """Z at which the tool travels above the sheet."""
    plunge_speed: MmPerSecond = Field(5.0, gt=0)
    """Speed of the way down into the sheet."""
    press: Mm = Field(0.5, gt=0)
    """How far below Z 0 a tool that does not cut, such as a pen on a spring, is lowered."""
    score_power: int = Field(1000, ge=1)
    """S of a beam that scores or perforates; M4 takes it back where the head is slow."""
    cut_power: int = Field(1000, ge=1)
    """S of a beam that cuts through; M3 keeps it as it is."""


class Motion(Preset):
    """The machine's own figures, for time estimates and the simulator's clock."""

    travel_speed: MmPerSecond = Field(gt=0)
    acceleration: MmPerSecond2 = Field(gt=0)
    corner_speed: MmPerSecond = Field(10.0, gt=0)
    """Change of velocity at a corner that is taken without slowing down further."""
    lift_time: Seconds = Field(ge=0)
    tool_time: Seconds = Field(ge=0)
    swivel_speed: DegPerSecond = Field(360.0, gt=0)
    """How fast a trailing tool is turned in the material."""
    swivel_time: Seconds = Field(0.05, ge=0)
    """What stopping and starting again for such a turn takes besides."""
    swivel_from: Deg = Field(20.0, ge=0)
    """Bends up to this are followed without stopping."""


class Serial(Preset):
    """How the machine is talked to."""

    baud: int = 9600
    handshake: Literal[
        "none", "paced", "xon-xoff", "rts-cts", "dtr", "esc-b", "enq-ack", "grbl", "gp-gl"
    ]
    """How the machine says that it has room: not at all (paced: nor does it bear the line's full
    rate), by XON and XOFF, by its RTS or DTR line, when asked by ESC.B or ENQ, by the ok of GRBL,
    or by the status of GP-GL.
    """
    bytes_per_second: float = Field(300.0, gt=0)
    """With the handshake ``paced``: how fast bytes may come in on average."""
    buffer: int = Field(1024, ge=64)
    """Bytes the machine holds before it overruns."""
    answers: bool = True
    """Whether it replies to OA, OE and ESC.B at all."""
    reports_losses: bool = False
    """Whether it knows ESC.E, by which it tells of bytes lost on the line; with ``esc-b`` and
    ``enq-ack`` it does in any case. Without, a program ends "at its end" at best, not "executed".
    """


class Marks(Preset):
    """How the machine finds a sheet again."""

    kinds: tuple[Literal["holes", "edge", "pins", "l-marks-3", "l-marks-4", "two-target"], ...] = (
        "holes",
        "edge",
    )
    """What it, or its operator, can find."""
    square: Mm = Field(0.0, ge=0)
    """Side of the filled square of optical marks; 0 where all of them are L-shaped."""
    arm: Mm = Field(0.0, ge=0)
    """Length of the arms of optical marks."""
    line_width: Mm = Field(0.0, ge=0)
    """Width of their lines."""
    hole_error: Mm = Field(0.2, ge=0)
    """How far off an operator measures the middle of a hole."""
    optical_error: Mm = Field(0.2, ge=0)
    """How far off its sensor finds marks."""
    pin_diameter: Mm = Field(5.0, gt=0)
    """Of the pins on its carrier."""
    pin_spacing: Mm = Field(0.0, ge=0)
    """Distance of the two pins, middle to middle; 0 where it has none."""
    pin_error: Mm = Field(0.3, ge=0)
    """How far off a sheet lies on pins."""
    edge_error: Mm = Field(1.0, ge=0)
    """How far off a sheet lies against stops."""

    @model_validator(mode="after")
    def _measured(self) -> Self:
        """Refuse kinds whose sizes are not given."""
        if {"l-marks-3", "l-marks-4"} & {*self.kinds} and not (self.arm and self.line_width):
            raise ValueError("kinds names L marks, which need arm and line_width")
        if "l-marks-3" in self.kinds and not self.square:
            raise ValueError("kinds names l-marks-3, of which one is a square: square is missing")
        if "pins" in self.kinds and not self.pin_spacing:
            raise ValueError("kinds names pins, which need pin_spacing")
        return self


class TwoSides(Preset):
    """Where a flipped sheet comes to lie on this machine, less where it ought to: of a coupon.

    Of the reverse as the machine sees it, about the blank's lower left corner there: what ought to
    lie at p lies at turn(p, angle) + (dx, dy). Programs of the reverse follow the sheet so, after
    the mirror and before scale and skew. Marks that were measured on the sheet itself say the whole
    of it and stand in its place; so do optical marks, which the machine finds itself.
    """

    dx: Mm = Field(0.0, ge=-10, le=10)
    """How far the sheet lies to the right."""
    dy: Mm = Field(0.0, ge=-10, le=10)
    """How far it lies up."""
    angle: Deg = Field(0.0, ge=-2, le=2)
    """By how much it is turned counter-clockwise."""
    flip: FlipKind = "left-right"
    """How the sheet was turned when this was measured; it says nothing of the other way."""
    measured: str = Field("", json_schema_extra=INFORMATION)
    """When, by whom and with what it was measured; empty where it never was."""

    @property
    def is_known(self) -> bool:
        """Whether there is anything to make up for."""
        return bool(self.dx or self.dy or self.angle)


class Files(Preset):
    """What the machine's own software makes of a drawing."""

    accepts: tuple[str, ...] = Field(("hpgl",), json_schema_extra=INFORMATION)
    """Kinds of file that it reads."""
    tool_by: Literal["pen", "colour", "layer", "file"] = Field(
        "file", json_schema_extra=INFORMATION
    )
    """What tells it which tool a line is for."""
    dashes: bool = Field(False, json_schema_extra=INFORMATION)
    """Whether dashed lines are cut as dashes; foldmill draws real ones in any case."""
    bridges: bool = Field(False, json_schema_extra=INFORMATION)
    """Whether it leaves ties by itself; foldmill leaves them in any case."""
    closes_paths: bool = Field(False, json_schema_extra=INFORMATION)
    """Whether it joins the ends of open paths by itself."""
    curves: bool = Field(False, json_schema_extra=INFORMATION)
    """Whether it takes arcs and Bézier curves; foldmill draws straight lines in any case."""


class Machine(Sourced):
    """A cutting plotter and its habits."""

    slug: str
    title: str
    build: Literal["roll-feed", "flatbed", "laser", "pen-plotter"] = Field(
        json_schema_extra=INFORMATION
    )
    """What kind of machine it is."""
    language: Annotated[str, Field(pattern=r"^[a-z][a-z0-9.+-]*$")]
    """Programs are written in hpgl, gp-gl and gcode, and in what plugins add."""
    bed: Bed
    axes: Axes
    tools: Tools
    dialect: Dialect = Field(default_factory=lambda: Dialect.model_validate({}))
    gcode: Gcode = Field(default_factory=lambda: Gcode.model_validate({}))
    motion: Motion
    serial: Serial
    marks: Marks = Field(default_factory=lambda: Marks.model_validate({}))
    two_sides: TwoSides = Field(default_factory=lambda: TwoSides.model_validate({}))
    files: Files = Field(default_factory=lambda: Files.model_validate({}))
    mark_tolerance: Mm = Field(0.3, gt=0)
    """Largest residual of measured registration marks that is still believed."""
    repeatability: Mm = Field(0.15, ge=0)
    """How far a line lands from where it landed before."""
    provenance: str = Field(min_length=1)
    """Where the values come from that name no source of their own."""
    verified: bool
    """Whether it was tried on hardware."""
    notes: str = Field("", json_schema_extra=INFORMATION)

    @model_validator(mode="after")
    def _holds_what_it_pulls(self) -> Self:
        """Refuse a holder that is led round corners where the sheet may only be pulled."""
        if self.bed.pull and self.tools.host_offset:
            raise ValueError(
                "bed.pull is for machines that make up for the blade's offset themselves: a holder "
                "that is led round corners pushes the sheet"
            )
        return self
