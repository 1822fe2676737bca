"""Which stroke of a plan each stroke of the ledger is, and how it stands.

The ledger counts through a program whatever is drawn between the tool going down and up: lead-ins,
and the turns of a blade that is lifted out at corners, too. A plan's stroke is one of these, or
several where the blade was lifted out in between; with its repeats it is still one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.formats import programs
from foldmill_fabricate.passes import Face, Fit, Plan, ProgramFile, Role, SetUp, Stroke
from foldmill_fabricate.plotter.ledger import Record, SheetRecord
from foldmill_fabricate.toolpath.ways import NO_STROKE

EARLIER = -1
"""In place of a program's number: made before, while the sheet went by another id."""


class Standing(StrEnum):
    """How a stroke stands on a sheet."""

    CERTAIN = "certain"
    """cut, by the machine's answers or a person's word"""
    DOUBTFUL = "doubtful"
    """may be cut, whole or in part"""
    HALF = "half cut"
    """cut up to a vertex, as a person has said"""
    LEFT = "left"
    """no byte of it has left"""


@dataclass(frozen=True)
class Owner:
    """A stroke of a plan: its set-up, and its number, from 0, over that set-up's operations."""

    setup: int
    stroke: int


@dataclass(frozen=True)
class Account:
    """A stroke of a plan, and how it stands on a sheet."""

    face: Face
    setup: SetUp
    role: Role
    number: int
    """1, 2, 3 … over the operation's strokes."""
    stroke: Stroke
    program: int
    """Number of its program in the ledger."""
    standings: Mapping[int, Standing] = field(default_factory=dict)
    """Of each stroke of that program which it is made of; empty where it is shorter than a step."""

    @property
    def standing(self) -> Standing:
        """How the whole of it stands; doubtful where one part is cut and another is not."""
        found = {*self.standings.values()} or {Standing.CERTAIN}
        return found.pop() if len(found) == 1 else Standing.DOUBTFUL

    def __str__(self) -> str:
        return f"{self.role} stroke {self.number} of {self.setup.name}"


def owners(plan: Plan, part: ProgramFile, fit: Fit | None = None) -> list[Owner | None]:
    """Return of each stroke of a program, as the ledger counts, which stroke of the plan it is.

    None for lead-ins, and for turns of a blade that only rests on the sheet. fit : how the reverse
    lay when it was sent.
    """
    found: list[Owner | None] = []
    for face, setup in programs.chosen(plan, part.setups):
        ways = programs.ways(plan, face, setup, fit)
        for number, light in zip(ways.strokes, ways.light, strict=True):
            real = number != NO_STROKE and not light
            found.append(Owner(setup.number, number) if real else None)
    return found


def standings(record: Record) -> list[Standing]:
    """Return how each stroke of a program stands, as the ledger counts them."""
    certain, doubtful = {*record.certain}, {*record.doubtful}
    half = {run.first for run in record.runs if run.vertex}
    half |= {record.first} if record.vertex else set()

    def of(stroke: int) -> Standing:
        if stroke in certain:
            return Standing.CERTAIN
        if stroke in half:
            return Standing.HALF
        return Standing.DOUBTFUL if stroke in doubtful else Standing.LEFT

    return [of(stroke) for stroke in range(record.program.strokes)]


def accounts(plan: Plan, sheet: SheetRecord, fit: Fit | None = None) -> list[Account]:
    """Return every stroke of a plan and how it stands on a sheet, in order of work.

    fit : how the reverse lay. Raises CannotPlan for another job's sheet, and where the programs are
    not those that were sent.
    """
    refuse_other(plan, sheet)
    standing: dict[Owner, dict[int, Standing]] = {}
    program: dict[int, int] = {}
    for record, part in zip(sheet.records, plan.programs, strict=True):
        program |= dict.fromkeys(part.setups, record.number)
        for stroke, owner, stands in _counted(plan, part, record, fit):
            standing.setdefault(owner, {})[stroke] = stands
    return [
        Account(face, setup, role, number, stroke, program[owner.setup], standing.get(owner, {}))
        for face, setup, role, number, stroke, owner in _every(plan)
    ]


def refuse_other(plan: Plan, sheet: SheetRecord) -> None:
    """Raise CannotPlan for a sheet that was begun from another plan."""
    if sheet.job != plan.digest:
        raise CannotPlan(
            f"Sheet {sheet.id} is one of {sheet.title or 'another job'}, begun from another plan "
            "than this one. Name the folder that it was begun from."
        )


def _counted(
    plan: Plan, part: ProgramFile, record: Record, fit: Fit | None
) -> Iterator[tuple[int, Owner, Standing]]:
    found = owners(plan, part, fit)
    if len(found) != record.program.strokes:
        raise CannotPlan(
            f"{part.name} has {len(found)} strokes as it is written now, and had "
            f"{record.program.strokes} when the sheet was begun, so that nobody can tell which of "
            "them are cut. Give the marks that were measured then, or the folder as it was."
        )
    for stroke, (owner, stands) in enumerate(zip(found, standings(record), strict=True)):
        if owner is not None:
            yield stroke, owner, stands


def _every(plan: Plan) -> Iterator[tuple[Face, SetUp, Role, int, Stroke, Owner]]:
    for work in plan.passes:
        for setup in work.setups:
            count = 0
            for operation in setup.operations:
                for number, stroke in enumerate(operation.strokes, 1):
                    owner = Owner(setup.number, count)
                    yield work.face, setup, operation.role, number, stroke, owner
                    count += 1


def before(plan: Plan) -> Iterator[Account]:
    """Yield the strokes that were on a sheet when ``plan`` went on with it."""
    if plan.remakes is None:
        return
    yield from before(plan.remakes.origin)
    cut = {(one.setup, one.role, k) for one in plan.remakes.there for k in one.strokes}
    for face, setup, role, number, stroke, _ in _every(plan.remakes.origin):
        if (setup.number, role, number) in cut:
            yield Account(face, setup, role, number, stroke, EARLIER)


def in_doubt(sheet: SheetRecord, found: Sequence[Account]) -> dict[int, dict[int, Standing]]:
    """Return of each program, by its number, the strokes on which a person must speak."""
    open_: dict[int, dict[int, Standing]] = {record.number: {} for record in sheet.records}
    for account in found:
        for stroke, stands in account.standings.items():
            if stands in {Standing.DOUBTFUL, Standing.HALF}:
                open_[account.program][stroke] = stands
    return {number: strokes for number, strokes in open_.items() if strokes}
