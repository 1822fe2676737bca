"""How one kind of line is made in a material: eight processes, each with the fields it needs.

Terminology: a *web* is what a groove leaves of the sheet; a *land* is what a perforation leaves
whole between its cuts and at its ends; to *snap* is to bend a deep groove until the sheet parts.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from foldmill_fabricate.presets import Preset
from foldmill_fabricate.units import Deg, GramForce, Mm, MmPerSecond

ScoreFace = Literal["outside", "inside", "either"]


class Process(Preset):
    """What every process has: the tool's depth, force, speed and repeats."""

    title: str
    exposure: Mm = Field(ge=0)
    """How far the blade stands out of its holder: it sets the depth. 0 for a tip without a blade.
    """
    force: GramForce = Field(ge=0)
    """Force to set; a machine that has less is set to what it has."""
    force_needed: GramForce = Field(0.0, ge=0)
    """Force below which it does not work reliably."""
    speed: MmPerSecond = Field(gt=0)
    repeats: int = Field(ge=1, le=20)
    """How often the tool goes over each stroke."""
    overcut: Mm = Field(0.0, ge=0)
    """How far a closed cut runs on past its start."""
    blade_angle: Deg | None = Field(None, gt=0, lt=90)
    """Angle of the blade's edge to the sheet: 45 for thin sheets, 60 for thick ones; said to the
    operator. None where no blade is used."""
    limited_by: Literal["exposure", "force", "z"] = "exposure"
    """What keeps the tool from going deeper; said to the operator."""


class Score(Process):
    """What every process has that makes a crease."""

    score_face: ScoreFace
    """Which face of the fold carries the groove."""
    setback: Mm = Field(ge=0)
    """How far scores stop short of a vertex where creases meet."""
    min_spacing: Mm = Field(ge=0)
    """Least distance of parallel scores on one face."""
    min_scored_angle: Deg = Field(0.0, ge=0)
    """Creases that fold by less are not scored."""
    web_min: Mm = Field(0.0, ge=0)
    """The least material that must remain under a groove, or between two; 0 where the tool takes
    nothing away."""

    @property
    def remains(self) -> float:
        """Share of the thickness that is left under the score."""
        return 1.0


class _Groove(Score):
    """A score with a depth."""

    depth_ratio: float = Field(gt=0, lt=1)
    """Depth of the groove as a share of the thickness."""
    depth_ratio_min: float = Field(gt=0, lt=1)
    """Shallower, and the fold wanders off the groove."""
    depth_ratio_max: float = Field(gt=0, lt=1)
    """Deeper, and the fold tears."""


class HalfCut(_Groove):
    """A slit of part of the thickness: it opens on the outside of the fold."""

    kind: Literal["half-cut"] = "half-cut"
    score_face: ScoreFace = "outside"
    """Which face of the fold it is made on."""

    @property
    def remains(self) -> float:
        """Share of the thickness that is left under the score."""
        return 1 - self.depth_ratio


class VScore(_Groove):
    """A groove cut out of the sheet: it closes like a mitre on the inside of the fold."""

    kind: Literal["v-score"] = "v-score"
    score_face: ScoreFace = "inside"
    """Which face of the fold it is made on."""

    @property
    def remains(self) -> float:
        """Share of the thickness that is left under the score."""
        return 1 - self.depth_ratio


class CreaseWheel(_Groove):
    """A groove pressed into a channel: groove outside, bead inside. Nothing is taken away."""

    kind: Literal["crease-wheel"] = "crease-wheel"
    score_face: ScoreFace = "outside"
    """Which face of the fold it is made on."""


class Stylus(_Groove):
    """A line pressed by a round tip without a channel: it lies on the inside of the fold."""

    kind: Literal["stylus"] = "stylus"
    score_face: ScoreFace = "inside"
    """Which face of the fold it is made on."""


class Perforation(Score):
    """A row of cuts through the sheet, done once, from the reverse."""

    kind: Literal["perforation"] = "perforation"
    score_face: ScoreFace = "either"
    """Which face of the fold it is made on."""
    cut: Mm = Field(gt=0)
    """Length of one cut."""
    gap: Mm = Field(gt=0)
    """Length of the land between two cuts."""
    setback: Mm = Field(gt=0)
    """Least land at both ends of a row."""


class PenLine(Score):
    """A drawn line that is creased by hand."""

    kind: Literal["pen"] = "pen"
    score_face: ScoreFace = "either"
    """Which face of the fold it is made on."""


class Cut(Process):
    """What every process has that parts the sheet."""

    swivel_force: GramForce = Field(0.0, ge=0)
    """Force at which a drag knife is lifted out and turned at sharp corners: thick sheets break its
    tip. 0: it is turned in the material."""

    @property
    def goes_through(self) -> bool:
        """Whether the machine itself parts the sheet: only then are ties needed, and holes made."""
        return False


class ThroughCut(Cut):
    """A cut through the whole thickness; the part hangs on ties."""

    kind: Literal["through-cut"] = "through-cut"
    force_least: GramForce = Field(0.0, ge=0)
    """Force below which it is not even tried."""
    tie_width: Mm = Field(gt=0)
    """Length of a tie along the outline."""
    tie_pitch: Mm = Field(gt=0)
    """Distance of ties along the outline, about."""
    tie_corner: Mm = Field(ge=0)
    """Least distance of a tie from a corner."""

    @property
    def goes_through(self) -> bool:
        """Whether the machine itself parts the sheet."""
        return True


class ScoreAndSnap(Cut):
    """A deep groove along the outline; the waste is snapped off along it by hand."""

    kind: Literal["score-and-snap"] = "score-and-snap"
    web: Mm = Field(gt=0)
    """What the groove leaves."""


class PenOutline(Cut):
    """A drawn outline that is cut by hand."""

    known_as: ClassVar[str] = "pen-outline"
    """Its name among the fields of a preset, beside the pen's creases."""
    kind: Literal["pen"] = "pen"


AnyScore = Annotated[
    HalfCut | CreaseWheel | Stylus | Perforation | VScore | PenLine, Field(discriminator="kind")
]
AnyCut = Annotated[ThroughCut | ScoreAndSnap | PenOutline, Field(discriminator="kind")]
