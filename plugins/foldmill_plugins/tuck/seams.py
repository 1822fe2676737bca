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
from foldmill.vectors import cross
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.corners import Corners

Floats = NDArray[np.float64]
Signs = NDArray[np.int_]

TORN = 2
"""The flap lies above at one seam and below at another: it passes through the surface between."""


def sides(blank: Blank, corners: Corners) -> Signs:
    """Return (S,) 1 for flaps below the surface, -1 above, 0 flush with it everywhere, or TORN."""
    below, above = misfits(blank, corners)
    is_below, is_above = below <= 0, above <= 0
    found: Signs = np.where(is_below | is_above, is_below.astype(int) - is_above, TORN)
    return found


def misfits(blank: Blank, corners: Corners) -> tuple[Floats, Floats]:
    """Return by how much (S,) flaps fail to lie below, and above: angles summed over seams, rad."""
    below, above = np.zeros(len(corners.t)), np.zeros(len(corners.t))
    for j in range(len(blank.above)):
        angle, width = _at_seam(blank, j, corners)
        past = np.minimum(angle, width - angle)
        short = np.where(angle > width, np.minimum(angle - width, 2 * np.pi - angle), 0.0)
        limit = np.radians(CLOSED_DEG)
        below += np.where(past > limit, past, 0.0)
        above += np.where(short > limit, short, 0.0)
    return below, above


def _at_seam(blank: Blank, j: int, corners: Corners) -> tuple[Floats, float]:
    """Return the angle (S,) of the flaps, and of the surface's other part, round a seam, rad.

    Both from 0 to 2π, counted from one part over its upper side. The seam is that between points j
    and j + 1 of the chain; there lies the flap's facet with the corner of point j (for A, of the
    first point).
    """
    start, end, beyond = blank.spatial[j], blank.spatial[j + 1], blank.above[j]
    axis = (end - start) / np.linalg.norm(end - start)
    into = _perpendicular(beyond - start, axis)
    # Counter-clockwise from above: (i-2, i-1, i) for even i, (i-2, i, i-1) for odd i.
    upward = cross(into, axis) * (1 if blank.first % 2 == 0 else -1)
    mirrored = _perpendicular(beyond - start, axis)
    mirrored = mirrored - 2 * (mirrored @ blank.across) * blank.across
    tip = corners.spots[:, max(j - 1, 0)] - start
    tip = tip - (tip @ axis)[:, None] * axis
    width = float(np.arctan2(mirrored @ upward, mirrored @ into)) % (2 * np.pi)
    with np.errstate(invalid="ignore"):
        angle = np.arctan2(tip @ upward, tip @ into) % (2 * np.pi)
    return angle, width


def _perpendicular(vector: Floats, axis: Floats) -> Floats:
    out: Floats = vector - (vector @ axis) * axis
    return out / np.linalg.norm(out)
