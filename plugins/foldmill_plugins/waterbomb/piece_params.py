"""What a user states of the pieces that a large or overlapping sheet is cut into."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from foldmill import Angle, Count, Length, Params

MOST = 50
"""Pieces along u, and along v."""
Width = Annotated[
    float, Field(ge=0, le=50, allow_inf_nan=False, json_schema_extra={"x-unit": "mm"})
]


class Pieces(Params):
    """One form from several sheets: each a design of its own, told by its number."""

    columns: Count = Field(default=1, le=MOST)
    """Pieces along u."""
    rows: Count = Field(default=1, le=MOST)
    """Pieces along v, each of whole strips."""
    sheet_width: Length | None = None
    """Where stated, columns and rows grow until every piece fits a sheet as wide as this."""
    sheet_height: Length | None = None
    """The same for the height; a piece may be turned."""
    piece: Count = Field(default=1, le=MOST * MOST)
    """Which piece this sheet is: 1 at the beginning of u and v, then along u, then along v."""
    tabs: Width = 0.0
    """Width of the glue tabs along all seams; 0 for none."""
    taper: Angle = Field(default=45.0, ge=0, le=80)
    """By how much the ends of a glue tab lean inwards."""
    notch: Width = 2.0
    """Width of the matching notches in both borders of a seam between pieces, 0 for none. There are
    as many as the seam's number, from its beginning on; each seam of a piece has another number."""

    @model_validator(mode="after")
    def _whole_sheet(self) -> Pieces:
        if (self.sheet_width is None) != (self.sheet_height is None):
            raise ValueError("state both sheet_width and sheet_height, or neither")
        return self

    @property
    def sheet(self) -> tuple[float, float] | None:
        """Width and height of the sheet every piece must fit, mm."""
        if self.sheet_width is None or self.sheet_height is None:
            return None
        return self.sheet_width, self.sheet_height

    @property
    def is_whole(self) -> bool:
        """Whether the form is one sheet without tabs."""
        return self.columns * self.rows == 1 and self.sheet is None and self.tabs == 0
