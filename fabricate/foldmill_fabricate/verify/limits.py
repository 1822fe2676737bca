"""Where a program sends the tool, against what the machine can reach."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.verify.interpreter import Trace
from foldmill_fabricate.verify.virtual_sheet import on_carrier


def outside(plan: Plan, name: str, trace: Trace) -> list[Finding]:
    """Name the first point that the firmware refuses, and the first that the tool cannot reach."""
    machine, sheet = plan.machine, plan.sheet
    found = []
    steps = trace.visited
    low, high = machine.axes.lowest, machine.axes.highest
    refused = np.any((steps < low) | (steps > high), axis=1)
    text = f"{{}} is outside the machine's range of {low} to {high} steps"
    found += _first("outside-range", name, trace, refused, steps, text)
    left, lead, right, trail = machine.bed.margins
    half_step = 0.5 / machine.axes.units_per_mm
    carrier = on_carrier(steps, machine.axes)
    low_end = np.array([left, lead]) - half_step
    high_end = np.array([sheet.carrier_width - right, sheet.carrier_height - trail]) + half_step
    beyond = np.any((carrier < low_end) | (carrier > high_end), axis=1)
    text = (
        f"{{}} mm is not on the carrier of {sheet.carrier_width:g} × {sheet.carrier_height:g} mm "
        f"with its margins of {left:g}, {lead:g}, {right:g} and {trail:g} mm"
    )
    return found + _first("outside-carrier", name, trace, beyond & ~refused, carrier, text)


def _first(
    code: str,
    name: str,
    trace: Trace,
    where: NDArray[np.bool_],
    points: NDArray[np.float64],
    text: str,
) -> list[Finding]:
    faulty = np.flatnonzero(where)
    if not len(faulty):
        return []
    k = int(faulty[0])
    x, y = points[k]
    more = f", and {len(faulty) - 1} more points" if len(faulty) > 1 else ""
    message = f"The point {text.format(f'({x:.6g}, {y:.6g})')}{more}."
    place = f"{name}, byte {trace.bytes[k]}"
    return [Finding(code, Severity.ERROR, place, message, "Nothing may be sent there.")]
