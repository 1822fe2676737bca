"""How slender facets are: a push back where a corner comes near to the side across from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.waterbomb.topology import Indices

Floats = NDArray[np.float64]
TINY = np.finfo(float).tiny


def altitudes(points: Floats, faces: Indices) -> tuple[Floats, Floats, Indices]:
    """Return the least altitude (n,) of each facet, its derivatives (n, 3, 3), and whose they are.

    points : (V, 3); faces : (n, 3). The corners (n, 3) come in the order of the derivatives: the
    ends of the longest side, then the corner across from it.
    """
    corners = points[faces]
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    turn = (sides.argmax(axis=1)[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(corners, turn[:, :, None], 1).transpose(1, 0, 2)
    along = b - a
    share = np.einsum("ij,ij->i", c - a, along) / np.maximum((along**2).sum(axis=1), TINY)
    rise = c - a - share[:, None] * along
    height = np.linalg.norm(rise, axis=1)
    up = rise / np.maximum(height, TINY)[:, None]
    slopes = np.stack([(share - 1)[:, None] * up, -share[:, None] * up, up], axis=1)
    return height, slopes, np.take_along_axis(faces, turn, 1)
