"""A verification as text that a person reads before the sheet is loaded."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill

from foldmill.finding import Finding, Severity
from foldmill_fabricate.verify import wording
from foldmill_fabricate.verify.asked import FACES
from foldmill_fabricate.verify.verification import Verification

WIDTH = 96
"""Letters in a line."""


def report(verification: Verification) -> str:
    """Return figures, findings and verdict; plain text, the same for the same verification."""
    figures = verification.figures
    title = f"Verification of {verification.title}" if verification.title else "Verification"
    pattern = f"{figures.mountains} mountains, {figures.valleys} valleys, {figures.flats} flats"
    lines = [
        title,
        "=" * len(title),
        _verdict(verification),
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
    again = ["", _verdict(verification)] if verification.findings else []  # a screen below it
    return "\n".join([*lines, *_findings(verification), *again, ""])


def ranked(findings: Sequence[Finding]) -> list[list[Finding]]:
    """Return findings by kind, errors first; numbered through they are those of the report."""
    worst = list(reversed(Severity))
    kinds: dict[tuple[Severity, str], list[Finding]] = {}
    for finding in findings:
        kinds.setdefault((finding.severity, finding.code), []).append(finding)
    return [kinds[key] for key in sorted(kinds, key=lambda key: worst.index(key[0]))]


def _findings(verification: Verification) -> list[str]:
    if not verification.findings:
        return ["Findings: none."]
    lines, number = ["Findings:"], 1
    for kind in ranked(verification.findings):
        lines += ["", *_kind(kind, number)]
        number += len(kind)
    return lines


def _kind(kind: list[Finding], number: int) -> list[str]:
    """Return the lines of one kind of finding: a title, each of them numbered, what to do."""
    one = kind[0]
    count = "" if kind[-1].message.endswith("more of this kind.") else f": {len(kind)}"
    lines = [f"{one.severity.upper()}  {wording.title(one.code)} ({one.code}){count}"]
    for k, finding in enumerate(kind, number):
        head = f"{k:>4}. "
        lines.append(fill(f"{head}{finding}", WIDTH, subsequent_indent=" " * len(head)))
    if not one.remedy and wording.remedy(one.code):
        lines.append(f"      To do: {wording.remedy(one.code)}")
    return lines


def _verdict(verification: Verification) -> str:
    if verification.ok and not verification.is_derived:
        return "Verdict: the programs draw the plan, which is not derived from a pattern. Cut it."
    if verification.ok:
        return "Verdict: the programs draw the plan, and the plan is the pattern's. Cut it."
    errors = sum(f.severity is Severity.ERROR for f in verification.findings)
    return f"Verdict: NOT to be cut. {errors} {'error' if errors == 1 else 'errors'}."
