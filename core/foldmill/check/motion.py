"""Does a motion pass through itself on the way, and where first?"""

from __future__ import annotations

from dataclasses import dataclass

from foldmill.check.penetration import penetrating_faces
from foldmill.design import Fold
from foldmill.folded import FoldedForm
from foldmill.motion import Motion

FINENESS = 1e-4
"""Share of the motion to which the first place of penetration is narrowed down."""


@dataclass(frozen=True)
class Scan:
    """What was seen along a motion."""

    looked_at: int
    """Places from start to reach, evenly spread."""
    free_until: float
    """Last t before the first penetration, or the motion's reach."""
    faces: tuple[int, int] | None
    """The first two facets that pass through each other; None where none do."""

    @property
    def is_free(self) -> bool:
        """Whether no facet passes through another at any place looked at."""
        return self.faces is None


def scan(fold: Fold, motion: Motion, steps: int = 48) -> Scan:
    """Look at ``steps`` + 1 even places for facets that penetrate, and narrow the first one down.

    A penetration shorter than a step can be missed.
    """
    before = 0.0
    for k in range(steps + 1):
        t = motion.reach * k / steps
        if _hit(fold, motion, t) is not None:
            first = _narrowed(fold, motion, before, t) if k else 0.0
            return Scan(k + 1, first, _hit(fold, motion, t))
        before = t
    return Scan(steps + 1, motion.reach, None)


def _hit(fold: Fold, motion: Motion, t: float) -> tuple[int, int] | None:
    pairs = penetrating_faces(fold, FoldedForm(motion.at(t)))
    return (int(pairs[0][0]), int(pairs[0][1])) if len(pairs) else None


def _narrowed(fold: Fold, motion: Motion, free: float, hit: float) -> float:
    """Halve the interval between a free place and one that is not."""
    while hit - free > FINENESS:
        middle = (free + hit) / 2
        if _hit(fold, motion, middle) is None:
            free = middle
        else:
            hit = middle
    return free
