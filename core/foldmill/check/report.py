"""What a check says: findings for people, figures for everybody."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from foldmill.finding import Finding, Severity, has_errors
from foldmill.pattern import CreasePattern

Figure = float | int | str
NOT_CHECKED = "not checked"


@dataclass(frozen=True)
class Report:
    """The findings of one check or of several, and the figures they rest on.

    Units stand in a figure's name: ``_mm``, ``_mm2``, ``_deg``, ``_rad``; a figure that could not
    be taken is the text "not checked".
    """

    findings: tuple[Finding, ...] = ()
    figures: dict[str, Figure] = field(default_factory=dict)

    @property
    def has_errors(self) -> bool:
        """Whether any finding is an error."""
        return has_errors(self.findings)

    @classmethod
    def joined(cls, parts: Iterable[Report]) -> Report:
        """Return one report of several, in their order."""
        reports = list(parts)
        findings = tuple(finding for report in reports for finding in report.findings)
        return cls(findings, {k: v for report in reports for k, v in report.figures.items()})


def not_checked(what: str, *figures: str) -> Report:
    """Say that there is no folded form to check; never that all is well."""
    message = f"Not checked, because there is no folded form: {what}."
    finding = Finding("not-checked", Severity.INFO, "", message)
    return Report((finding,), dict.fromkeys(figures, NOT_CHECKED))


def vertex_name(pattern: CreasePattern, vertex: int) -> str:
    """Return "vertex 3 at (1.000, 2.000) mm"."""
    x, y = pattern.vertices[vertex]
    return f"vertex {vertex} at ({x:.3f}, {y:.3f}) mm"


def edge_name(pattern: CreasePattern, edge: int) -> str:
    """Return "edge 7 (3-4) at (1.000, 2.000) mm", the place being its middle."""
    a, b = pattern.edges[edge]
    x, y = pattern.vertices[[a, b]].mean(axis=0)
    return f"edge {edge} ({a}-{b}) at ({x:.3f}, {y:.3f}) mm"


def counted(count: int, one: str, many: str) -> str:
    """Return "1 edge crosses" or "3 edges cross"."""
    return f"{count} {one if count == 1 else many}"
