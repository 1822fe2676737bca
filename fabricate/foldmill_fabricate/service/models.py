"""What goes over the wire, both ways: the same values for the service and for its client.

Lengths in mm, angles in degrees, times in s. An *id* of a pattern or plan is a digest of what it
was made from: the same request gives the same id, and no id is a path.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from foldmill.finding import Finding, Severity
from foldmill_fabricate.plan_options import PlanOptions

DIGEST = "^[0-9a-f]{64}$"
Digest = Annotated[str, Field(pattern=DIGEST)]
"""A SHA-256 in hexadecimal."""
Slug = Annotated[str, Field(min_length=1, max_length=100)]
"""The name of a family, a material or a machine."""


class Wire(BaseModel):
    """Base of requests and responses: frozen, closed, documented by attribute docstrings."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False
    )


class Problem(Wire):
    """An error, as RFC 9457 has it, in ``application/problem+json``."""

    model_config = ConfigDict(extra="allow")

    type: str
    """A name for programs, such as urn:foldmill:cannot-plan."""
    title: str
    """What kind of error it is, in a few words."""
    status: int
    detail: str
    """One sentence for people: what, where, by how much, what to do."""


class About(Wire):
    """What answers."""

    name: Literal["foldmill"] = "foldmill"
    version: str
    tokens: bool
    """Whether requests need a token."""
    scope: str
    """What this request's token allows: view, submit or operate."""


class Health(Wire):
    """Whether the service can work."""

    ok: bool
    computing: int
    """Pieces of work under way in other processes."""
    waiting: int
    """Pieces of work that wait for a process."""


class FamilyRow(Wire):
    """A family of patterns."""

    slug: str
    title: str
    presets: tuple[str, ...]
    owner: str
    """The distribution that offers it."""


class Family(FamilyRow):
    """A family with its parameters."""

    references: tuple[str, ...]
    parameters: dict[str, Any]
    """JSON schema of the parameters; ``x-unit`` beside every quantity."""
    values: dict[str, dict[str, Any]]
    """The parameters of each preset; those of "" are the defaults."""


class PresetRow(Wire):
    """A material or a machine."""

    slug: str
    title: str
    provenance: str
    """Where its values come from, and who tested them."""
    owner: str
    """The distribution that offers it; a preset of the user's own says so."""


class FieldRow(Wire):
    """One field of a preset, for people."""

    name: str
    """Dotted, such as half-cut.force."""
    value: str
    unit: str
    about: str
    source: str


class PresetPage(PresetRow):
    """A material or a machine with all its fields."""

    fields: tuple[FieldRow, ...]
    preset: dict[str, Any]
    """As its TOML file states it."""


class DesignRequest(Wire):
    """A design to be made."""

    family: Slug
    preset: Slug | None = None
    """Start from this preset, else from the family's defaults."""
    params: dict[str, Any] = Field(default_factory=dict)
    """Parameters that differ; what is stated replaces what was there, whole."""


_Ratio = Annotated[float, Field(gt=0, le=1e9)]


class Upload(Wire):
    """What a person says of a file that it does not say itself."""

    form: Literal["fold", "svg", "dxf", "cp", "opx"] = "fold"
    """What the file is."""
    planarise: bool = False
    """FOLD: mend lines that cross; other formats always are."""
    unit: Literal["mm", "cm", "m", "in", "pt", "px", "um", "nm"] | None = None
    """What a unit of the file is, whatever the file says."""
    scale: _Ratio | None = None
    """How many times as large as the file says; mm per unit where it says nothing."""
    width: _Ratio | None = None
    """mm: how wide the pattern is; scales it."""
    side: Literal["front", "back"] = "front"
    """Which face of the sheet the file shows."""
    mirror: bool = False
    """Whether it is a mirror image."""
    frame: int | None = Field(default=None, ge=0, le=10_000)
    """FOLD: the number of the frame that is the pattern."""
    by: Literal["auto", "layer", "colour"] = "auto"
    """Whether layers or colours say what lines are."""
    named: tuple[Annotated[str, Field(max_length=200)], ...] = Field(default=(), max_length=100)
    """NAME=LETTER: what a colour or layer means, as #ff8800=M; B M V F U C, or skip."""
    gap: _Ratio | None = None
    """mm within which ends of lines meet."""
    loose: Literal["refuse", "drop"] = "refuse"
    """What becomes of lines that end inside the sheet."""
    angles: Literal["degrees", "radians"] | None = None
    """FOLD: what its fold angles are in; else degrees."""


class Pattern(Wire):
    """A crease pattern that is kept."""

    id: Digest
    """SHA-256 of its FOLD file."""
    bytes: int
    title: str
    vertices: int
    edges: int
    faces: int
    creases: dict[str, int]
    """How many edges of each assignment: B M V F U C."""
    width: float
    height: float
    folded: tuple[float, float, float] | None
    """Extent of the folded form; None where none is known."""
    notes: tuple[str, ...]
    """What had to be supposed when it was read."""
    findings: tuple[Finding, ...]

    @property
    def has_errors(self) -> bool:
        """Whether it must not be made like this."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)


class Report(Wire):
    """What a check has found."""

    figures: dict[str, Any]
    findings: tuple[Finding, ...]


class Verification(Report):
    """Whether the programs of a plan are what was planned."""

    ok: bool


class PlanRequest(Wire):
    """A sheet to be planned, of a pattern that is kept or of a design."""

    pattern: Digest | None = None
    """Id of a pattern; either this or a design."""
    design: DesignRequest | None = None
    material: Slug
    machine: Slug
    options: PlanOptions = PlanOptions()
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


class ProgramRow(Wire):
    """A program of a sheet, and how far it is."""

    number: int
    """0, 1, 2 … in order of work"""
    name: str
    face: str
    state: str
    strokes: int
    certain: int
    """How many strokes are cut, by the machine's answers or a person's word."""
    doubtful: tuple[int, ...]
    """Numbers of strokes that may be cut, whole or in part: 1, 2, 3 …"""
    note: str
    """Why it ended as it did."""


class SheetPage(Wire):
    """A sheet of a job."""

    id: str
    """As it is written on the sheet."""
    begun: str
    """UTC, ISO 8601"""
    programs: tuple[ProgramRow, ...]


class PlotterStatus(Wire):
    """A plotter, and what it does now."""

    name: str
    port: str
    machine: str
    """slug of its profile"""
    at_work: bool
    """Whether anybody works on its jobs."""
    job: str
    """Id of the job that has it; empty for none."""
    state: str
    """Of that job; "free" where none has it."""
    note: str
    """Why the job stands so."""
    waiting: int
    """How many jobs wait for it."""
    sheet: SheetPage | None = None
    """The sheet that is worked on."""


class Priority(Wire):
    """A place in the queue."""

    priority: int = Field(ge=-1000, le=1000)
    """Jobs of higher priority are made first."""


class Nothing(Wire):
    """An empty body: what is wanted stands in the path."""
