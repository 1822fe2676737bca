"""Sheet materials, as TOML presets and the model they are read into."""

from __future__ import annotations

from typing import Self

from pydantic import Field, model_validator

from foldmill_fabricate.materials.processes import (
    AnyCut,
    AnyScore,
    CreaseWheel,
    Cut,
    HalfCut,
    PenLine,
    PenOutline,
    Perforation,
    Process,
    Score,
    ScoreAndSnap,
    Stylus,
    ThroughCut,
    VScore,
)
from foldmill_fabricate.presets import INFORMATION, Preset, Sourced
from foldmill_fabricate.units import Celsius, Deg, Gigapascal, GramsPerCm3, Mm, PerMillionKelvin

__all__ = [
    "CreaseWheel",
    "Cut",
    "HalfCut",
    "Holes",
    "Material",
    "PenLine",
    "PenOutline",
    "Perforation",
    "Process",
    "Score",
    "ScoreAndSnap",
    "Stylus",
    "ThroughCut",
    "VScore",
]


class Holes(Preset):
    """Registration holes in the waste."""

    diameter: Mm = Field(gt=0)
    part_clearance: Mm = Field(ge=0)
    """Least distance from a hole's rim to the part."""
    edge_clearance: Mm = Field(ge=0)
    """Least distance from a hole's rim to the edge of the blank."""


class Material(Sourced):
    """A sheet of something that can be scored and folded."""

    slug: str
    title: str
    thickness: Mm = Field(gt=0)
    """Measured, not as sold."""
    stock_width: Mm = Field(gt=0)
    stock_height: Mm = Field(gt=0)
    part_clearance: Mm = Field(ge=0)
    """Least distance of the part from the edge of the blank."""
    min_feature: Mm = Field(ge=0)
    """Shortest facet edge that can be folded well."""
    min_flap: Mm = Field(ge=0)
    """Least width of a facet that stands free at the outline."""
    relief_diameter: Mm = Field(ge=0)
    """Least diameter of a relief hole at a vertex; 0 leaves it to the thickness alone."""
    density: GramsPerCm3 = Field(gt=0)
    e_modulus: Gigapascal = Field(gt=0, json_schema_extra=INFORMATION)
    """Stiffness."""
    expansion: PerMillionKelvin = Field(ge=0)
    """How much it grows with temperature."""
    directional: bool
    """Whether it has a grain or a direction of extrusion."""
    layer_clearance: Mm = Field(ge=0, json_schema_extra=INFORMATION)
    """Air left between layers that are folded over each other."""
    max_layers: int = Field(ge=1, json_schema_extra=INFORMATION)
    """Most layers that can lie in one fold."""
    min_fold_temperature: Celsius | None = None
    """Below this it cracks when folded."""
    springback_min: Deg = Field(0.0, ge=0)
    """How far a fold opens again, at least."""
    springback_max: Deg = Field(0.0, ge=0)
    """How far a fold opens again, at most."""
    score: AnyScore
    """The process creases are made by: in a preset the one preferred, in a plan the one used."""
    other_scores: tuple[AnyScore, ...] = ()
    """What takes its place on machines that do not offer it, in order of preference."""
    cut: AnyCut
    """The process outlines are made by."""
    other_cuts: tuple[AnyCut, ...] = ()
    """What takes its place on machines that do not offer it, in order of preference."""
    holes: Holes
    provenance: str = Field(min_length=1)
    """Where the values come from, and who tested them; "untested" until a coupon was read."""
    tested: bool
    """Whether a coupon of it was cut, read and recorded."""
    tested_by: str = Field("", json_schema_extra=INFORMATION)
    """Who read the coupon."""
    tested_on: str = Field("", json_schema_extra=INFORMATION)
    """When, as YYYY-MM-DD."""
    notes: str = Field("", json_schema_extra=INFORMATION)

    @property
    def web(self) -> float:
        """Material left under a groove of the preset's depth, mm."""
        return self.thickness * self.score.remains

    @property
    def scores(self) -> tuple[AnyScore, ...]:
        """Every way to crease it, the preferred one first."""
        return (self.score, *self.other_scores)

    @property
    def cuts(self) -> tuple[AnyCut, ...]:
        """Every way to part it, the preferred one first."""
        return (self.cut, *self.other_cuts)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        for offered in (self.scores, self.cuts):
            kinds = [process.kind for process in offered]
            twice = {kind for kind in kinds if kinds.count(kind) > 1}
            if twice:
                raise ValueError(f"{', '.join(sorted(twice))} is described more than once")
        if self.springback_max < self.springback_min:
            raise ValueError("springback_max must be at least springback_min")
        return self
