"""What a command's options offer: their choices, their help, and values that people write."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from foldmill import FoldmillError


class FlipChoice(StrEnum):
    """How the operator turns the sheet over."""

    LEFT_RIGHT = "left-right"
    END_OVER_END = "end-over-end"


class DxfChoice(StrEnum):
    """Which DXF drawings are written in."""

    R2000 = "r2000"
    R12 = "r12"


class UnassignedChoice(StrEnum):
    """Where creases without mountain or valley are scored."""

    FRONT = "front"
    REVERSE = "reverse"
    SKIP = "skip"


class ReliefChoice(StrEnum):
    """Which vertices get a hole."""

    NONE = "none"
    NEEDED = "needed"
    ALL = "all"


class RegistrationChoice(StrEnum):
    """What keeps the reverse in register with the front."""

    HOLES = "holes"
    L_MARKS = "l-marks"
    EDGE = "edge"
    PINS = "pins"
    NONE = "none"


class ProcessChoice(StrEnum):
    """How a line is made."""

    HALF_CUT = "half-cut"
    CREASE_WHEEL = "crease-wheel"
    STYLUS = "stylus"
    PERFORATION = "perforation"
    V_SCORE = "v-score"
    THROUGH_CUT = "through-cut"
    SCORE_AND_SNAP = "score-and-snap"
    PEN = "pen"


MaterialSlug = Annotated[str, typer.Option(help="A slug of `foldmill materials`.")]
MachineSlug = Annotated[str, typer.Option(help="A slug of `foldmill machines`.")]
BlankSize = Annotated[
    str | None, typer.Option(help="WIDTHxHEIGHT in mm; default: the material's stock size.")
]
CarrierSize = Annotated[
    str | None, typer.Option(help="WIDTHxHEIGHT in mm; default: the machine's mat.")
]
FlipKind = Annotated[FlipChoice, typer.Option(help="How the sheet is turned over.")]
ScoreProcess = Annotated[
    ProcessChoice | None,
    typer.Option(help="How creases are made; default: the first the machine can do."),
]
Formats = Annotated[
    str | None,
    typer.Option(help="Formats, separated by commas; default: svg,dxf and the machine's own."),
]
Folder = Annotated[Path, typer.Argument(help="A job folder, as `foldmill plan` writes it.")]


def size(text: str, option: str) -> tuple[float, float]:
    """Read WIDTHxHEIGHT in mm."""
    width, _, height = text.lower().replace("×", "x").partition("x")
    try:
        read = float(width), float(height)
    except ValueError:
        raise FoldmillError(
            f"{option}: write WIDTHxHEIGHT in mm, as 500x500; not {text!r}."
        ) from None
    if not (0 < read[0] < 1e5 and 0 < read[1] < 1e5):
        raise FoldmillError(f"{option}: both sides must be positive and below 100 m, not {text!r}.")
    return read


def counts(text: str, option: str) -> tuple[int, int]:
    """Read COLUMNSxROWS, both at least one."""
    columns, _, rows = text.lower().replace("×", "x").partition("x")
    if not (columns.isdecimal() and rows.isdecimal() and int(columns) and int(rows)):
        raise FoldmillError(f"{option}: write COLUMNSxROWS, as 3x2; not {text!r}.")
    return int(columns), int(rows)


def temperatures(text: str) -> tuple[float, float]:
    """Read FRONT,REVERSE in °C."""
    front, _, reverse = text.partition(",")
    try:
        read = float(front), float(reverse)
    except ValueError:
        raise FoldmillError(
            f"--temperature: write FRONT,REVERSE in °C, as 21,24; not {text!r}."
        ) from None
    if not all(-50 <= each <= 150 for each in read):
        raise FoldmillError(f"--temperature: a sheet has -50 to 150 °C, not {text!r}.")
    return read
