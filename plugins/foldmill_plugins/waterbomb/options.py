"""What a user states of a fit, and of how many bases there should be."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from foldmill import Angle, Count, Length, Params

Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
"""A share of something, from 0 to 1."""


class FitOptions(Params):
    """How a form that is developable is brought closer to its target."""

    on: bool = False
    """Whether the form is brought closer to the target."""
    lowest: Angle = Field(default=20.0, ge=0, le=90)
    """Least fold of a crease; less folded lets the form come closer. It gives way by about 1°."""
    highest: Angle = Field(default=165.0, ge=90, le=179)
    """Greatest fold of a crease; facets folded farther come to pass through each other."""
    tangential: Share = 0.1
    """Weight of staying where a vertex was along the target; that of coming close is 1."""
    rim: Share = 0.5
    """The same weight for vertices of the boundary, so that the form stays as long as it was."""
    altitude: Share = 0.22
    """Least altitude of a facet, in edges of mean length, against slivers."""
    boundary: Literal["free", "fixed"] = "free"
    """Whether the vertices of the boundary move in the fit, whatever they did before."""
    iterations: Annotated[Count, Field(le=1000)] = 150
    """Most steps of the fit; it ends before where they win nothing."""

    @model_validator(mode="after")
    def _has_room(self) -> FitOptions:
        if self.highest - self.lowest < 30:
            raise ValueError(
                f"folds need room of 30° at least between lowest and highest, not "
                f"{self.highest - self.lowest:g}°: the creases of a base fold differently"
            )
        return self


class Wanted(Params):
    """What the number of bases is to be chosen for, by the report on density."""

    distance: Annotated[float | None, Field(gt=0, le=1, allow_inf_nan=False)] = None
    """Mean distance of the vertices from the target, as a share of its diagonal: the fewest bases
    that come as close are looked for."""
    sheet_width: Length | None = None
    """Width of the sheet that the flat pattern must fit on, either way round."""
    sheet_height: Length | None = None
    """Height of that sheet; left out: as its width."""
    smallest: Length | None = None
    """Least altitude of a facet on that sheet: the most bases that keep it are looked for."""
    most_bases: Annotated[Count, Field(le=20_000)] = 2_000
    """Bases beyond which nothing is looked for."""

    @model_validator(mode="after")
    def _is_whole(self) -> Wanted:
        if (self.smallest is None) != (self.sheet_width is None):
            raise ValueError(
                "smallest and sheet_width belong together: how small a facet becomes depends on "
                "the sheet"
            )
        return self
