"""Put the plan together; every step is a function of what came before it."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern, Fold
from foldmill.check import check
from foldmill.exchange import fold as fold_file
from foldmill.finding import Finding, Severity
from foldmill.slits import sewn
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.kinds import FlipKind, Kind, RegistrationKind, Unassigned
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Flip, Hole, Plan, Sheet
from foldmill_fabricate.plan import (
    blanks,
    budget,
    lead_ins,
    lines,
    processes,
    registration,
    rules,
    scores,
    setups,
    short,
    sides,
    two_sides,
)
from foldmill_fabricate.plan import relief as relief_holes
from foldmill_fabricate.plan.figures import measure
from foldmill_fabricate.plan.grids import Block, Grid
from foldmill_fabricate.plan.placement import lay_blank, lay_out
from foldmill_fabricate.plan.registration import Registration
from foldmill_fabricate.sheet import placed, seated

Floats = NDArray[np.float64]
ByFace = dict[Face, NDArray[np.intp]]


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
    unassigned: Unassigned | None = None,
    relief: relief_holes.Relief = "none",
    copies: int = 1,
    grid: tuple[int, int] | None = None,
    register: RegistrationKind = "holes",
    temperatures: tuple[float, float] | None = None,
) -> Plan:
    """Plan the sheet of a fold.

    score, cut : the processes to use, by default the first of the material's that the machine can
    do; blank : (width, height) mm, by default the material's stock; carrier : (width, height) mm,
    by default the machine's mat; flip : how the operator turns the sheet; unassigned : where U
    creases are scored; relief : which vertices get a hole; copies : how many parts, in the grid
    that suits the blank; grid : (columns, rows) of copies instead; register : what keeps the faces
    in register; temperatures : of the sheet at both passes, °C. The same input gives the same plan.
    Raises CannotPlan or DoesNotFit with a sentence.
    """
    if not len(fold.pattern.vertices):
        raise CannotPlan("The pattern is empty; there is nothing to cut.")
    pattern = sewn(fold.pattern).pattern
    material = processes.chosen(material, machine, score, cut)
    block = _block(pattern, material, copies, grid)
    blank = blank or (material.stock_width, material.stock_height)
    carrier = carrier or (machine.bed.carrier_width, machine.bed.carrier_height)
    sheet = lay_blank(machine, blank, carrier, block)
    placements = lay_out(block, sheet, lambda: blanks.advice(block, blank, carrier, machine))
    every = [placed(pattern.vertices, placement) for placement in placements]
    spots, rims = every[0], [_rim(pattern, own) for own in every]
    turn = _flip(flip, sheet)
    by_face = sides.scored_edges(pattern, material.score, unassigned)
    marks = _register(register, rims, sheet, turn, material, machine, by_face)
    found = _vertices(pattern, spots, by_face, material, relief)
    reliefs = [found.reliefs(own) for own in every]
    short.refuse_swallowed(pattern, spots, by_face, found.stops, material, machine)
    drawn, ties, tied = lines.drawn(
        pattern, every, by_face, found.stops, reliefs, material, machine
    )
    passes = setups.passes(drawn, by_face, marks, material, machine, sheet, turn)
    passes = lead_ins.added(passes, rims, marks, sheet, material, machine)
    machine = seated(machine, sheet)
    draft = Plan(
        title=str(fold.meta.get("title", "")),
        pattern_sha256=hashlib.sha256(fold_file.write(fold).encode()).hexdigest(),
        material=material,
        machine=machine,
        sheet=sheet,
        placement=placements[0],
        quantity=len(placements),
        copies=placements[1:],
        flip=turn,
        unassigned=unassigned,
        holes=marks.holes,
        registration=marks.made,
        temperatures=temperatures,
        ties=ties,
        reliefs=tuple(hole for own in reliefs for hole in own),
        passes=passes,
        figures=measure(passes, machine, sheet, turn),
    )
    draft = draft.model_copy(update={"budget": budget.reckon(draft)})
    judged = rules.judge(pattern, spots, by_face, found.stops, found.relieved, draft)
    return draft.model_copy(
        update={
            "findings": (
                *_folds(fold),
                *marks.findings,
                *two_sides.findings(draft),
                *budget.findings(draft),
                *tied,
                *judged,
            )
        }
    )


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


def _block(
    pattern: CreasePattern, material: Material, copies: int, grid: tuple[int, int] | None
) -> Block:
    """Return the copies that are wanted of a part."""
    if copies < 1 or (grid is not None and min(grid) < 1):
        raise CannotPlan("A sheet holds one copy at least, and a grid one row and one column.")
    if grid is not None and copies not in {1, grid[0] * grid[1]}:
        raise CannotPlan(
            f"A grid of {grid[0]} × {grid[1]} holds {grid[0] * grid[1]} copies, and {copies} are "
            f"wanted. Give one of the two."
        )
    shape = None if grid is None else Grid(*grid)
    return Block.of(pattern.vertices, material.part_clearance, copies, shape)


def _folds(fold: Fold) -> tuple[Finding, ...]:
    """Return why the fold does not fold, if it does not, and how its file was mended."""
    errors = tuple(f for f in check(fold).findings if f.severity is Severity.ERROR)
    return errors + tuple(f for f in fold.findings if f.code.startswith(("mended-", "import-")))


def _flip(kind: FlipKind, sheet: Sheet) -> Flip:
    return Flip(kind=kind, axis=(sheet.width if kind == "left-right" else sheet.height) / 2)


def _register(
    kind: RegistrationKind,
    rims: Sequence[Floats],
    sheet: Sheet,
    turn: Flip,
    material: Material,
    machine: Machine,
    by_face: ByFace,
) -> Registration:
    """A sheet that is scored on one face only is never turned, and needs no register."""
    if not all(len(edges) for edges in by_face.values()):
        return Registration()
    return registration.register(kind, rims, sheet, turn, material, machine)


def _rim(pattern: CreasePattern, spots: Floats) -> Floats:
    """Return the outline (n, 2) of the part on the sheet."""
    rim: Floats = spots[pattern.outline()[0]]
    return rim
