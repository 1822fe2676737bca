"""When are two folds the same shape? By how far their points lie apart, flat and folded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold
from foldmill_fabricate.pictures.render import form_of

Floats = NDArray[np.float64]


DISTINCT = 0.015
"""Share of the sheet by which at least half of the points of another shape lie elsewhere: 7.5 mm on
500 mm."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A fold's points, wherever on its axis it stands."""

    flat: Floats
    """(V, 2) mm."""
    folded: Floats
    """(V, 3) mm, the lowest at z = 0."""

    @classmethod
    def of(cls, fold: Fold) -> Shape:
        """Return the shape of a fold with a folded form."""
        spots = form_of(fold).vertices
        return cls(fold.pattern.vertices, spots - [0.0, 0.0, float(spots[:, 2].min())])

    def farthest(self, other: Shape) -> float:
        """Return how far the point that moved most lies from its place in the other, as a share of
        the larger sheet; infinite where they have other points."""
        return float(self._gaps(other).max())

    def apart(self, other: Shape) -> float:
        """Return how far at least half of all points lie from their places in the other, likewise.

        A hidden corner alone makes no other shape.
        """
        return float(np.median(self._gaps(other)))

    def _gaps(self, other: Shape) -> Floats:
        if self.flat.shape != other.flat.shape:
            return np.array([np.inf])
        size = max(float(np.ptp(one.flat, axis=0).max()) for one in (self, other))
        flat = np.linalg.norm(self.flat - other.flat, axis=1)
        folded = np.linalg.norm(self.folded - other.folded, axis=1)
        gaps: Floats = np.maximum(flat, folded) / size
        return gaps
