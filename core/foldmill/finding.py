"""What a check has found. Checks collect findings; they do not raise."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Severity(StrEnum):
    """How bad a finding is."""

    INFO = "info"
    """Worth knowing."""
    WARNING = "warning"
    """It will work, but not as well as it could."""
    ERROR = "error"
    """It must not be made like this."""


@dataclass(frozen=True)
class Finding:
    """One observation, its place, and what to do about it."""

    code: str
    """A stable name, such as ``angle-sum``."""
    severity: Severity
    where: str
    """The place, for people: "vertex 12", "front pass", "edge 3-4 at (12.0, 40.5) mm"."""
    message: str
    """One sentence: what, and by how much."""
    remedy: str = ""
    """One sentence: what to do; empty where nothing needs to be done."""
    at: tuple[float, float] | None = None
    """The place on the sheet or in the pattern, mm, where it is one point and can be marked."""

    def __str__(self) -> str:
        place = f"{self.where}: " if self.where else ""
        return f"{place}{self.message} {self.remedy}".strip()


def has_errors(findings: tuple[Finding, ...] | list[Finding]) -> bool:
    """Tell whether any finding is an error."""
    return any(finding.severity is Severity.ERROR for finding in findings)
