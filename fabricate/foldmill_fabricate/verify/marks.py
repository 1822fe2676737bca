"""Optical marks, derived again: cut once, as large as the machine looks for, laid out for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Mark, Plan, Role
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.planned import Planned, at
from foldmill_fabricate.verify.virtual_sheet import turned_over

_LAYOUTS = {
    3: {"ul": "square", "ur": "ell", "ll": "ell"},
    4: {"ul": "ell", "ur": "ell", "ll": "ell", "lr": "ell"},
}
"""Which mark stands in which corner (u upper, l lower, then left or right) of the reverse."""


def prove_marks(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    """Check optical marks: each is cut once, as declared, in its place; and the set is whole."""
    plan, marks = asked.plan, asked.plan.registration.marks
    windows = [stroke for stroke in strokes if stroke.role is Role.MARK]
    wanted = plan.registration.kind == "l-marks"
    if not marks and not windows and not wanted:
        return []
    cut = [_mark_of(marks, stroke) for stroke in windows]
    found = [
        _error("no-such-mark", f"{stroke} at {at(stroke.points[0])}", "It cuts no declared mark.")
        for stroke, k in zip(windows, cut, strict=True)
        if k is None
    ]
    for k, mark in enumerate(marks):
        where = f"mark {k + 1} at {at((mark.x, mark.y))}"
        if cut.count(k) != 1:
            text = f"It is cut by {cut.count(k)} strokes, not by one."
            found.append(_error("mark-strokes", where, text))
        found += [*_size_findings(plan, mark, where), *_room_findings(asked, mark, where)]
    return found + _layout_findings(plan) + _turn_findings(plan)


def _mark_of(marks: Sequence[Mark], stroke: Planned) -> int | None:
    """Return the mark whose rim a stroke follows once around; None for none."""
    import shapely

    if len(stroke.points) < 4 or not stroke.closed:
        return None
    area = shapely.Polygon(stroke.points)
    if not area.is_valid:
        return None
    gaps = [float(shapely.hausdorff_distance(area, _area(mark))) for mark in marks]
    return next((k for k, gap in enumerate(gaps) if gap <= tolerances.PLAN_MM), None)


def _area(mark: Mark) -> Any:
    """Return what a mark takes away: one strip along each arm."""
    import shapely

    lengths = [(mark.size, mark.width), (mark.width, mark.size)]
    return shapely.union_all(
        [
            shapely.Polygon(
                [
                    (mark.x, mark.y),
                    (mark.x + mark.across * a, mark.y),
                    (mark.x + mark.across * a, mark.y + mark.upward * b),
                    (mark.x, mark.y + mark.upward * b),
                ]
            )
            for a, b in lengths
        ]
    )


def _size_findings(plan: Plan, mark: Mark, where: str) -> list[Finding]:
    """Compare with what the machine looks for; arms no narrower than the sheet is thick."""
    machine = plan.machine.marks
    square = mark.shape == "square"
    size = machine.square if square else machine.arm
    found = []
    if abs(mark.size - size) > tolerances.PLAN_MM:
        text = f"It is {mark.size:g} mm long; the machine looks for {size:g} mm."
        found.append(_error("mark-size", where, text))
    least = size if square else max(machine.line_width, plan.material.thickness)
    most = size if square else max(least, tolerances.WINDOW_MM)
    if not least - tolerances.PLAN_MM <= mark.width <= most + tolerances.PLAN_MM:
        text = f"It is {mark.width:g} mm wide; {least:g} to {most:g} mm are right."
        found.append(_error("mark-size", where, text))
    return found


def _room_findings(asked: Asked, mark: Mark, where: str) -> list[Finding]:
    """Check that nothing but the mark is where its arms span, and that the edge is far enough."""
    import shapely

    plan, sheet = asked.plan, asked.plan.sheet
    far = np.array([mark.x + mark.across * mark.size, mark.y + mark.upward * mark.size])
    low, high = np.minimum((mark.x, mark.y), far), np.maximum((mark.x, mark.y), far)
    to_edge = min(*low, sheet.width - high[0], sheet.height - high[1])
    part = shapely.union_all(asked.laid.parts)
    to_part = float(shapely.distance(part, shapely.box(*low, *high)))
    rule = plan.material.holes.part_clearance
    return [
        _error(
            "mark-clearance", where, f"It is {gap:.2f} mm from the {what}; {least:g} are asked for."
        )
        for gap, least, what in (
            (to_part, rule, "part"),
            (to_edge, tolerances.MARK_EDGE_MM, "blank's edge"),
        )
        if gap < least - tolerances.PLAN_MM
    ]


def _layout_findings(plan: Plan) -> list[Finding]:
    """Check that the reverse shows the marks as the machine looks for them: corners of one box."""
    marks = plan.registration.marks
    layout = _LAYOUTS.get(4 if "l-marks-4" in plan.machine.marks.kinds else 3, {})
    if len(marks) != len(layout):
        text = f"There are {len(marks)} marks; the machine looks for {len(layout)}."
        return [_error("marks-missing", "marks", text)]
    corners = turned_over(np.array([(m.x, m.y) for m in marks]), plan.flip)
    tips = np.array([(m.x + m.across * m.size, m.y + m.upward * m.size) for m in marks])
    inward = turned_over(tips, plan.flip) - corners
    seen = {
        ("u" if dy < 0 else "l") + ("l" if dx > 0 else "r"): (mark.shape, x, y)
        for mark, (x, y), (dx, dy) in zip(marks, corners, inward, strict=True)
    }
    found = []
    if {place: shape for place, (shape, _, _) in seen.items()} != layout:
        text = "Seen on the reverse, the marks are not laid out as the machine looks for them."
        found.append(_error("mark-layout", "marks", text))
    left, right, low, high = (
        [(x, y)[k] for place, (_, x, y) in seen.items() if place[1 - k] == side]
        for k, side in ((0, "l"), (0, "r"), (1, "l"), (1, "u"))
    )
    if max(left, default=0) > min(right, default=0) or max(low, default=0) > min(high, default=0):
        found.append(_error("mark-layout", "marks", "Their arms point away from each other."))
    off = max(float(np.ptp(line)) for line in (left, right, low, high) if line)
    if off > tolerances.PLAN_MM:
        text = f"They are not the corners of one rectangle: {off:.3f} mm off."
        found.append(_error("mark-layout", "marks", text))
    return found


def _turn_findings(plan: Plan) -> list[Finding]:
    """Check that a sheet that is turned wrongly, or not at all, shows its marks elsewhere."""
    marks = plan.registration.marks
    if not marks:
        return []
    spots = np.array([(mark.x, mark.y) for mark in marks])
    right = turned_over(spots, plan.flip)
    size = np.array([plan.sheet.width, plan.sheet.height])
    wrong = {"not turned over": spots, "turned the other way": size - right}
    wrong["turned round"] = size - spots
    return [
        _error(
            "marks-symmetric",
            "marks",
            f"A sheet that is {how} shows its marks as the right one does.",
        )
        for how, other in wrong.items()
        if np.hypot(*(other[:, None] - right[None]).transpose(2, 0, 1)).min(axis=1).max()
        < tolerances.APART_MM
    ]


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)
