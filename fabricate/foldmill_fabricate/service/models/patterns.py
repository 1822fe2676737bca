"""Patterns: made from a design or a file, and what a check has found."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from foldmill.finding import Finding, Severity
from foldmill_fabricate.service.models.wire import Digest, Slug, Wire, example


class DesignRequest(Wire):
    """A design to be made."""

    model_config = example(
        {"family": "rotational", "preset": "star-n6"}, {"family": "waterbomb", "params": {}}
    )

    family: Slug
    """Which of `families` it is of."""
    preset: Slug | None = None
    """Start from this preset, else from the family's defaults."""
    params: dict[str, Any] = Field(default_factory=dict)
    """Parameters that differ; what is stated replaces what was there, whole."""


_Ratio = Annotated[float, Field(gt=0, le=1e9)]


class Upload(Wire):
    """What a person says of a file that it does not say itself."""

    form: Literal["fold", "svg", "dxf", "cp", "opx"] = "fold"
    """What the file is."""
    planarise: bool = False
    """FOLD: mend lines that cross; other formats always are."""
    unit: Literal["mm", "cm", "m", "in", "pt", "px", "um", "nm"] | None = None
    """What a unit of the file is, whatever the file says."""
    scale: _Ratio | None = None
    """How many times as large as the file says; mm per unit where it says nothing."""
    width: _Ratio | None = None
    """mm: how wide the pattern is; scales it."""
    side: Literal["front", "back"] = "front"
    """Which face of the sheet the file shows."""
    mirror: bool = False
    """Whether it is a mirror image."""
    frame: int | None = Field(default=None, ge=0, le=10_000)
    """FOLD: the number of the frame that is the pattern."""
    by: Literal["auto", "layer", "colour"] = "auto"
    """Whether layers or colours say what lines are."""
    named: tuple[Annotated[str, Field(max_length=200)], ...] = Field(default=(), max_length=100)
    """NAME=LETTER: what a colour or layer means, as #ff8800=M; B M V F U C, or skip."""
    gap: _Ratio | None = None
    """mm within which ends of lines meet."""
    loose: Literal["refuse", "drop"] = "refuse"
    """What becomes of lines that end inside the sheet."""
    angles: Literal["degrees", "radians"] | None = None
    """FOLD: what its fold angles are in; else degrees."""


class Pattern(Wire):
    """A crease pattern that is kept."""

    id: Digest
    """SHA-256 of its FOLD file."""
    bytes: int
    title: str
    vertices: int
    edges: int
    faces: int
    creases: dict[str, int]
    """How many edges of each assignment: B M V F U C."""
    width: float
    height: float
    folded: tuple[float, float, float] | None
    """Extent of the folded form; None where none is known."""
    notes: tuple[str, ...]
    """What had to be supposed when it was read."""
    findings: tuple[Finding, ...]

    @property
    def has_errors(self) -> bool:
        """Whether it must not be made like this."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)


class Report(Wire):
    """What a check has found."""

    figures: dict[str, Any]
    findings: tuple[Finding, ...]
