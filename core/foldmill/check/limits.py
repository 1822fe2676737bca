"""How exact a fold must be: as a solver is, or as a file can be.

A fold that was read from a file (its ``meta`` says ``read``) carries the decimals somebody wrote; a
fold that a design has just made carries none but those of its own arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass

from foldmill import tolerances
from foldmill.design import Fold


@dataclass(frozen=True)
class Limits:
    """What a check allows; each figure beyond it is a finding."""

    angle_sum_rad: float
    isometry: float
    fold_angle_deg: float
    seam_mm: float


MADE = Limits(
    tolerances.ANGLE_SUM_RAD,
    tolerances.ISOMETRY,
    tolerances.FLAT_DEG,
    tolerances.COINCIDENT_MM,
)
"""For what a design has just made."""
READ = Limits(
    tolerances.ANGLE_SUM_READ_RAD,
    tolerances.ISOMETRY_READ,
    tolerances.FOLD_ANGLE_READ_DEG,
    tolerances.SEAM_READ_MM,
)
"""For what was read from a file."""


def limits(fold: Fold) -> Limits:
    """Return the limits that hold for a fold, by where it comes from."""
    return READ if fold.meta.get("read") else MADE
