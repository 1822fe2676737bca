"""A plan of a foreign drawing: no pattern says what it must hold, so less is proved, and that said.

Proved are the order of work and its settings, that everything lies on the blank, that no line is
cut twice, and that blades are turned before they cut. That the lines are the right ones is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan, Source
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.cover import pairs, pieces
from foldmill_fabricate.verify.lead_ins import prove_turned
from foldmill_fabricate.verify.planned import Planned, at
from foldmill_fabricate.verify.process import prove_process
from foldmill_fabricate.verify.waste import carrier_findings


def prove_drawn(plan: Plan, source: Source, strokes: Sequence[Planned]) -> list[Finding]:
    """Check what can be checked without a pattern; a finding says that there is none."""
    text = (
        f"It is drawn as in {source.name}, SHA-256 {source.sha256[:12]}…, and not derived from a "
        "pattern: whether these are the right lines, nobody has proved."
    )
    return [
        Finding("no-pattern", Severity.INFO, "plan", text),
        *_role_findings(source, strokes),
        *prove_process(plan),
        *carrier_findings(plan),
        *_edge_findings(plan, strokes),
        *_twice_findings(strokes),
        *prove_turned(plan),
        *_lead_in_findings(plan, strokes),
    ]


def _error(code: str, where: str, message: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message)


def _role_findings(source: Source, strokes: Sequence[Planned]) -> list[Finding]:
    """Check that every line is of a kind that a person gave a pen."""
    given = {use.role for use in source.pens}
    return [
        _error("no-such-line", f"{stroke} at {at(stroke.points[0])}", "No pen draws such lines.")
        for stroke in strokes
        if stroke.role not in given
    ]


def _edge_findings(plan: Plan, strokes: Sequence[Planned]) -> list[Finding]:
    size = np.array([plan.sheet.width, plan.sheet.height])
    rule = plan.material.part_clearance
    found = []
    for stroke in strokes:
        gap = min(float(stroke.points.min()), float((size - stroke.points).min()))
        if gap < rule - tolerances.PLAN_MM:
            text = f"It comes to {gap:.2f} mm from the blank's edge; {rule:g} mm are asked for."
            found.append(_error("part-clearance", f"{stroke} at {at(stroke.points[0])}", text))
    return found


def _twice_findings(strokes: Sequence[Planned]) -> list[Finding]:
    """Name lines that run along each other, or along themselves."""
    drawn = pieces([stroke.points for stroke in strokes])
    along, _, i, j = pairs(drawn, drawn, tolerances.BLADE_MM).along()
    long = (i < j) & (along.lengths > tolerances.ALONG_MM)
    lines = drawn.line[i[long]].tolist()
    return [
        _error(
            "cut-twice",
            f"{strokes[line]} at {at(strokes[line].points[0])}",
            f"{length:.2f} mm of it are gone over by {strokes[other]} as well.",
        )
        for line, other, length in zip(
            lines, drawn.line[j[long]].tolist(), along.lengths[long].tolist(), strict=True
        )
    ]


def _lead_in_findings(plan: Plan, strokes: Sequence[Planned]) -> list[Finding]:
    """Check that lead-ins keep clear of every line."""
    import shapely

    lines: Any = shapely.MultiLineString([stroke.points for stroke in strokes])
    rule = plan.material.part_clearance
    found = []
    for setup in (setup for side in plan.passes for setup in side.setups if setup.lead_in):
        gap = float(shapely.distance(shapely.LineString(setup.lead_in), lines))
        if gap < rule - tolerances.PLAN_MM:
            text = f"Its lead-in is {gap:.2f} mm from a line; {rule:g} mm are asked for."
            found.append(_error("lead-in-on-part", f"set-up {setup.number}", text))
    return found
