"""Fit the reverse pass to where the registration holes are really seen after the flip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.passes import Face, Fit, Plan
from foldmill_fabricate.sheet import NOMINAL, seen_by_machine, turned

Floats = NDArray[np.float64]

CATCH = 12.0
"""mm around an expected hole within which a measured mark is taken for it: far more than a sheet is
laid askew, less than half of what a sheet turned the wrong way is off."""
SCALE = 1e-3
"""Largest difference in scale that can be temperature; more is a wrong reading."""


@dataclass(frozen=True)
class MarkFit:
    """A fit, and how well it explains the marks."""

    fit: Fit
    scale: float
    """Measured distances over expected ones, about the middle of the marks; not applied."""
    residual: float
    """mm, of the worst mark"""

    def __str__(self) -> str:
        return (
            f"shift {self.fit.dx:+.2f}, {self.fit.dy:+.2f} mm, angle {self.fit.angle:+.3f}°, "
            f"scale {self.scale:.5f}, largest residual {self.residual:.2f} mm"
        )


def fit_marks(plan: Plan, measured: Sequence[tuple[float, float]]) -> MarkFit:
    """Fit the flipped sheet to measured marks, carrier coordinates in mm, in any order.

    A rigid motion by least squares (Kabsch 1976). Raises CannotSend for fewer than two marks, a
    mark where no hole is expected, a scale no temperature explains, or a residual beyond the
    machine's tolerance.
    """
    expected, seen = _matched(plan, np.asarray(measured, float).reshape(-1, 2))
    middle, mean = expected.mean(axis=0), seen.mean(axis=0)
    a, b = expected - middle, seen - mean
    angle = float(np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum()))
    degrees = float(np.degrees(angle))
    shift = mean - turned([middle], degrees)[0]
    left = np.hypot(*(turned(expected, degrees) + shift - seen).T)
    found = MarkFit(
        Fit(angle=degrees, dx=float(shift[0]), dy=float(shift[1])),
        float(np.sqrt((b**2).sum() / (a**2).sum())),
        float(left.max()),
    )
    _believe(found, plan)
    return found


def _matched(plan: Plan, measured: Floats) -> tuple[Floats, Floats]:
    if not np.isfinite(measured).all():
        raise CannotSend("A mark is no number; measure it again.")
    if not plan.holes:
        raise CannotSend("This job has no registration holes, so that marks mean nothing to it.")
    if len(measured) < 2:
        raise CannotSend("Measure at least two registration holes; one alone shows no angle.")
    holes = seen_by_machine(plan, Face.REVERSE, [(hole.x, hole.y) for hole in plan.holes], NOMINAL)
    away = np.hypot(*(measured[:, None] - holes[None]).transpose(2, 0, 1))
    nearest = away.argmin(axis=1)
    for mark, gap in zip(measured, away.min(axis=1), strict=True):
        if gap > CATCH:
            raise CannotSend(
                f"No hole is expected near the mark ({mark[0]:.1f}, {mark[1]:.1f}) mm; the nearest "
                f"is {gap:.1f} mm away. Is the sheet turned {plan.flip.kind}, and are the marks in "
                f"carrier coordinates?"
            )
    if len(set(nearest.tolist())) < len(measured):
        raise CannotSend("Two marks were measured at the same hole; measure different ones.")
    return holes[nearest], measured


def _believe(found: MarkFit, plan: Plan) -> None:
    if abs(found.scale - 1) > SCALE:
        raise CannotSend(
            f"The marks are {100 * (found.scale - 1):+.2f} % off in scale ({found}); temperature "
            f"explains {100 * SCALE:g} %. Measure them again."
        )
    if found.residual > plan.machine.mark_tolerance:
        raise CannotSend(
            f"The marks do not fit a rigid sheet: {found}, and {plan.machine.slug} allows "
            f"{plan.machine.mark_tolerance:g} mm. Measure them again, or lay the sheet anew."
        )
