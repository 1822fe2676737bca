"""A short account of a plan for who stands at a terminal, and what comes next."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from foldmill.finding import has_errors
from foldmill_fabricate.cli.layout import table
from foldmill_fabricate.cli.output import figure_lines, finding_lines

if TYPE_CHECKING:
    from foldmill_fabricate.passes import Figures, Plan


def describe(plan: Plan) -> str:
    """Return a short account of a plan: set-ups, figures, findings."""
    rows = [("SET-UP", "FACE", "BEFORE IT", "STROKES", "REPEATS")]
    for work in plan.passes:
        for setup in work.setups:
            strokes = sum(len(operation.strokes) for operation in setup.operations)
            repeats = "/".join(str(r) for r in sorted({op.repeats for op in setup.operations}))
            gates = ", ".join(setup.gates) or "-"
            rows.append((f"{setup.number} {setup.name}", work.face, gates, str(strokes), repeats))
    figures = plan.figures
    facts = {
        "blank": f"{plan.sheet.width:g} × {plan.sheet.height:g} mm",
        **({"copies": str(plan.quantity)} if plan.quantity > 1 else {}),
        "turned by": f"{plan.placement.angle:g}°",
        "drawn": f"{figures.drawn / 1000:.2f} m in {figures.strokes} strokes",
        "travel": f"{figures.travel / 1000:.2f} m{least(figures)}",
        "time": f"{figures.seconds / 60:.1f} min without the operator's",
    }
    return "\n".join([table(rows), figure_lines(facts), finding_lines(plan.findings)])


def least(figures: Figures) -> str:
    """Say below what length travel is proved not to go, in any order; empty where unknown."""
    if figures.travel_gap is None:
        return ""
    return f"; no order travels less than {figures.travel_bound / 1000:.2f} m"


def next_steps(plan: Plan, folder: Path) -> str:
    """Say where a plan lies, what is on paper, and how it is sent; nothing is sent of errors."""
    if not plan.programs:
        return f"{folder}: drawings only. No programs were asked for: nothing to verify or send."
    if has_errors(list(plan.findings)):
        return f"{folder}: with errors, so that it cannot be sent. Mend them, and plan again."
    send = f"  foldmill send {folder} --port"
    return (
        f"{folder}: {len(plan.programs)} programs; print {folder / 'job-sheet.pdf'}. Next:\n"
        f"{send} sim://{plan.machine.slug} --yes  # a try on no machine\n"
        f"{send} PORT  # `foldmill plotters` lists ports"
    )
