"""Sheet materials, as TOML presets and the model they are read into."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from foldmill_fabricate.presets import Preset
from foldmill_fabricate.units import Deg, GramForce, Mm, MmPerSecond


class Process(Preset):
    """How one kind of line is made in the material."""

    title: str
    exposure: Mm = Field(ge=0)
    """How far the blade stands out of its holder: it sets the depth."""
    force: GramForce = Field(ge=0)
    speed: MmPerSecond = Field(gt=0)
    repeats: int = Field(ge=1, le=20)
    """How often the knife goes over each stroke."""
    overcut: Mm = Field(0.0, ge=0)
    """How far a closed cut runs on past its start."""


class Score(Process):
    """How a crease is scored."""

    score_face: Literal["outside", "inside", "either"]
    """Which face of the fold carries the groove: a half-cut opens on the outside."""
    depth_ratio: float = Field(gt=0, lt=1)
    """Depth of the groove as a share of the thickness."""
    depth_ratio_min: float = Field(gt=0, lt=1)
    depth_ratio_max: float = Field(gt=0, lt=1)
    web_min: Mm = Field(gt=0)
    """The least material that must remain under a groove, or between two."""
    setback: Mm = Field(ge=0)
    """How far scores stop short of a vertex where creases meet."""
    min_spacing: Mm = Field(ge=0)
    """Least distance of parallel scores on one face."""
    min_scored_angle: Deg = Field(0.0, ge=0)
    """Creases that fold by less are not scored."""


class Cut(Process):
    """How the sheet is cut through."""

    force_needed: GramForce = Field(ge=0)
    """Force below which a machine does not get through reliably."""
    tie_width: Mm = Field(gt=0)
    tie_pitch: Mm = Field(gt=0)
    tie_corner: Mm = Field(ge=0)
    """Least distance of a tie from a corner."""
    swivel_force: GramForce = Field(0.0, ge=0)
    """Force at which a drag knife is lifted out and turned at sharp corners: thick sheets break its
    tip. 0: it is turned in the material."""


class Holes(Preset):
    """Registration holes in the waste."""

    diameter: Mm = Field(gt=0)
    part_clearance: Mm = Field(ge=0)
    """Least distance from a hole's rim to the part."""
    edge_clearance: Mm = Field(ge=0)
    """Least distance from a hole's rim to the edge of the blank."""


class Material(Preset):
    """A sheet of something that can be scored and folded."""

    slug: str
    title: str
    thickness: Mm = Field(gt=0)
    stock_width: Mm = Field(gt=0)
    stock_height: Mm = Field(gt=0)
    part_clearance: Mm = Field(ge=0)
    """Least distance of the part from the edge of the blank."""
    min_feature: Mm = Field(ge=0)
    """Shortest facet edge that can be folded well."""
    expansion: float = Field(ge=0, json_schema_extra={"x-unit": "1e-6/K"})
    score: Score
    cut: Cut
    holes: Holes
    provenance: str
    """Where the values come from, and who tested them; "untested" until a coupon was read."""
    tested: bool

    @property
    def web(self) -> float:
        """Material left under a groove of the preset's depth, mm."""
        return self.thickness * (1 - self.score.depth_ratio)
