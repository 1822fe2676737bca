"""On which side of the surface does a flap lie, and in what order do its two halves?

Along the seam of a blank, A-P_i, P_i-P_{i+2} … P-B, the surface comes in from both sides of the
symmetry plane, and the flap leaves between. Going round the seam from one part of the surface over
its upper side to the other, the flap is met on the way if it lies above, else it lies below. What
turns at the seam follows: the two creases and the fold of ±180 between the flap's halves together
turn by what the surface turns there, which is within ±180. So a flap below has its halves face each
other with their upper sides, all its creases on the symmetry line are valleys seen from above; a
flap above has mountains.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill.tolerances import CLOSED_DEG
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.corners import Corners

Floats = NDArray[np.float64]
Signs = NDArray[np.int_]

TORN = 2
"""The flap lies above at one seam and below at another: it passes through the surface between."""


def sides(blank: Blank, corners: Corners) -> Signs:
    """Return (S,) 1 for flaps below the surface, -1 above, 0 flush with it everywhere, or TORN."""
    met = [_at_seam(blank, j, corners) for j in range(len(blank.above))]
    low, high = np.min(met, axis=0), np.max(met, axis=0)
    found: Signs = np.where(low * high < 0, TORN, np.sign(low + high))
    return found


def _at_seam(blank: Blank, j: int, corners: Corners) -> Signs:
    """Return (S,) 1 below, -1 above, 0 flush, at the seam between points j and j + 1 of the chain.

    There lies the flap's facet with corner t of point j (of the first point for A).
    """
    start, end, beyond = blank.spatial[j], blank.spatial[j + 1], blank.above[j]
    axis = (end - start) / np.linalg.norm(end - start)
    into = _perpendicular(beyond - start, axis)
    # Counter-clockwise from above: (i-2, i-1, i) for even i, (i-2, i, i-1) for odd i.
    upward = np.cross(into, axis) * (1 if blank.first % 2 == 0 else -1)
    mirrored = _perpendicular(beyond - start, axis)
    mirrored = mirrored - 2 * (mirrored @ blank.across) * blank.across
    tip = corners.spots[:, max(j - 1, 0)] - start
    tip = tip - (tip @ axis)[:, None] * axis
    width = float(np.arctan2(mirrored @ upward, mirrored @ into)) % (2 * np.pi)
    with np.errstate(invalid="ignore"):
        angle = np.arctan2(tip @ upward, tip @ into) % (2 * np.pi)
    limit = np.radians(CLOSED_DEG)
    on_one = (angle < limit) | (angle > 2 * np.pi - limit)
    flush = on_one | (np.abs(angle - width) < limit)
    found: Signs = np.where(flush, 0, np.where(angle < width, -1, 1))
    return found


def _perpendicular(vector: Floats, axis: Floats) -> Floats:
    out: Floats = vector - (vector @ axis) * axis
    return out / np.linalg.norm(out)
