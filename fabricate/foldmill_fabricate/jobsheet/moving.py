"""The motion by which a form is closed, where one is known: stages of it, and angles on the way."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold, FoldedForm, FoldmillError, installed
from foldmill.folded import fold_angles
from foldmill.motion import Motion
from foldmill.tolerances import FLAT_DEG

Floats = NDArray[np.float64]

MOST_REMADE = 1200
"""Edges of a pattern that is made anew only to know how its form moves."""
SHARES = (0.25, 0.5, 0.75)
"""How far on the way from the flat sheet to the form angles are told."""
SAME = 1e-3
"""mm by which places in a file may differ from those that its family makes."""
NEARLY = 0.999
"""Share of the reach at which a form that is folded flat is drawn: there its layers are apart."""


@dataclass(frozen=True, eq=False)
class Closing:
    """A motion of the form, and whether its far end is the flat sheet."""

    motion: Motion
    opens_flat: bool

    def angles(self, fold: Fold) -> Floats:
        """Return the fold angles (len(SHARES), E) on the way from the flat sheet to the form."""
        reach = self.motion.reach
        return np.array([_angles(fold, self.motion.at(reach * (1 - s))) for s in SHARES])

    def stages(self, fold: Fold) -> list[tuple[str, Fold]]:
        """Return the form on its way, with words: from the flat sheet, or to where it ends."""
        reach, measure = self.motion.reach, self.motion.measure
        shares = (0.75, 0.5, 0.25) if self.opens_flat else (1 / 3, 2 / 3, NEARLY)
        found = []
        for share in shares:
            at = FoldedForm(self.motion.at(reach * share))
            closed = f"{100 * (1 - share):.0f} % of the way"
            read = f"{measure.name} {measure.at(reach * share):.0f} {measure.unit}".strip()
            found.append((closed if self.opens_flat else read, replace(fold, folded=at)))
        return found


def closing(fold: Fold) -> Closing | None:
    """Return how a form moves, that which opens flat first; None where nobody knows.

    A file holds no motion, so its family makes the fold anew; another one than in the file has no
    say.
    """
    moving = fold if fold.motions else _made_anew(fold)
    found = [
        Closing(motion, _is_flat(fold, motion))
        for motion in (moving.motions if moving else {}).values()
    ]
    return min(found, key=lambda each: not each.opens_flat, default=None)


def _made_anew(fold: Fold) -> Fold | None:
    made = fold.meta.get("design")
    if not made or fold.folded is None or len(fold.pattern.edges) > MOST_REMADE:
        return None
    try:
        again = installed().design(made["slug"]).run(made["params"])
    except FoldmillError:  # its family is not installed, or another version of it
        return None
    return again if _same(fold, again) else None


def _same(fold: Fold, other: Fold) -> bool:
    """Tell whether two folds are the same pattern and the same form."""
    if other.folded is None or fold.folded is None:
        return False
    if not np.array_equal(fold.pattern.edges, other.pattern.edges):
        return False
    pairs = ((fold.pattern, other.pattern), (fold.folded, other.folded))
    return all(
        one.vertices.shape == two.vertices.shape
        and np.allclose(one.vertices, two.vertices, rtol=0, atol=SAME)
        for one, two in pairs
    )


def _is_flat(fold: Fold, motion: Motion) -> bool:
    return bool(np.abs(_angles(fold, motion.at(motion.reach))).max() <= 100 * FLAT_DEG)


def _angles(fold: Fold, vertices: Floats) -> Floats:
    pattern = fold.pattern
    return fold_angles(vertices, pattern.edges, pattern.faces, pattern.edge_faces)
