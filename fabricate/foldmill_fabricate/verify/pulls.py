"""Where a machine holds the sheet without a mat, the tool never pushes it, only pulls.

Told from what the program does on the carrier, by the highest place along the feed that the tool
has come to since it went down: it may not fall behind that by more than rounding.
"""

from __future__ import annotations

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.verify.interpreter import Run, Trace
from foldmill_fabricate.verify.virtual_sheet import on_carrier

_STEPS = 1.01
"""Steps by which rounding may take the tool back."""


def pushed(plan: Plan, name: str, trace: Trace) -> list[Finding]:
    """Name the first stroke of a program that pushes the sheet, and count the others."""
    bed, axes = plan.machine.bed, plan.machine.axes
    if bed.pull is None:
        return []
    scale = max(axes.scale_x, axes.scale_y, 1 / axes.scale_x, 1 / axes.scale_y)
    step = _STEPS * scale / axes.units_per_mm
    back = [_back(run, plan) for run in trace.runs]
    wrong = [k for k, by in enumerate(back) if by > step]
    if not wrong:
        return []
    run = trace.runs[wrong[0]]
    (x, y), *_ = on_carrier(run.points[:1], axes).tolist()
    more = f" So do {len(wrong) - 1} more strokes." if len(wrong) > 1 else ""
    text = (
        f"The stroke from ({x:.2f}, {y:.2f}) mm on the carrier goes {back[wrong[0]]:.2f} mm "
        f"against the feed and pushes the sheet; without a mat this machine may only pull it, "
        f"{bed.pull} the sheet.{more}"
    )
    where = f"{name}, byte {run.byte}"
    return [Finding("pushes", Severity.ERROR, where, text, "Plan again for this machine.")]


def _back(run: Run, plan: Plan) -> float:
    """Return by how much a stroke falls behind along the feed at most, mm."""
    along = on_carrier(run.points, plan.machine.axes)[:, 1]
    along = along if plan.machine.bed.pull == "up" else -along
    return float((np.maximum.accumulate(along) - along).max())
