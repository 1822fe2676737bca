"""What is reckoned of a plan before anything is cut."""

from __future__ import annotations

from foldmill_fabricate.passes.value import Value


class Share(Value):
    """What one cause adds to the error between both faces."""

    name: str
    error: float
    """mm, plus or minus."""
    because: str
    """How it comes about, for people."""


class Budget(Value):
    """How far the reverse may land from the front, at the point where it is worst."""

    shares: tuple[Share, ...]
    likely: float
    """mm; the shares are independent: the root of the sum of their squares."""
    worst: float
    """mm; all of them at once in one direction: their sum."""
    limit: float
    """mm; half the sheet's thickness."""


class Figures(Value):
    """How much work the plan is."""

    strokes: int
    lifts: int
    drawn: float
    """mm with the tool down, repeats included"""
    travel: float
    """mm with the tool up"""
    travel_bound: float
    """mm that no order of these strokes can go below; 0 where nobody looked for it"""
    seconds: float
    """by the machine's own speeds and accelerations"""

    @property
    def travel_gap(self) -> float | None:
        """mm of travel above that bound; None where nobody looked for it."""
        return round(self.travel - self.travel_bound, 3) if self.travel_bound else None
