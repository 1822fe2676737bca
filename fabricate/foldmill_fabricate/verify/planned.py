"""The plan as verification reads it: every stroke by itself, and which program must draw it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Face, Operation, Plan, ProgramFile, Role, SetUp
from foldmill_fabricate.verify.cover import Stretches, stretches

Floats = NDArray[np.float64]


_SUFFIX_OF = {"hpgl": ".hpgl", "gp-gl": ".gpgl", "gcode": ".nc"}
SUFFIXES = tuple(_SUFFIX_OF.values())
"""What the names of programs end with."""


@dataclass(frozen=True, eq=False)
class Planned:
    """One stroke of the plan and what is to be done along it."""

    points: Floats
    """(n, 2) mm, sheet coordinates."""
    closed: bool
    face: Face
    setup: SetUp
    operation: Operation
    number: int
    """1, 2, 3 … over the operation's strokes."""
    rank: int
    """0, 1, 2 … over the operations of the whole job."""
    piece: int = 0
    """Which copy it is said to belong to; 0 for none."""

    @property
    def role(self) -> Role:
        """What it is for."""
        return self.operation.role

    @cached_property
    def length(self) -> float:
        """Once along it, mm."""
        return float(np.hypot(*(self.points[1:] - self.points[:-1]).T).sum())

    @property
    def overcut(self) -> float:
        """How far it goes on past its start, mm."""
        return min(self.operation.overcut, self.length) if self.closed else 0.0

    def __str__(self) -> str:
        return f"{self.role} stroke {self.number} of set-up {self.setup.number}"


def planned(plan: Plan) -> list[Planned]:
    """Return every stroke in order of work."""
    found: list[Planned] = []
    rank = 0
    for side in plan.passes:
        for setup in side.setups:
            for operation in setup.operations:
                found += [
                    Planned(
                        np.asarray(stroke.points, float),
                        len(stroke.points) > 3 and stroke.points[0] == stroke.points[-1],
                        side.face,
                        setup,
                        operation,
                        number,
                        rank,
                        stroke.piece,
                    )
                    for number, stroke in enumerate(operation.strokes, 1)
                ]
                rank += 1
    return found


def wanted_counts(strokes: Iterable[Planned]) -> Stretches:
    """Return how often each stroke is to be passed: its repeats, once more over the overcut."""
    items: list[tuple[int, float, float, float]] = []
    for k, stroke in enumerate(strokes):
        items.append((k, 0.0, stroke.length, float(stroke.operation.repeats)))
        items.append((k, 0.0, stroke.overcut, 1.0))
    return stretches(items)


def program_files(plan: Plan) -> tuple[ProgramFile, ...]:
    """Return the plan's record of its programs, or what it would be where none was made yet.

    One per set-up where an operator changes tools, else one per face; without a record, no hash.
    """
    if plan.programs:
        return plan.programs
    suffix = _SUFFIX_OF.get(plan.machine.language, SUFFIXES[0])
    if plan.machine.tools.change == "operator":
        return tuple(
            _file(f"{setup.number}-{setup.name}{suffix}", side.face, [setup])
            for side in plan.passes
            for setup in side.setups
        )
    return tuple(_file(f"{side.face}{suffix}", side.face, side.setups) for side in plan.passes)


def _file(name: str, face: Face, setups: Iterable[SetUp]) -> ProgramFile:
    numbers = tuple(setup.number for setup in setups)
    return ProgramFile(name=name, face=face, setups=numbers, sha256="")


def at(point: Iterable[float]) -> str:
    """Write a point for people."""
    x, y = point
    return f"({x:.2f}, {y:.2f}) mm"
