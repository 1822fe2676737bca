"""How a sheet is planned: the options of `foldmill plan` as one value, for jobs and the service."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from foldmill.errors import InvalidInput
from foldmill.refusals import explain
from foldmill_fabricate.kinds import FlipKind, Kind, RegistrationKind, Unassigned

_MOST_MM = 1e5
_Side = Annotated[float, Field(gt=0, lt=_MOST_MM)]
_Count = Annotated[int, Field(ge=1, le=1000)]
_Celsius = Annotated[float, Field(ge=-50, le=150)]


class PlanOptions(BaseModel):
    """How a sheet is planned; what is left out is as the material and the machine have it."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False
    )

    blank: tuple[_Side, _Side] | None = None
    """Width and height, mm; by default the material's stock size."""
    carrier: tuple[_Side, _Side] | None = None
    """Width and height, mm; by default the machine's mat."""
    flip: FlipKind = "left-right"
    """About which axis the sheet is turned over."""
    unassigned: Unassigned | None = None
    """Where creases without mountain or valley are scored."""
    score: Kind | None = None
    """How creases are made; by default the first the machine can do."""
    outline: Kind | None = None
    """How the outline is made; by default the first the machine can do."""
    relief: Literal["none", "needed", "all"] = "none"
    """Which vertices get a hole in which grooves end."""
    copies: _Count = 1
    """How many of it lie on one sheet."""
    grid: tuple[_Count, _Count] | None = None
    """Columns and rows of copies, instead of ``copies``."""
    registration: RegistrationKind = "holes"
    """What keeps the faces in register."""
    temperatures: tuple[_Celsius, _Celsius] | None = None
    """°C of the sheet at the front pass and at the reverse pass."""

    def for_make(self) -> dict[str, Any]:
        """Return them by the names of ``plan.make``."""
        given = dict(self)
        given["cut"] = given.pop("outline")
        given["register"] = given.pop("registration")
        return given


def read_options(given: dict[str, Any]) -> PlanOptions:
    """Return options by their names; raises InvalidInput with a sentence."""
    try:
        return PlanOptions.model_validate(given)
    except ValidationError as error:
        raise InvalidInput(f"Options of planning: {explain(error, PlanOptions)}") from None
