"""What keeps the faces in register, derived again: pins, stops, and what the machine can do.

Holes are proved beside the part, with the waste they lie in.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Face, Plan, Stop
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.marks import prove_marks
from foldmill_fabricate.verify.planned import Planned
from foldmill_fabricate.verify.virtual_sheet import turned_over

_NAMES = {"l-marks-3": "l-marks", "l-marks-4": "l-marks"}


def prove_register(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    """Check that the plan registers as its machine can, and that what it needs is in its place."""
    plan, made = asked.plan, asked.plan.registration
    found = prove_marks(asked, strokes)
    if len(plan.passes) < 2:
        return found
    known = {_NAMES.get(kind, kind) for kind in plan.machine.marks.kinds}
    if made.kind != "none" and made.kind not in known:
        text = f"{plan.machine.slug} cannot register by {made.kind}."
        found.append(_error("registration-kind", "plan", text))
    said = {finding.code for finding in plan.findings}
    if made.kind == "none" and "no-registration" not in said:
        text = "Nothing keeps the faces in register, and the plan does not say so."
        found.append(_error("unregistered", "plan", text))
    return found + _pin_findings(plan) + _stop_findings(plan)


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def _pin_findings(plan: Plan) -> list[Finding]:
    """Check that the flipped sheet's holes lie over the pins, and the pins where they can stand."""
    made = plan.registration
    if made.kind != "pins":
        return (
            [_error("pin-place", "pins", "There are pins in a plan without.")] if made.pins else []
        )
    corner = np.array([plan.sheet.dx, plan.sheet.dy])
    holes = np.array([(hole.x, hole.y) for hole in plan.holes]).reshape(-1, 2)
    lie = turned_over(holes, plan.flip) + corner
    pins = np.array(made.pins).reshape(-1, 2)
    if len(pins) != 2 or len(lie) != 2:
        return [
            _error("pin-place", "pins", f"{len(lie)} holes for {len(pins)} pins; two are right.")
        ]
    off = float(np.hypot(*(np.sort(pins, axis=0) - np.sort(lie, axis=0)).T).max())
    found = []
    if off > tolerances.PLAN_MM:
        text = f"A hole of the flipped sheet lies {off:.2f} mm beside its pin."
        found.append(_error("pin-place", "pins", text))
    apart = float(np.hypot(*(pins[1] - pins[0])))
    if abs(apart - plan.machine.marks.pin_spacing) > tolerances.PLAN_MM:
        text = f"They are {apart:.2f} mm apart, not {plan.machine.marks.pin_spacing:g} mm."
        found.append(_error("pin-spacing", "pins", text))
    return found


def _stop_findings(plan: Plan) -> list[Finding]:
    """Check that stops touch the blank as it lies, and the same edges of it in both passes."""
    made = plan.registration
    if made.kind != "edge":
        return (
            [_error("stop-place", "stops", "There are stops in a plan without.")]
            if made.stops
            else []
        )
    found = [finding for stop in made.stops for finding in _stop_place(plan, stop)]
    touched = {face: _touched(plan, face) for face in Face}
    if touched[Face.FRONT] != touched[Face.REVERSE]:
        text = "The two passes are laid against different edges of the sheet."
        found.append(
            _error("stop-edge", "stops", text, "Then an error of the blank's size counts.")
        )
    datum = "bottom" if plan.flip.kind == "left-right" else "left"
    for face, edges in touched.items():
        if edges.count(datum) != 2 or len(edges) != 3:
            text = f"On the {face} it needs two stops along the {datum} edge and one beside it."
            found.append(_error("stop-count", "stops", text))
    return found


def _stop_place(plan: Plan, stop: Stop) -> list[Finding]:
    sheet = plan.sheet
    x, y = stop.x - sheet.dx, stop.y - sheet.dy
    gap = {"left": x, "right": sheet.width - x, "bottom": y, "top": sheet.height - y}[stop.edge]
    beyond = max(-x, -y, x - sheet.width, y - sheet.height)
    if max(abs(gap), beyond) <= tolerances.PLAN_MM:
        return []
    text = f"It stands {max(abs(gap), beyond):.2f} mm off the {stop.edge} edge of the blank."
    return [_error("stop-place", f"stop at ({stop.x:.1f}, {stop.y:.1f}) mm", text)]


def _touched(plan: Plan, face: Face) -> list[str]:
    """Return which edges of the sheet, named as on the front, touch stops in a pass."""
    swapped = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}
    moving = {"left", "right"} if plan.flip.kind == "left-right" else {"bottom", "top"}
    edges = [stop.edge for stop in plan.registration.stops if stop.face is face]
    if face is Face.REVERSE:
        edges = [swapped[edge] if edge in moving else edge for edge in edges]  # type: ignore[misc]
    return sorted(edges)
