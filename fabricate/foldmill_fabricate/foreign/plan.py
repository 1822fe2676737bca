"""A foreign drawing as a plan: its lines on a blank of their own, by the roles a person gave pens.

One face, one placement, nothing derived: there is no pattern, and the plan says so.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from enum import StrEnum
from math import dist
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern, Fold
from foldmill.finding import Finding, Severity
from foldmill_fabricate import folder
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.foreign import limits, overlaps
from foldmill_fabricate.foreign.nesting import inside_first
from foldmill_fabricate.foreign.read import Drawing
from foldmill_fabricate.kinds import Kind
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material, Perforation
from foldmill_fabricate.passes import (
    XY,
    Face,
    Flip,
    Operation,
    Pass,
    PenUse,
    Placement,
    Plan,
    Role,
    SetUp,
    Sheet,
    Source,
    Stroke,
)
from foldmill_fabricate.plan import lead_ins, processes, setups
from foldmill_fabricate.plan.figures import measure
from foldmill_fabricate.plan.grids import Block
from foldmill_fabricate.plan.placement import lay_blank
from foldmill_fabricate.plan.registration import Registration
from foldmill_fabricate.profiles import Style
from foldmill_fabricate.sheet import on_carrier, seated

Floats = NDArray[np.float64]


class Use(StrEnum):
    """What a pen of a foreign drawing draws."""

    SCORE = "score"
    INNER = "inner"
    """cut before the outline"""
    CUT = "cut"
    """the outline, cut last"""
    SKIP = "skip"


_ROLES = {
    Use.SCORE: Role.SCORE,
    Use.INNER: Role.CUT_INNER,
    Use.CUT: Role.CUT_OUTER,
    Use.SKIP: None,
}


def plan_drawing(
    drawing: Drawing,
    pens: Mapping[int, Use],
    material: Material,
    machine: Machine,
    *,
    score: Kind | None = None,
    cut: Kind | None = None,
    blank: tuple[float, float] | None = None,
    carrier: tuple[float, float] | None = None,
) -> Plan:
    """Plan the lines of a drawing on the front of a blank, in its middle, as they lie in the file.

    pens : what each pen draws; score, cut : processes, blank, carrier : (width, height) mm, all as
    ``plan.make`` takes them. The same input gives the same plan. Raises CannotPlan for a pen of
    which nothing is said, and where two lines run along each other; DoesNotFit with the missing mm.
    """
    _refuse_many(drawing)
    roles = _roles(drawing, pens)
    material = processes.chosen(material, machine, score, cut)
    if isinstance(material.score, Perforation) and Role.SCORE in roles.values():
        raise CannotPlan(
            f"{machine.slug} would perforate the scores, and a drawing's lines are cut as they are "
            "drawn, right through. Draw the dashes themselves and cut them, or take --score of "
            "another kind."
        )
    corners = _corners(drawing, roles)
    blank = blank or (material.stock_width, material.stock_height)
    carrier = carrier or (machine.bed.carrier_width, machine.bed.carrier_height)
    sheet = lay_blank(machine, blank, carrier, Block.of(corners, material.part_clearance))
    placement = _placed(corners, sheet, material.part_clearance)
    machine = seated(machine, sheet)
    passes = _passes(drawing, roles, placement, material, machine, sheet)
    rim = corners + np.array([placement.dx, placement.dy])
    passes = lead_ins.added(passes, [rim], Registration(), sheet, material, machine)
    turn = Flip(kind="left-right", axis=sheet.width / 2)
    source = Source(
        name=drawing.name,
        sha256=drawing.sha256,
        pens=tuple(PenUse(pen=pen, role=role) for pen, role in sorted(roles.items())),
        tolerance=limits.TOLERANCE_MM + limits.APART_MM,
    )
    return Plan(
        title=Path(drawing.name).stem,
        pattern_sha256=hashlib.sha256(b"").hexdigest(),  # of no bytes: there is no pattern
        material=material,
        machine=machine,
        sheet=sheet,
        placement=placement,
        flip=turn,
        holes=(),
        ties=(),
        source=source,
        passes=passes,
        figures=measure(passes, machine, sheet, turn, bounded=False),
        findings=tuple(_findings(drawing)),
    )


def write_drawing(
    plan: Plan, output: Path, formats: Sequence[str], style: Style | None = None
) -> Plan:
    """Write the job folder of a drawing, without a pattern; return the plan, its programs named."""
    return folder.write(
        Fold(CreasePattern.from_lines([], [], [], [])), plan, output, formats, style
    )


def _refuse_many(drawing: Drawing) -> None:
    count = sum(len(own) for own in drawing.pens.values())
    if count > limits.STROKES:
        raise CannotPlan(
            f"{drawing.name} has {count:,} lines; {limits.STROKES:,} at the most are put in order. "
            "Join those that meet, or divide the drawing."
        )


def _roles(drawing: Drawing, pens: Mapping[int, Use]) -> dict[int, Role | None]:
    silent = [pen for pen in drawing.pens if pen not in pens]
    if silent:
        told = ", ".join(f"pen {pen} draws {_count(len(drawing.pens[pen]))}" for pen in silent)
        raise CannotPlan(
            f"Nobody has said what is to be made of these: {told}. Say --pen {silent[0]}=score, "
            "=cut, =inner or =skip."
        )
    absent = [pen for pen in pens if pen not in drawing.pens]
    if absent:
        found = ", ".join(map(str, drawing.pens))
        raise CannotPlan(f"{drawing.name} has no pen {absent[0]}; it draws with {found}.")
    roles = {pen: _ROLES[pens[pen]] for pen in drawing.pens}
    if not any(roles.values()):
        raise CannotPlan("Every pen is skipped; nothing is left to be made.")
    return roles


def _corners(drawing: Drawing, roles: Mapping[int, Role | None]) -> Floats:
    """Return the corners (4, 2) of the box round all lines that are made, as in the file, mm."""
    ways = [way for pen, own in drawing.pens.items() if roles[pen] for way in own]
    spots = np.concatenate([np.asarray(way, float) for way in ways])
    (x, y), (u, v) = spots.min(axis=0), np.maximum(spots.max(axis=0), spots.min(axis=0) + 1e-3)
    return np.array([(x, y), (u, y), (u, v), (x, v)])


def _placed(corners: Floats, sheet: Sheet, clearance: float) -> Placement:
    size = np.ptp(corners, axis=0)
    room = np.array([sheet.width, sheet.height]) - 2 * clearance
    if (size > room + 1e-9).any():
        width, height = np.ceil((size + 2 * clearance) * 10) / 10
        raise DoesNotFit(
            f"The drawing is {size[0]:.1f} × {size[1]:.1f} mm, and a blank of {sheet.width:g} × "
            f"{sheet.height:g} mm has room for {room[0]:g} × {room[1]:g} mm: "
            f"{(size - room).max():.1f} mm are missing. The smallest blank that holds it as it is "
            f"drawn is {width:g} × {height:g} mm."
        )
    dx, dy = (np.array([sheet.width, sheet.height]) - size) / 2 - corners[0]
    return Placement(angle=0.0, dx=round(float(dx), 9), dy=round(float(dy), 9))


def _passes(
    drawing: Drawing,
    roles: Mapping[int, Role | None],
    placement: Placement,
    material: Material,
    machine: Machine,
    sheet: Sheet,
) -> tuple[Pass, ...]:
    """Return the front pass: scores, inner cuts, outline."""
    strokes = {role: _strokes(drawing, roles, role, placement) for role in Role}
    overlaps.refuse([stroke for own in strokes.values() for stroke in own])
    at: Floats = -on_carrier([(0.0, 0.0)], sheet)[0]
    made: list[SetUp] = []
    for process, own in (("score", [Role.SCORE]), ("cut", [Role.CUT_INNER, Role.CUT_OUTER])):
        preset = material.score if process == "score" else material.cut
        operations = []
        for role in own:
            if not strokes[role]:
                continue
            done = inside_first(strokes[role], preset.repeats, at)
            at = np.array(done[-1].points[-1])
            operations.append(
                Operation(role=role, repeats=preset.repeats, overcut=preset.overcut, strokes=done)
            )
        if operations:
            before = Face.FRONT if made else None
            made.append(
                SetUp(
                    number=len(made) + 1,
                    name=f"front-{process}",
                    process="score" if process == "score" else "cut",
                    tool=machine.tools.station(preset.kind),
                    exposure=preset.exposure,
                    force=machine.tools.force(preset.force),
                    speed=preset.speed,
                    gates=setups.gates(before, Face.FRONT, bool(made), machine),
                    swivel_force=setups.swivel_force(process, material, machine),
                    operations=tuple(operations),
                )
            )
    return (Pass(face=Face.FRONT, setups=tuple(made)),)


def _strokes(
    drawing: Drawing, roles: Mapping[int, Role | None], role: Role, placement: Placement
) -> list[Stroke]:
    """Return the lines of a role on the blank; one that is drawn again is left out."""
    found: dict[tuple[tuple[float, float], ...], Stroke] = {}
    for pen, ways in drawing.pens.items():
        for way in ways if roles[pen] is role else ():
            kept = thinned(way)
            if len(kept) == 2 and kept[0] == kept[1]:
                continue  # a ring smaller than a step
            points = tuple(
                (round(x + placement.dx, 9), round(y + placement.dy, 9)) for x, y in kept
            )
            if points not in found and points[::-1] not in found:
                found[points] = Stroke(points=points)
    return list(found.values())


def thinned(way: Sequence[XY]) -> list[XY]:
    """Leave out corners that lie on the one before, as far as a plotter can tell; ends stay."""
    kept = [way[0]]
    for spot in way[1:-1]:
        if dist(spot, kept[-1]) >= limits.APART_MM:
            kept.append(spot)
    return [*kept, way[-1]]


def _findings(drawing: Drawing) -> Iterator[Finding]:
    text = (
        f"It is drawn as in {drawing.name}, and not derived from a pattern: what is proved is that "
        "the programs draw this plan, and no line twice. No ties and no register are added."
    )
    yield Finding("no-pattern", Severity.INFO, "plan", text)
    for remark in drawing.remarks:
        yield Finding("not-followed", Severity.INFO, drawing.name, remark)


def _count(lines: int) -> str:
    return f"{lines} line" if lines == 1 else f"{lines} lines"
