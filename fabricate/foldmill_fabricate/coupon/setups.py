"""In which order a coupon is made: as a job is, with a set-up for every rung's own figures.

Front: holes and verniers through the sheet, words and lines to measure by, scores, then the rungs
whose figures differ. Reverse: the same without holes, then all cuts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.coupon.lines import Line
from foldmill_fabricate.ladders import Coupon
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Flip, Operation, Pass, Role, SetUp, Sheet, Stroke
from foldmill_fabricate.plan.registration import Registration, hole_rim
from foldmill_fabricate.plan.setups import gates
from foldmill_fabricate.sheet import flipped, on_carrier
from foldmill_fabricate.toolpath import order

Floats = NDArray[np.float64]
DRAWN = (Role.LABEL, Role.RULER)
CUT = (Role.HOLE, Role.VERNIER, Role.RELIEF, Role.CUT_INNER, Role.CUT_OUTER)


@dataclass(frozen=True)
class _Draft:
    """A set-up before it is numbered."""

    face: Face
    name: str
    process: Literal["score", "cut"]
    tool: int
    exposure: float
    force: float
    speed: float
    operations: tuple[Operation, ...]

    @property
    def tooling(self) -> tuple[str, int, float]:
        """What an operator's hand would have to change."""
        return self.process, self.tool, self.exposure


class _Maker:
    def __init__(
        self, coupon: Coupon, material: Material, machine: Machine, home: dict[Face, Floats]
    ) -> None:
        self.coupon, self.material, self.machine, self.home = coupon, material, machine, home

    def operation(
        self, role: Role, face: Face, strokes: Sequence[Stroke], repeats: int, overcut: float = 0.0
    ) -> Operation:
        # Words are read stroke by stroke: letters begin where they do in the alphabet.
        ordered = order.sorted_strokes(strokes, repeats, self.home[face], turned=False)
        return Operation(role=role, repeats=repeats, overcut=overcut, strokes=ordered)

    def cut(self, name: str, face: Face, lines: Sequence[Line]) -> _Draft:
        """One set-up of everything in ``lines`` that goes through, by role."""
        cut = self.material.cut
        operations = tuple(
            self.operation(role, face, own, cut.repeats, cut.overcut)
            for role in CUT
            if (own := [line.stroke for line in lines if line.role is role])
        )
        tool, force = self.machine.tools.station(cut.kind), self.machine.tools.force(cut.force)
        return _Draft(
            face, f"{face}-{name}", "cut", tool, cut.exposure, force, cut.speed, operations
        )

    def lettering(self, face: Face, lines: Sequence[Line]) -> _Draft:
        """One set-up of words and lines to measure by."""
        how = self.coupon.lettering
        operations = tuple(
            self.operation(role, face, own, 1)
            for role in DRAWN
            if (own := [line.stroke for line in lines if line.role is role])
        )
        figures = (how.tool, how.exposure, how.force, how.speed)
        return _Draft(face, f"{face}-words", "score", *figures, operations)

    def scores(self, face: Face, lines: Sequence[Line], witness: Sequence[Stroke]) -> list[_Draft]:
        """One set-up of scores with the preset's figures, then one for each that differs."""
        score, tools = self.material.score, self.machine.tools
        usual = (score.exposure, tools.force(score.force))
        found: dict[tuple[float, float], dict[int, list[Stroke]]] = {usual: {}}
        for line in (line for line in lines if line.role is Role.SCORE):
            exposure = usual[0] if line.trial.exposure is None else line.trial.exposure
            force = usual[1] if line.trial.force is None else line.trial.force
            repeats = line.trial.repeats or score.repeats
            own = found.setdefault((exposure, force), {})
            own.setdefault(repeats, []).append(line.stroke)
        drafts, numbers = [], count(1)
        for exposure, force in sorted(
            found, key=lambda key: (key != usual, key[0] != usual[0], key)
        ):
            own = found[exposure, force]
            plain = (exposure, force) == usual
            operations = [self.operation(Role.WITNESS, face, witness, score.repeats)]
            operations = operations if plain and witness else []
            operations += [self.operation(Role.SCORE, face, own[n], n) for n in sorted(own)]
            name = f"{face}-score" if plain else f"{face}-rung-{next(numbers)}"
            tool = tools.station(score.kind)
            figures = (tool, exposure, force, score.speed)
            drafts.append(_Draft(face, name, "score", *figures, tuple(operations)))
        return drafts


def passes(
    lines: Sequence[Line],
    marks: Registration,
    coupon: Coupon,
    material: Material,
    machine: Machine,
    sheet: Sheet,
    flip: Flip,
) -> tuple[Pass, ...]:
    """Return both passes of a coupon."""
    corner = -on_carrier([(0.0, 0.0)], sheet)[0]
    home = {Face.FRONT: corner, Face.REVERSE: flipped([corner], flip)[0]}
    maker = _Maker(coupon, material, machine, home)
    rims = [hole_rim(hole, machine.tools.host_offset) for hole in marks.holes]
    drilled = [Line(Role.HOLE, Face.FRONT, rim) for rim in rims]
    front = [line for line in lines if line.face is Face.FRONT]
    reverse = [line for line in lines if line.face is Face.REVERSE]
    drafts = [
        maker.cut("holes", Face.FRONT, [*drilled, *front]),
        maker.lettering(Face.FRONT, front),
        *maker.scores(Face.FRONT, front, marks.witness),
        maker.lettering(Face.REVERSE, reverse),
        *maker.scores(Face.REVERSE, reverse, ()),
        maker.cut("cut", Face.REVERSE, reverse),
    ]
    return _number([draft for draft in drafts if draft.operations], machine)


def _number(drafts: list[_Draft], machine: Machine) -> tuple[Pass, ...]:
    setups: dict[Face, list[SetUp]] = {}
    before: _Draft | None = None
    for number, draft in enumerate(drafts, start=1):
        changes = before is not None and before.tooling != draft.tooling
        setup = SetUp(
            number=number,
            name=draft.name,
            process=draft.process,
            tool=draft.tool,
            exposure=draft.exposure,
            force=draft.force,
            speed=draft.speed,
            gates=gates(before.face if before else None, draft.face, changes, machine),
            operations=draft.operations,
        )
        setups.setdefault(draft.face, []).append(setup)
        before = draft
    return tuple(Pass(face=face, setups=tuple(own)) for face, own in setups.items())
