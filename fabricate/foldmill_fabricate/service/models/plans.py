"""Plans: what is asked for, how its making stands, what it is."""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field

from foldmill.finding import Finding
from foldmill_fabricate.plan_options import PlanOptions
from foldmill_fabricate.service.models.patterns import DesignRequest, Report
from foldmill_fabricate.service.models.wire import Digest, Slug, Wire, example


class Verification(Report):
    """Whether the programs of a plan are what was planned."""

    ok: bool


class PlanRequest(Wire):
    """A sheet to be planned, of a pattern that is kept or of a design."""

    model_config = example(
        {
            "design": {"family": "rotational", "preset": "star-n6"},
            "material": "pp-0.75",
            "machine": "generic-hpgl-600",
        }
    )

    pattern: Digest | None = None
    """Id of a pattern; either this or a design."""
    design: DesignRequest | None = None
    """A design to be made first; either this or a pattern."""
    material: Slug
    """Which of `materials` the sheet is of."""
    machine: Slug
    """Which of `machines` it is planned for."""
    options: PlanOptions = PlanOptions()
    """How it is planned, where not as the material and the machine have it."""
    formats: tuple[Slug, ...] | None = Field(None, min_length=1, max_length=20)
    """Files to write; by default svg, dxf and the machine's own programs."""
    profile: Slug = "foldmill"
    """Names and colours of the drawings' layers."""


class PlanState(StrEnum):
    """Where the making of a plan stands."""

    WAITING = "waiting"
    """It waits for a process, or is computed."""
    DONE = "done"
    REFUSED = "refused"
    """It cannot be made; ``detail`` says why."""
    INTERRUPTED = "interrupted"
    """The service ended meanwhile; send the request again."""


class FileRow(Wire):
    """A file of a plan."""

    name: str
    bytes: int
    sha256: str
    """As plan.json states it, for programs; empty for others."""


class PlanFigures(Wire):
    """How much work a plan is."""

    set_ups: int
    strokes: int
    drawn: float
    """mm with the tool down, repeats included"""
    travel: float
    """mm with the tool up"""
    seconds: float
    """of the machine, by its own speeds; without the operator's"""


class PlanStatus(Wire):
    """A plan, or how its making stands."""

    id: Digest
    state: PlanState
    detail: str = ""
    """A sentence, where it is refused or interrupted."""
    title: str = ""
    pattern: str = ""
    """Id of the pattern it is made from."""
    plan: str = ""
    """What a job is submitted with: the SHA-256 of what the plan says, once it is done."""
    material: str = ""
    machine: str = ""
    figures: PlanFigures | None = None
    findings: tuple[Finding, ...] = ()
    files: tuple[FileRow, ...] = ()


class KeptPlan(Wire):
    """A job folder that is kept, so that jobs can be made from it."""

    plan: Digest
    """What a job is submitted with."""
    title: str
    material: str
    machine: str
    figures: PlanFigures
    findings: tuple[Finding, ...]
    files: tuple[FileRow, ...]
