"""Put the plan together; every step is a function of what came before it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern, Fold
from foldmill.check import check
from foldmill.exchange import fold as fold_file
from foldmill.finding import Finding, Severity
from foldmill.slits import sewn
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Kind, Material, Perforation
from foldmill_fabricate.passes import Face, Flip, Hole, Plan, Sheet, Tie
from foldmill_fabricate.plan import (
    lead_ins,
    outline,
    processes,
    registration,
    rules,
    scores,
    setups,
    short,
    sides,
)
from foldmill_fabricate.plan import relief as relief_holes
from foldmill_fabricate.plan.figures import measure
from foldmill_fabricate.plan.placement import lay_blank, place
from foldmill_fabricate.plan.registration import Registration
from foldmill_fabricate.plan.setups import Lines
from foldmill_fabricate.sheet import placed

Floats = NDArray[np.float64]
ByFace = dict[Face, NDArray[np.intp]]
FlipKind = Literal["left-right", "end-over-end"]


def make(
    fold: Fold,
    material: Material,
    machine: Machine,
    *,
    score: Kind | None = None,
    cut: Kind | None = None,
    blank: tuple[float, float] | None = None,
    carrier: tuple[float, float] | None = None,
    flip: FlipKind = "left-right",
    unassigned: sides.Unassigned | None = None,
    relief: relief_holes.Relief = "none",
) -> Plan:
    """Plan the sheet of a fold.

    score, cut : the processes to use, by default the first of the material's that the machine can
    do; blank : (width, height) mm, by default the material's stock; carrier : (width, height) mm,
    by default the machine's mat; flip : how the operator turns the sheet; unassigned : where U
    creases are scored; relief : which vertices get a hole. The same input gives the same plan.
    Raises CannotPlan or DoesNotFit with a sentence.
    """
    if not len(fold.pattern.vertices):
        raise CannotPlan("The pattern is empty; there is nothing to cut.")
    pattern = sewn(fold.pattern).pattern
    material = processes.chosen(material, machine, score, cut)
    sheet = lay_blank(
        machine,
        blank or (material.stock_width, material.stock_height),
        carrier or (machine.bed.carrier_width, machine.bed.carrier_height),
    )
    placement = place(pattern.vertices, sheet, material.part_clearance)
    spots = placed(pattern.vertices, placement)
    turn = _flip(flip, sheet)
    by_face = sides.scored_edges(pattern, material.score, unassigned)
    marks = _register(pattern, spots, sheet, turn, material, by_face)
    found = _vertices(pattern, spots, by_face, material, relief)
    lines, ties, tied = _lines(pattern, spots, by_face, found, material, machine)
    passes = setups.passes(lines, by_face, marks, material, machine, sheet, turn)
    passes = lead_ins.added(passes, _rim(pattern, spots), marks, sheet, material, machine)
    draft = Plan(
        title=str(fold.meta.get("title", "")),
        pattern_sha256=hashlib.sha256(fold_file.write(fold).encode()).hexdigest(),
        material=material,
        machine=machine,
        sheet=sheet,
        placement=placement,
        flip=turn,
        unassigned=unassigned,
        holes=marks.holes,
        ties=ties,
        reliefs=found.reliefs(spots),
        passes=passes,
        figures=measure(passes, machine, sheet, turn),
    )
    judged = rules.judge(pattern, spots, by_face, found.stops, found.relieved, draft)
    return draft.model_copy(update={"findings": (*_folds(fold), *marks.findings, *tied, *judged)})


@dataclass(frozen=True)
class _Vertices:
    """What becomes of vertices: how far scores stop short of them, and where a hole is."""

    stops: dict[int, float]
    relieved: dict[int, float]

    def reliefs(self, spots: Floats) -> tuple[Hole, ...]:
        return relief_holes.holes(self.relieved, spots)


def _vertices(
    pattern: CreasePattern,
    spots: Floats,
    by_face: ByFace,
    material: Material,
    relief: relief_holes.Relief,
) -> _Vertices:
    stops = dict.fromkeys(scores.held_back(pattern, by_face), material.score.setback)
    found = relief_holes.diameters(pattern, spots, by_face, stops, material, relief)
    return _Vertices(stops | {v: d / 2 for v, d in found.items()}, found)


def _lines(
    pattern: CreasePattern,
    spots: Floats,
    by_face: ByFace,
    found: _Vertices,
    material: Material,
    machine: Machine,
) -> tuple[Callable[[Face, Floats], Lines], tuple[Tie, ...], tuple[Finding, ...]]:
    """Return what gives the strokes of a face from where the tool is, and the outline's ties."""
    short.refuse_swallowed(pattern, spots, by_face, found.stops, material, machine)
    outline.refuse_snapped_slots(pattern, material.cut)
    cuts, ties, tied = outline.outer_cut(pattern, spots, material.cut)
    score = material.score
    rows = isinstance(score, Perforation)
    ends = dict.fromkeys(found.stops, scores.TOUCH) if rows else found.stops
    holes = found.reliefs(spots)

    def lines(face: Face, start: Floats) -> Lines:
        drawn = scores.strokes(pattern, spots, by_face[face], ends, score.repeats, start, machine)
        return Lines(
            scores.dashed(drawn, score) if isinstance(score, Perforation) else drawn,
            relief_holes.strokes(holes, material.cut.repeats, start, machine.tools.host_offset),
            outline.inner_cuts(pattern, spots, material.cut.repeats, start),
            cuts,
        )

    return lines, ties, tied


def _folds(fold: Fold) -> tuple[Finding, ...]:
    """Return why the fold does not fold, if it does not: no sheet should be cut for it."""
    return tuple(f for f in check(fold).findings if f.severity is Severity.ERROR)


def _flip(kind: FlipKind, sheet: Sheet) -> Flip:
    return Flip(kind=kind, axis=(sheet.width if kind == "left-right" else sheet.height) / 2)


def _register(
    pattern: CreasePattern,
    spots: Floats,
    sheet: Sheet,
    turn: Flip,
    material: Material,
    by_face: ByFace,
) -> Registration:
    """A sheet that is scored on one face only is never turned, and needs no register."""
    if not all(len(edges) for edges in by_face.values()):
        return Registration()
    return registration.register(_rim(pattern, spots), sheet, turn, material)


def _rim(pattern: CreasePattern, spots: Floats) -> Floats:
    """Return the outline (n, 2) of the part on the sheet."""
    rim: Floats = spots[pattern.outline()[0]]
    return rim
