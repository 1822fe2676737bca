"""A verification as text that a person reads before the sheet is loaded."""

from __future__ import annotations

from foldmill.finding import Severity
from foldmill_fabricate.verify.asked import FACES
from foldmill_fabricate.verify.verification import Verification


def report(verification: Verification) -> str:
    """Return figures, findings and verdict; plain text, the same for the same verification."""
    figures = verification.figures
    title = f"Verification of {verification.title}" if verification.title else "Verification"
    pattern = f"{figures.mountains} mountains, {figures.valleys} valleys, {figures.flats} flats"
    lines = [
        title,
        "=" * len(title),
        "",
        f"Programs replayed     {figures.programs}",
        f"Strokes of the plan   {figures.strokes}",
        f"Largest deviation     {figures.deviation:.4f} mm of {figures.tolerance:.4f} mm allowed",
        f"Pattern               {pattern}",
    ]
    if figures.copies > 1:
        lines.append(f"Copies                {figures.copies}")
    lines += [
        f"{face.capitalize():<21} {figures.creases[face]} creases scored, "
        f"{figures.drawn[face] / 1000:.2f} m with the tool down"
        for face in FACES
    ]
    lines += [f"Holes and ties        {figures.holes} and {figures.ties}", ""]
    return "\n".join([*lines, *_findings(verification), "", _verdict(verification), ""])


def _findings(verification: Verification) -> list[str]:
    if not verification.findings:
        return ["Findings: none."]
    order = list(reversed(Severity))
    ranked = sorted(verification.findings, key=lambda finding: order.index(finding.severity))
    return ["Findings:", *(f"  {f.severity:<8} {f.code:<18} {f}" for f in ranked)]


def _verdict(verification: Verification) -> str:
    if verification.ok:
        return "Verdict: the programs draw the plan, and the plan is the pattern's. Cut it."
    errors = sum(f.severity is Severity.ERROR for f in verification.findings)
    return f"Verdict: NOT to be cut. {errors} {'error' if errors == 1 else 'errors'}."
