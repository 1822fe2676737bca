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

    auto: bool = False
    """Whether columns and rows grow until no piece lies upon itself: a sheet that does not is left
    whole, one that does becomes as few pieces as possible."""
    columns: Count = Field(default=1, le=MOST)
    """Pieces along u; with auto or a sheet, the fewest of them."""
    rows: Count = Field(default=1, le=MOST)
    """Pieces along v, each of whole strips; with auto or a sheet, the fewest of them."""
    sheet_width: Length | None = None
    """Where stated, columns and rows grow until every piece fits a sheet as wide as this, and lies
    flat."""
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
    def is_sought(self) -> bool:
        """Whether the number of pieces is looked for, from columns and rows on."""
        return self.auto or self.sheet is not None

    def is_whole(self, *, is_simple: bool) -> bool:
        """Tell whether a form is one sheet without tabs; is_simple : it does not lie upon itself.

        A sheet of a stated size is looked at in any case.
        """
        is_one = self.columns * self.rows == 1 and self.sheet is None and self.tabs == 0
        return is_one and (is_simple or not self.auto)
