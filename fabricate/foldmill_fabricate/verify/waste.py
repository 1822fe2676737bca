"""What is made beside the part: registration holes and the witness mark; and the blank's edges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Hole, Plan, Role
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.planned import Planned, at
from foldmill_fabricate.verify.virtual_sheet import modelled_offset, turned_over

Floats = NDArray[np.float64]


def prove_waste(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    """Check holes and witness mark, and that all is within the blank, the blank on its carrier."""
    part = _part(asked)
    found = _blank_findings(asked, strokes)
    holes = [stroke for stroke in strokes if stroke.role is Role.HOLE]
    found += _hole_strokes(asked.plan, holes)
    for k, hole in enumerate(asked.plan.holes, 1):
        found += _one_hole(asked.plan, hole, f"hole {k} at {at((hole.x, hole.y))}", part)
    found += _register(asked.plan)
    witness = [stroke for stroke in strokes if stroke.role is Role.WITNESS]
    found += _absent(asked.plan, witness)
    return found + _witness_findings(witness, part)


def _absent(plan: Plan, witness: Sequence[Planned]) -> list[Finding]:
    """Check that a sheet that is turned over has holes and a mark, or the plan says why not."""
    if len(plan.passes) < 2:
        return []
    kind, said = plan.registration.kind, {finding.code for finding in plan.findings}
    found = []
    if not plan.holes and kind in {"holes", "pins"}:
        text = "The sheet is turned over, and has no registration holes."
        found.append(_error("holes-missing", "waste", text))
    if not witness and kind != "none" and "no-witness-mark" not in said:
        text = "The sheet is turned over, and no mark shows whether it was."
        found.append(_error("witness-missing", "waste", text))
    return found


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def _part(asked: Asked) -> Any:
    """Return the parts on the sheet as one area."""
    import shapely

    return shapely.union_all(asked.laid.parts)


def _blank_findings(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    plan, sheet = asked.plan, asked.plan.sheet
    size = np.array([sheet.width, sheet.height])
    found = []
    near = min(float(asked.spots.min()), float((size - asked.spots).min()))
    if near < plan.material.part_clearance - tolerances.PLAN_MM:
        text = f"It comes to {near:.2f} mm from the blank's edge; "
        text += f"{plan.material.part_clearance:g} mm are asked for."
        found.append(_error("part-clearance", "part", text))
    for stroke in strokes:
        over = max(float(-stroke.points.min()), float((stroke.points - size).max()))
        if over > tolerances.PLAN_MM:
            text = f"It leaves the blank by {over:.2f} mm."
            found.append(_error("outside-blank", f"{stroke} at {at(stroke.points[0])}", text))
    middle = (sheet.width if plan.flip.kind == "left-right" else sheet.height) / 2
    if abs(plan.flip.axis - middle) > tolerances.PLAN_MM:
        text = f"The sheet is turned about {plan.flip.axis:g} mm; its middle is at {middle:g} mm."
        found.append(_error("flip-axis", "plan", text))
    return found + carrier_findings(plan)


def carrier_findings(plan: Plan) -> list[Finding]:
    """Check that the blank lies on its carrier, and the carrier in the machine."""
    sheet, bed = plan.sheet, plan.machine.bed
    spare = [sheet.carrier_width - sheet.width, sheet.carrier_height - sheet.height]
    over = max(-sheet.dx, -sheet.dy, sheet.dx - spare[0], sheet.dy - spare[1])
    found = []
    if over > tolerances.PLAN_MM:
        found.append(_error("blank-off-carrier", "plan", f"It sticks out by {over:.2f} mm."))
    if sheet.carrier_width > bed.width or sheet.carrier_height > bed.length:
        text = (
            f"The carrier of {sheet.carrier_width:g} × {sheet.carrier_height:g} mm is larger than "
            f"the machine's bed of {bed.width:g} × {bed.length:g} mm."
        )
        found.append(_error("carrier-too-large", "plan", text))
    return found


def _hole_strokes(plan: Plan, strokes: Sequence[Planned]) -> list[Finding]:
    """Check that each hole is cut by one stroke and each such stroke cuts a hole."""
    cut = [_hole_of(plan, stroke) for stroke in strokes]
    found = [
        _error("no-such-hole", f"{stroke} at {at(stroke.points[0])}", "It cuts no declared hole.")
        for stroke, k in zip(strokes, cut, strict=True)
        if k is None
    ]
    for k, hole in enumerate(plan.holes):
        times = cut.count(k)
        if times != 1:
            text = f"It is cut by {times} strokes, not by one."
            found.append(_error("hole-strokes", f"hole {k + 1} at {at((hole.x, hole.y))}", text))
    return found


def _hole_of(plan: Plan, stroke: Planned) -> int | None:
    """Return the hole whose rim a stroke follows once around; None for none."""
    offset = modelled_offset(plan.machine)
    return next((k for k, hole in enumerate(plan.holes) if is_rim(stroke, hole, offset)), None)


def is_rim(stroke: Planned, hole: Hole, offset: float) -> bool:
    """Tell whether a stroke follows a hole's rim once around, as a blade of this offset can."""
    arms = stroke.points - (hole.x, hole.y)
    middles = (arms[1:] + arms[:-1]) / 2
    radii = np.hypot(*np.vstack([arms, middles]).T)
    cross = arms[:-1, 0] * arms[1:, 1] - arms[:-1, 1] * arms[1:, 0]
    turn = np.abs(np.arctan2(cross, (arms[:-1] * arms[1:]).sum(axis=1)).sum())
    is_round = _is_round(radii, hole.diameter / 2, offset)
    return is_round and bool(abs(turn - 2 * np.pi) < 1e-6) and stroke.closed


