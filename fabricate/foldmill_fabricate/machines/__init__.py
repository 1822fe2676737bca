"""Cutting plotters, as TOML presets and the model they are read into."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from foldmill_fabricate.presets import Preset
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
    carrier_width: Mm = Field(gt=0)
    carrier_height: Mm = Field(gt=0)
    """Size of the cutting mat that carries the blank; its lower left corner is the origin."""


class Axes(Preset):
    """From sheet coordinates on the carrier (x right, y up) to machine steps."""

    units_per_mm: StepsPerMm = Field(ge=1, le=10_000)
    swap: bool = False
    """Whether the machine calls y what the sheet calls x."""
    lowest: int = 0
    highest: int = 32767
    """Range of coordinates that the firmware accepts, steps."""


class Tools(Preset):
    """Which tool makes which line, and who changes it."""

    change: Literal["operator", "select"]
    """By an operator's hand between set-ups, or by SP from the program."""
    score: int = Field(ge=0)
    cut: int = Field(ge=0)
    """Number after SP; 0 where SP means nothing."""
    max_force: GramForce = Field(gt=0)
    trails: bool = True
    """Whether the tool follows the way and must be turned: a knife or wheel; not a pen or laser."""
    firmware_offset: bool = True
    """Whether the machine itself makes up for the blade's offset."""
    blade_offset: Mm = Field(0.25, ge=0)
    """From the holder's axis to the tip that trails it."""

    @property
    def host_offset(self) -> float:
        """The offset that programs make up for, mm; 0 where the machine does, or nothing trails."""
        return self.blade_offset if self.trails and not self.firmware_offset else 0.0


class Dialect(Preset):
    """How the machine wants its HP-GL."""

    preamble: str = "IN;DF;PA;"
    """Exactly one IN, in front: on some machines a second one cancels the job."""
    trailer: str = "PU;SP0;"
    speed: bool = True
    """Whether VS (cm/s) is understood."""
    force: bool = True
    """Whether FS (gf) is understood."""
    line_end: str = "\n"
    max_instruction: int = Field(240, ge=32)
    """Longest instruction, bytes."""


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
    handshake: Literal["none", "xon-xoff", "esc-b"]
    buffer: int = Field(1024, ge=64)
    """Bytes the machine holds before it overruns."""
    answers: bool = True
    """Whether it replies to OA, OE and ESC.B at all."""


class Machine(Preset):
    """A cutting plotter and its habits."""

    slug: str
    title: str
    language: Literal["hpgl"]
    bed: Bed
    axes: Axes
    tools: Tools
    dialect: Dialect
    motion: Motion
    serial: Serial
    mark_tolerance: Mm = Field(0.3, gt=0)
    """Largest residual of measured registration marks that is still believed."""
    repeatability: Mm = Field(0.15, ge=0)
    provenance: str
    verified: bool
    """Whether it was tried on hardware."""
