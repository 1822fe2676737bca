"""A drawing from elsewhere as it is ordered: what a person says of it, and the job folder made so.

Whoever hands one over says what its pens draw, on which material and machine; by that the terminal,
the queue of jobs and the service make the same folder of the same bytes.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from foldmill.errors import InvalidInput
from foldmill.finding import Severity
from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.foreign.plan import Use, plan_drawing, write_drawing
from foldmill_fabricate.foreign.read import read
from foldmill_fabricate.kinds import Kind
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.verify import verify_folder
from foldmill_fabricate.writers import require_writer, usual_formats

_NAME = r"^[^/\\\x00-\x1f\x7f-\x9f]+$"
_PEN = r"^[0-9]{1,2}=(score|inner|cut|skip)$"


def _like(pattern: str, sentence: str) -> AfterValidator:
    """Return a check of a word, with a sentence that a person understands."""

    def check(word: str) -> str:
        if not re.fullmatch(pattern, word):
            raise ValueError(sentence)
        return word

    return AfterValidator(check)


_Name = Annotated[
    str,
    Field(min_length=1, max_length=100, json_schema_extra={"pattern": _NAME}),
    _like(_NAME, "a drawing's name has no slashes and is no path."),
]
_Pen = Annotated[
    str,
    Field(max_length=12, json_schema_extra={"pattern": _PEN}),
    _like(_PEN, f"write PEN=USE, such as 1=cut; uses are {', '.join(Use)}."),
]
_Slug = Annotated[str, Field(min_length=1, max_length=100)]
_Side = Annotated[float, Field(gt=0, lt=1e5)]


class Asked(BaseModel):
    """What a person says of an HP-GL drawing; what is left out is as the presets have it."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False
    )
    name: _Name = "drawing.plt"
    """What the drawing is called in sentences and in the plan's title; never a path."""
    pen: tuple[_Pen, ...] = Field(default=(), max_length=100)
    """PEN=USE for each pen that draws, as 1=cut; uses are score, inner, cut and skip."""
    material: _Slug
    machine: _Slug
    score: Kind | None = None
    """How scores are made; by default the first the machine can do."""
    outline: Kind | None = None
    """How cuts are made; by default the first the machine can do."""
    blank: tuple[_Side, _Side] | None = None
    """Width and height, mm; by default the material's stock size."""
    carrier: tuple[_Side, _Side] | None = None
    """Width and height, mm; by default the machine's mat."""

    @property
    def uses(self) -> dict[int, Use]:
        """What each pen draws; raises InvalidInput where two things are said of one."""
        said = [each.partition("=") for each in self.pen]
        uses = {int(number): Use(use) for number, _, use in said}
        if len(uses) < len(said):
            raise InvalidInput("--pen says two things of one pen; say one.")
        return uses


def make_folder(
    data: bytes, asked: Asked, material: Material, machine: Machine, folder: Path
) -> Plan:
    """Write the job folder of a drawing and prove it; material, machine : those that are asked for.

    Raises UnreadableFile for what is not on the list of what is followed, CannotPlan and DoesNotFit
    as planning does, CannotSend where the proof fails.
    """
    require_writer(machine)
    drawing = read(data, asked.name)
    plan = plan_drawing(
        drawing,
        asked.uses,
        material,
        machine,
        score=asked.score,
        cut=asked.outline,
        blank=asked.blank,
        carrier=asked.carrier,
    )
    written = write_drawing(plan, folder, usual_formats(machine))
    _refuse_unproved(folder, asked.name)
    return written


def _refuse_unproved(folder: Path, name: str) -> None:
    found = verify_folder(folder).findings
    errors = [finding for finding in found if finding.severity is Severity.ERROR]
    if errors:
        raise CannotSend(f"What was made of {name} does not verify, and is not kept. {errors[0]}")
