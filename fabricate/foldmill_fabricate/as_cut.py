"""A sheet as it is cut by now: on each face what is certain, what is doubtful, what is left.

It follows from the programs that were begun, read by verification's own interpreters, and from the
ledger's word on each stroke: it shows what was done and not what was planned, and a later version
of the planner or the writers changes nothing of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from foldmill import installed
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.hooks import INTERPRETERS, Interpreter
from foldmill_fabricate.passes import Face, Plan, ProgramFile
from foldmill_fabricate.plotter.ledger import Record, SheetRecord
from foldmill_fabricate.remaking.strokes import Standing, before, refuse_other, standings
from foldmill_fabricate.verify.virtual_sheet import on_carrier, on_sheet, turned_over

Floats = NDArray[np.float64]


class Kind(StrEnum):
    """How a stroke stands; in order of drawing: what matters lies on top."""

    LEFT = "left"
    CERTAIN = "certain"
    DOUBTFUL = "doubtful"


_KINDS = {
    Standing.LEFT: Kind.LEFT,
    Standing.CERTAIN: Kind.CERTAIN,
    Standing.DOUBTFUL: Kind.DOUBTFUL,
    Standing.HALF: Kind.DOUBTFUL,
}


@dataclass(frozen=True, eq=False)
class Line:
    """A stroke on a face."""

    kind: Kind
    points: Floats
    """(n, 2) mm of the blank, as one looks at that face; repeats left out."""
    program: str = ""
    """Empty where it was cut before, while the sheet went by another id."""
    number: int = 0
    """1, 2, 3 … in its program: by what a person names it."""


@dataclass(frozen=True, eq=False)
class FaceAsCut:
    """A face of a sheet, as one looks at it."""

    face: Face
    width: float
    """mm of the blank"""
    height: float
    lines: tuple[Line, ...]

    def of(self, kind: Kind) -> list[Line]:
        """Return the strokes that stand so."""
        return [line for line in self.lines if line.kind is kind]


def as_cut(plan: Plan, programs: Mapping[str, bytes], sheet: SheetRecord) -> tuple[FaceAsCut, ...]:
    """Return the faces of a sheet that anything is, or was, to be done to.

    programs : by their names, as they lie beside the plan. Raises CannotPlan for another job's
    sheet, and for programs that are not those that were begun.
    """
    refuse_other(plan, sheet)
    lines: dict[Face, list[Line]] = {face: [] for face in Face}
    for account in before(plan):
        way = np.asarray(account.stroke.points, float)
        lines[account.face].append(Line(Kind.CERTAIN, _seen(way, plan, account.face)))
    for record, part in zip(sheet.records, plan.programs, strict=True):
        lines[part.face] += _drawn(plan, part, programs[part.name], record)
    size = plan.sheet.width, plan.sheet.height
    return tuple(FaceAsCut(face, *size, tuple(found)) for face, found in lines.items() if found)


def _drawn(plan: Plan, part: ProgramFile, program: bytes, record: Record) -> Iterator[Line]:
    """Yield the strokes of a program in its order, each as the ledger has it."""
    machine = plan.machine
    reader: Interpreter = installed().get(INTERPRETERS, "interpreter", machine.language)
    runs = reader.replay(program, part.name, machine).runs
    stand = standings(record)
    if len(runs) != len(stand):
        raise CannotPlan(
            f"{part.name} has {len(runs)} strokes, and had {len(stand)} when sheet {record.sheet} "
            "was begun: it was written anew since. Name the folder as it was."
        )
    for number, (run, standing) in enumerate(zip(runs, stand, strict=True), 1):
        way = on_sheet(on_carrier(_once(run.points), machine.axes), plan, part.face, None)
        yield Line(_KINDS[standing], _seen(way, plan, part.face), part.name, number)


def _once(steps: Floats) -> Floats:
    """Return a line up to where the tool goes over it again: repeats are nothing to be seen."""
    known: set[tuple[tuple[float, ...], tuple[float, ...]]] = set()
    for k, (a, b) in enumerate(pairwise(map(tuple, np.asarray(steps).tolist()))):
        if {(a, b), (b, a)} & known:
            return np.asarray(steps[: k + 1], float)
        known.add((a, b))
    return np.asarray(steps, float)


def _seen(way: Floats, plan: Plan, face: Face) -> Floats:
    """Return a line of the sheet, mm seen from the front, as one looks at a face of it."""
    return turned_over(way, plan.flip) if face is Face.REVERSE else way
