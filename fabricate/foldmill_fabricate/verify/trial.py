"""Proof of a test cut: its program draws the planned line and nothing else, and only in waste."""

from __future__ import annotations

import numpy as np

from foldmill import CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Fit, Plan
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.lead_ins import prove_lead_ins
from foldmill_fabricate.verify.planned import planned
from foldmill_fabricate.verify.programs import prove_programs
from foldmill_fabricate.verify.virtual_sheet import Line


def prove_trial(
    trial: Plan, plan: Plan, pattern: CreasePattern, name: str, data: bytes, fit: Fit | None
) -> tuple[Finding, ...]:
    """Return what is wrong with a test cut; nothing may be sent where there is an error.

    trial : the plan of the test cut, its program recorded; plan : that of the sheet it is cut in;
    fit : how the sheet lies. Replays the program, and keeps every drawn point out of part, holes,
    marks and everything else that is cut on the sheet.
    """
    proof = prove_programs(trial, {name: data}, fit)
    lines = [line for replay in proof.replays for line in replay.drawing.lines]
    led = prove_lead_ins(Asked(trial, pattern))
    return (*proof.findings, *led, *_in_waste(lines, Asked(plan, pattern)))


def _in_waste(lines: list[Line], asked: Asked) -> list[Finding]:
    import shapely

    plan = asked.plan
    blank = shapely.box(0, 0, plan.sheet.width, plan.sheet.height)
    holes = [shapely.Point(hole.x, hole.y).buffer(hole.diameter / 2) for hole in plan.holes]
    cuts = [shapely.LineString(stroke.points) for stroke in planned(plan)]
    room = plan.material.part_clearance
    found = []
    for line in lines:
        way = shapely.LineString(np.vstack([line.points, line.points[-1:]]))
        gaps = {"part": min(shapely.distance(way, part) for part in asked.laid.parts)}
        gaps |= {"line": min(shapely.distance(way, cut) for cut in cuts)}
        gaps |= {"hole": min((shapely.distance(way, hole) for hole in holes), default=room)}
        gaps |= {"blank's edge": shapely.distance(way, blank.exterior)}
        near = min(gaps, key=lambda what: gaps[what])
        if gaps[near] < room - 1e-6 or not blank.contains(way):
            text = f"The test cut is {gaps[near]:.2f} mm from the nearest {near}; {room:g} mm are "
            found.append(Finding("test-cut-place", Severity.ERROR, "waste", f"{text}asked for."))
    return found
