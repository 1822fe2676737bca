"""In which order the work is done, and what the operator does in between.

Two faces: front holes, front scores, flip, reverse scores, relief holes, inner cuts, outline last.
One face: scores, relief holes, inner cuts, outline. The tool is changed as rarely as that
order allows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Flip, Gate, Operation, Pass, Role, SetUp, Sheet, Stroke
from foldmill_fabricate.plan.optical import window
from foldmill_fabricate.plan.registration import Registration, hole_rim
from foldmill_fabricate.sheet import flipped, on_carrier
from foldmill_fabricate.toolpath import order

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Lines:
    """What is drawn on one face, in order of work."""

    scores: tuple[Stroke, ...]
    relief: tuple[Stroke, ...]
    inner: tuple[Stroke, ...]
    outer: tuple[Stroke, ...]


@dataclass(frozen=True)
class _Draft:
    """A set-up before it is numbered."""

    face: Face
    name: str
    process: Literal["score", "cut"]
    """Which of the material's two processes."""
    operations: tuple[Operation, ...]


def passes(
    lines: Callable[[Face, Floats], Lines],
    by_face: dict[Face, NDArray[np.intp]],
    marks: Registration,
    material: Material,
    machine: Machine,
    sheet: Sheet,
    flip: Flip,
) -> tuple[Pass, ...]:
    """Return the passes of the job.

    lines : gives the strokes of a face, ordered from where the tool is (2,), on the sheet.
    """
    home = -on_carrier([(0.0, 0.0)], sheet)[0]  # the carrier's corner, seen from the sheet
    scored = [face for face in (Face.FRONT, Face.REVERSE) if len(by_face[face])]
    last = scored[-1] if scored else Face.FRONT
    drafts: list[_Draft] = []
    if len(scored) == 2:
        front = lines(Face.FRONT, home)
        holes = _hole_strokes(marks, machine.tools.host_offset, home)
        # A window begins where its arms meet: readers of the drawing take that for the mark.
        rims = [window(mark) for mark in marks.made.marks]
        windows = order.sorted_strokes(rims, 1, home, turned=False)
        name = "marks" if windows else "holes"
        drafts.append(_cut(name, Face.FRONT, material, holes=holes, marks=windows))
        drafts.append(_score(Face.FRONT, material, front.scores, marks.witness))
        home = flipped([home], flip)[0]
    final = lines(last, home)
    drafts.append(_score(last, material, final.scores))
    drafts.append(_cut("cut", last, material, (), (), final.relief, final.inner, final.outer))
    return _number([draft for draft in drafts if draft.operations], material, machine)


def _hole_strokes(marks: Registration, offset: float, home: Floats) -> tuple[Stroke, ...]:
    return order.sorted_strokes([hole_rim(hole, offset) for hole in marks.holes], 1, home)


def _score(
    face: Face, material: Material, strokes: tuple[Stroke, ...], witness: tuple[Stroke, ...] = ()
) -> _Draft:
    repeats = material.score.repeats
    found = (
        Operation(role=Role.WITNESS, repeats=repeats, strokes=witness),
        Operation(role=Role.SCORE, repeats=repeats, strokes=strokes),
    )
    return _Draft(face, f"{face}-score", "score", tuple(op for op in found if op.strokes))


def _cut(
    name: str,
    face: Face,
    material: Material,
    holes: tuple[Stroke, ...] = (),
    marks: tuple[Stroke, ...] = (),
    relief: tuple[Stroke, ...] = (),
    inner: tuple[Stroke, ...] = (),
    outer: tuple[Stroke, ...] = (),
) -> _Draft:
    cut = material.cut
    found = tuple(
        Operation(role=role, repeats=cut.repeats, overcut=cut.overcut, strokes=strokes)
        for role, strokes in (
            (Role.HOLE, holes),
            (Role.MARK, marks),
            (Role.RELIEF, relief),
            (Role.CUT_INNER, inner),
            (Role.CUT_OUTER, outer),
        )
        if strokes
    )
    return _Draft(face, f"{face}-{name}", "cut", found)


def _number(drafts: list[_Draft], material: Material, machine: Machine) -> tuple[Pass, ...]:
    setups: list[tuple[Face, SetUp]] = []
    before: _Draft | None = None
    for number, draft in enumerate(drafts, start=1):
        process = material.score if draft.process == "score" else material.cut
        changes = before is not None and before.process != draft.process
        setup = SetUp(
            number=number,
            name=draft.name,
            process=draft.process,
            tool=machine.tools.station(process.kind),
            exposure=process.exposure,
            force=machine.tools.force(process.force),
            speed=process.speed,
            gates=gates(before.face if before else None, draft.face, changes, machine),
            swivel_force=swivel_force(draft.process, material, machine),
            operations=draft.operations,
        )
        setups.append((draft.face, setup))
        before = draft
    faces = dict.fromkeys(face for face, _ in setups)
    return tuple(
        Pass(face=face, setups=tuple(setup for own, setup in setups if own is face))
        for face in faces
    )


def swivel_force(process: str, material: Material, machine: Machine) -> float:
    """Return the force for turning a blade out of the groove: where a program can do that."""
    possible = machine.tools.host_offset > 0 and machine.dialect.force
    possible = possible and machine.language != "gcode"  # which knows no force
    return material.cut.swivel_force if possible and process == "cut" else 0.0


def gates(before: Face | None, face: Face, changes: bool, machine: Machine) -> tuple[Gate, ...]:
    """Return what the operator does before a set-up on a face.

    before : the face of the set-up before it, None for the first; changes : whether it takes
    another tool or setting.
    """
    asked = []
    if before is None:
        asked.append(Gate.LOAD)
    elif before is not face:
        asked.append(Gate.FLIP)
    if (before is None or changes) and machine.tools.change == "operator":
        asked.append(Gate.TOOL)
    return tuple(asked)
