"""Cutting plotters, as TOML presets and the model they are read into."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from foldmill_fabricate.materials.processes import Kind
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
    scale_x: Annotated[float, Field(ge=0.9, le=1.1)] = 1.0
    """What lengths along the sheet's x are multiplied with, because the machine makes them off."""
    scale_y: Annotated[float, Field(ge=0.9, le=1.1)] = 1.0
    """The same along y."""
    skew: Annotated[Deg, Field(ge=-5, le=5)] = 0.0
    """By how much a line along y is turned clockwise, because the machine leans it the other way.

    Scale and skew are applied last, to carrier coordinates: x' = scale_x·(x + y·tan skew),
    y' = scale_y·y.
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
    min_force: GramForce = Field(0.0, ge=0, json_schema_extra=INFORMATION)
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
        """Return what is set of a wanted force: no more than there is; 0 where none is set."""
        return 0.0 if self.max_force is None else min(wanted, self.max_force)


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
    line_end: str = "\n"
    """What stands after each instruction."""
    max_instruction: int = Field(240, ge=32)
    """Longest instruction, bytes."""
    second_in_cancels: bool = False
    """Whether an IN that arrives later cancels what the machine has not begun."""
    controls: Literal["hp-7475", "hp-7550"] = "hp-7475"
    """Which ESC sequences it knows; the HP 7550A has more."""


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
    handshake: Literal["none", "xon-xoff", "rts-cts", "dtr", "esc-b", "enq-ack"]
    """How the machine says that it has room: not at all, by XON and XOFF, by its RTS or DTR line,
    or when asked by ESC.B or ENQ.
    """
    buffer: int = Field(1024, ge=64)
    """Bytes the machine holds before it overruns."""
    answers: bool = True
    """Whether it replies to OA, OE and ESC.B at all."""


class Marks(Preset):
    """How the machine finds a sheet again."""

    kinds: tuple[Literal["holes", "edge", "pins", "l-marks-3", "l-marks-4", "two-target"], ...] = (
        Field(("holes", "edge"), json_schema_extra=INFORMATION)
    )
    """What it, or its operator, can find."""
    square: Mm = Field(0.0, ge=0, json_schema_extra=INFORMATION)
    """Side of the filled square of optical marks."""
    arm: Mm = Field(0.0, ge=0, json_schema_extra=INFORMATION)
    """Length of the arms of optical marks."""
    line_width: Mm = Field(0.0, ge=0, json_schema_extra=INFORMATION)
    """Width of their lines."""


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
    language: Literal["hpgl", "gp-gl", "gcode"]
    """Programs are written in HP-GL; of the others drawings are made."""
    bed: Bed
    axes: Axes
    tools: Tools
    dialect: Dialect = Field(default_factory=lambda: Dialect.model_validate({}))
    motion: Motion
    serial: Serial
    marks: Marks = Field(default_factory=lambda: Marks.model_validate({}))
    files: Files = Field(default_factory=lambda: Files.model_validate({}))
    mark_tolerance: Mm = Field(0.3, gt=0)
    """Largest residual of measured registration marks that is still believed."""
    repeatability: Mm = Field(0.15, ge=0, json_schema_extra=INFORMATION)
    """How far a line lands from where it landed before."""
    provenance: str
    """Where the values come from that name no source of their own."""
    verified: bool
    """Whether it was tried on hardware."""
    notes: str = Field("", json_schema_extra=INFORMATION)