def _is_round(radii: Floats, radius: float, offset: float) -> bool:
    """Tell whether corners and middles of facets lie on a circle, as well as a blade can follow.

    Where it needs long facets, they touch the circle from outside: a pin of its diameter fits.
    """
    if radius >= tolerances.FACETTED * offset:
        return bool(np.abs(radii - radius).max() <= tolerances.ROUND_MM)
    most = radius / np.cos(np.pi / tolerances.LEAST_FACETS)
    fits = radii.min() >= radius - tolerances.PLAN_MM
    return bool(fits and radii.max() <= most + tolerances.PLAN_MM)


def _one_hole(plan: Plan, hole: Hole, where: str, part: Any) -> list[Finding]:
    import shapely

    rule, sheet, radius = plan.material.holes, plan.sheet, hole.diameter / 2
    over_pins = plan.registration.kind == "pins"
    wanted = plan.machine.marks.pin_diameter if over_pins else rule.diameter
    found = []
    if abs(hole.diameter - wanted) > tolerances.PLAN_MM:
        text = f"Its diameter is {hole.diameter:g} mm, not {wanted:g} mm."
        found.append(_error("hole-diameter", where, text))
    to_edge = min(hole.x, hole.y, sheet.width - hole.x, sheet.height - hole.y) - radius
    to_part = float(shapely.distance(part, shapely.Point(hole.x, hole.y))) - radius
    for gap, least, what in (
        (to_part, rule.part_clearance, "part"),
        (to_edge, rule.edge_clearance, "blank's edge"),
    ):
        if gap < least - tolerances.PLAN_MM:
            text = f"Its rim is {gap:.2f} mm from the {what}; {least:g} mm are asked for."
            found.append(_error("hole-clearance", where, text))
    return found


def _register(plan: Plan) -> list[Finding]:
    """Check that a turned sheet shows holes where holes were, and one turned wrongly does not."""
    if not plan.holes:
        return []
    spots = np.array([(hole.x, hole.y) for hole in plan.holes])
    if not _same(turned_over(spots, plan.flip), spots):
        text = "They do not fall on each other when the sheet is turned over."
        return [_error("holes-asymmetric", "holes", text)]
    size = np.array([plan.sheet.width, plan.sheet.height])
    if _same(size - spots, spots):
        text = "They also fall on each other when the sheet is turned the wrong way."
        return [Finding("holes-symmetric", Severity.WARNING, "holes", text)]
    return []


def _same(these: Floats, those: Floats) -> bool:
    gaps = np.hypot(*(these[:, None] - those[None]).transpose(2, 0, 1))
    return bool((gaps.min(axis=1) <= tolerances.PLAN_MM).all())


def _witness_findings(strokes: Sequence[Planned], part: Any) -> list[Finding]:
    import shapely

    found = [
        _error("witness-on-part", f"{stroke} at {at(stroke.points[0])}", "It lies on the part.")
        for stroke in strokes
        if shapely.LineString(stroke.points).intersects(part)
    ]
    if strokes and _looks_alike([stroke.points for stroke in strokes]):
        where = f"witness mark at {at(strokes[0].points[0])}"
        text = "It looks alike turned or mirrored, and does not tell how the sheet lies."
        found.append(_error("witness-symmetric", where, text))
    return found


def _looks_alike(lines: Sequence[Floats]) -> bool:
    """Tell whether a mark looks the same mirrored either way, or turned by half a turn."""
    spots = np.vstack([each for line in lines for each in (line, (line[1:] + line[:-1]) / 2)])
    spots = spots - (spots.min(axis=0) + spots.max(axis=0)) / 2
    return any(_same(spots * ways, spots) for ways in ((-1, 1), (1, -1), (-1, -1)))
