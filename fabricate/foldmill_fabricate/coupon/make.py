"""Plan a coupon: material + machine → a plan like any other, with what is tried declared in it."""

from __future__ import annotations

import hashlib
from typing import Literal

import numpy as np

from foldmill import Assignment, CreasePattern, Fold
from foldmill.exchange import fold as fold_file
from foldmill_fabricate.coupon import layout, setups
from foldmill_fabricate.coupon.lines import lines
from foldmill_fabricate.coupon.trials import trials
from foldmill_fabricate.kinds import FlipKind, Kind
from foldmill_fabricate.ladders import Coupon, Lettering, Side
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, Perforation, Score
from foldmill_fabricate.passes import Face, Flip, Placement, Plan
from foldmill_fabricate.plan import lead_ins, processes, registration, rules, two_sides
from foldmill_fabricate.plan.figures import measure
from foldmill_fabricate.plan.grids import Block
from foldmill_fabricate.plan.placement import lay_blank

SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
LIGHTLY = 0.5
"""Share of the force of a score that draws words and lines to measure by."""


def make(
    material: Material,
    machine: Machine,
    *,
    score: Kind | None = None,
    cut: Kind | None = None,
    blank: tuple[float, float] | None = None,
    carrier: tuple[float, float] | None = None,
    flip: FlipKind = "left-right",
    degree: Literal[4, 6] = 4,
) -> tuple[Fold, Plan]:
    """Plan a coupon; return its sheet as a pattern without creases, and the plan.

    score, cut, blank, carrier, flip : as for ``plan.make``; degree : how many creases meet in a
    patch. Raises CannotPlan or DoesNotFit with a sentence.
    """
    material = processes.chosen(material, machine, score, cut)
    sheet = lay_blank(
        machine,
        blank or (material.stock_width, material.stock_height),
        carrier or (machine.bed.carrier_width, machine.bed.carrier_height),
        Block.of(max(layout.least_blank(flip, material)) * SQUARE, 0.0),
    )
    turn = Flip(kind=flip, axis=(sheet.width if flip == "left-right" else sheet.height) / 2)
    area = layout.board(sheet, turn, material)
    coupon = _coupon(material, machine, turn, area, degree)
    drawn, holes, ties = lines(coupon, material, turn, machine.tools.host_offset)
    fold = _sheet_as_fold(area, f"Coupon, {material.slug}")
    rim = fold.pattern.vertices[fold.pattern.outline()[0]]
    marks = registration.register("holes", [rim], sheet, turn, material, machine)
    passes = setups.passes(drawn, marks, coupon, material, machine, sheet, turn)
    passes = lead_ins.added(passes, [rim], marks, sheet, material, machine)
    plan = Plan(
        title=str(fold.meta["title"]),
        pattern_sha256=hashlib.sha256(fold_file.write(fold).encode()).hexdigest(),
        material=material,
        machine=machine,
        sheet=sheet,
        placement=Placement(angle=0.0, dx=0.0, dy=0.0),
        flip=turn,
        holes=marks.holes,
        registration=marks.made,
        ties=ties,
        reliefs=holes,
        coupon=coupon,
        passes=passes,
        figures=measure(passes, machine, sheet, turn, bounded=False),
    )
    nothing: dict[Face, np.ndarray] = {face: np.zeros(0, np.intp) for face in Face}
    judged = rules.judge(fold.pattern, fold.pattern.vertices, nothing, {}, (), plan)
    found = (*marks.findings, *two_sides.findings(plan), *judged)
    return fold, plan.model_copy(update={"findings": found})


def _sheet_as_fold(area: layout.Box, title: str) -> Fold:
    """Return the board as a pattern: one facet, on the sheet's own coordinates."""
    left, low, right, high = area
    corners = np.array([(left, low), (right, low), (right, high), (left, high)])
    edges = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)], np.intp)
    kinds = np.array([Assignment.B] * 4 + [Assignment.F], np.uint8)
    faces = np.array([(0, 1, 2), (0, 2, 3)], np.intp)
    pattern = CreasePattern(corners, edges, kinds, np.zeros(5), faces)
    return Fold(pattern, None, meta={"title": title})


def _coupon(
    material: Material, machine: Machine, flip: Flip, area: layout.Box, degree: Literal[4, 6]
) -> Coupon:
    values, missing = trials(material, machine, degree)
    sides = _sides(material.score)
    lettering, silent = _lettering(material, machine)
    titles: dict[Side, str] = {
        "front": f"FRONT  {material.slug}  {machine.slug}",
        "reverse": f"REVERSE  {material.slug}",
    }
    found = layout.lay_out(values, sides, area, flip, titles)
    return Coupon(
        degree=degree,
        strip_width=layout.STRIP[0],
        strip_length=layout.STRIP[1],
        patch=layout.PATCH,
        ladders=found.ladders,
        verniers=found.verniers,
        slits=material.cut.goes_through,
        bars=found.bars,
        words=() if silent else found.words,
        lettering=lettering,
        left_out=(*missing, *found.left_out, *silent),
    )


def _sides(score: Score) -> tuple[Side, ...]:
    """Return the faces that are scored, that of mountains first."""
    if score.score_face == "either":
        return ("reverse",)
    return ("front", "reverse") if score.score_face == "outside" else ("reverse", "front")


def _lettering(material: Material, machine: Machine) -> tuple[Lettering, tuple[str, ...]]:
    """Return how words are drawn: by the machine's own pen, else as half a score.

    A sentence says why there are none where every line would go through the sheet.
    """
    pens = [score for score in material.scores if score.kind == "pen"]
    has_pen = machine.tools.change == "select" and "pen" in machine.tools.stations
    made = pens[0] if pens and has_pen else material.score
    light = 1.0 if made.kind == "pen" else LIGHTLY
    silent: tuple[str, ...] = ()
    if isinstance(made, Perforation):
        why = "for every line of this machine goes through the sheet"
        silent = (f"The words are left out, {why}. The job sheet's drawing names each cell.",)
    tools = machine.tools
    return Lettering(
        process=made.kind,
        tool=machine.tools.station(made.kind),
        exposure=made.exposure,
        force=round(tools.force(tools.force(made.force) * light), 3),
        speed=made.speed,
    ), silent
