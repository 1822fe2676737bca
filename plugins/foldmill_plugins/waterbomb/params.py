"""What a user states of a waterbomb tessellation."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from foldmill import Count, Length, Params
from foldmill_plugins.waterbomb.expression_surface import ExpressionSurface
from foldmill_plugins.waterbomb.height_field import HeightField
from foldmill_plugins.waterbomb.mesh_surface import MeshSurface
from foldmill_plugins.waterbomb.options import FitOptions, Wanted
from foldmill_plugins.waterbomb.piece_params import Pieces
from foldmill_plugins.waterbomb.surfaces import TABLE, Surface

Name = Literal[
    "catenoid", "sphere", "cylinder", "vase", "torus", "hyperbolic-paraboloid", "moebius"
]
Ratio = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
"""A share of something, from 0 to 1."""

MOST_BASES = 100_000
"""Bases of one sheet. The largest that anybody measured has 50,000."""
SHALLOWEST = 0.05
"""Depth in cells below which centres are nearly planar, so that their angle sums say nothing."""
DEEPEST_SLIDE = 0.5
"""Slide at which the mids of one strip meet in its middle."""


class TableSurface(Params):
    """One of the surfaces of Table 6.2."""

    kind: Name = "catenoid"
    """Which surface; each is as long and as wide as in the table."""

    def surface(self) -> Surface:
        """Return the surface."""
        return TABLE[self.kind]


AnySurface = Annotated[
    TableSurface | ExpressionSurface | HeightField | MeshSurface, Field(discriminator="kind")
]
"""Every kind of target, told apart by its ``kind``."""


def _deep_enough(depth: float | None) -> float | None:
    if depth is not None and depth < SHALLOWEST:
        raise ValueError(
            f"centres must be at least {SHALLOWEST} cells deep: nearly flat bases do not say which "
            "way they fold"
        )
    return depth


def _apart(slide: float | None) -> float | None:
    if slide is not None and slide >= DEEPEST_SLIDE:
        raise ValueError(
            f"mids must slide by less than {DEEPEST_SLIDE}: there the two mids of a base meet"
        )
    return slide


Depth = Annotated[Ratio | None, AfterValidator(_deep_enough)]
Slide = Annotated[Ratio | None, AfterValidator(_apart)]


class WaterbombParams(Params):
    """A target, how many bases, how the base mesh is made, and how large the sheet is."""

    surface: AnySurface = Field(default_factory=TableSurface)
    """The target surface."""
    n_u: Count = 8
    """Bases in one strip, along u."""
    n_v: Count = 6
    """Strips, along v. A torus closes along v only where it is even."""
    start: Literal["auto", "closed-form", "flat-metric", "uniform"] = "auto"
    """How deep each base is before the search: so that a surface of revolution unfolds to a
    constant width (closed-form), so that the folded metric is flat (flat-metric), or alike
    everywhere (uniform). auto takes the first of them that promises success."""
    depth: Depth = None
    """Depth of the bases' centres, in sides of a cell: of the widest cell for closed-form, a wish
    for flat-metric, of each for uniform. Left out: 0.3, for uniform 0.5; with start auto the
    nearest depth that does where that one folds the wrong way or passes through itself."""
    slide: Slide = None
    """Slide of the mids towards the middle of their base, in heights of a cell. Left out: what the
    depth asks for, for uniform 0.25."""
    lift: Ratio = 0.0
    """By how much the other vertices are raised off the target, away from the centres, in sides of
    a cell."""
    side: Literal["inner", "outer"] = "inner"
    """On which side of the target the centres are; for an open sheet the inner side is that from
    which the normal P_u × P_v points away."""
    boundary: Literal["free", "fixed"] = "free"
    """Whether the vertices of the boundary move in the search."""
    rim: Literal["inside", "outside"] = "inside"
    """Whether the first and the last ring slide within the range of v only, or beyond it too."""
    flat_foldable: bool = False
    """Whether every vertex must be able to fold flat by itself: every other angle adds up to 180°.
    Tessellations round an axis are so anyhow."""
    fit: FitOptions = Field(default_factory=FitOptions)
    """How the form is brought closer to the target once it is developable."""
    wanted: Wanted = Field(default_factory=Wanted)
    """What the report on density chooses n_u and n_v for; the form itself does not depend on it."""
    size: Length = Field(default=400.0, ge=10, le=10_000)
    """Size of what `sized` says."""
    sized: Literal["sheet", "width", "height", "unit"] = "sheet"
    """What is as long as `size`: the larger side of the flat sheet, its width, its height, or one
    unit of the target."""
    pieces: Pieces = Field(default_factory=Pieces)
    """Into how many sheets the form is cut, and which of them this is."""

    @model_validator(mode="after")
    def _few_enough(self) -> WaterbombParams:
        if self.n_u * self.n_v > MOST_BASES:
            raise ValueError(
                f"n_u · n_v = {self.n_u * self.n_v} bases are more than {MOST_BASES}; take fewer"
            )
        return self

    @model_validator(mode="after")
    def _suits(self) -> WaterbombParams:
        if self.start == "closed-form" and not self.surface.surface().is_revolution:
            raise ValueError(
                f"start: closed-form needs a surface of revolution, and {self.surface.kind} is "
                "none; take flat-metric"
            )
        return self
