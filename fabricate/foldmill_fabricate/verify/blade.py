"""Where the tip of a drag knife goes when its holder goes along a line.

The tip trails the holder's axis at a fixed distance and always moves towards it: a tractrix. Along
a straight line the angle φ between blade and motion obeys tan(φ/2) = tan(φ0/2)·exp(−s/offset), so
each step is exact however long it is. With the pen up the blade keeps its direction.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_STEPS = 12.0 * np.linspace(0.0, 1.0, 97)[1:] ** 2
"""Stations along a straight line, in offsets: fine while the blade turns; after twelve offsets the
angle is 6e-6 of itself."""


def tips(paths: list[Floats], offset: float, heading: float = 0.0) -> list[Floats]:
    """Return the tip's way (n, 2) for each way of the holder (m, 2), mm, in order of work.

    heading : rad, direction from tip to holder before the first; nobody knows it on a real machine.
    """
    result = []
    for path in paths:
        way, heading = _drag(path, offset, heading)
        result.append(way)
    return result


def _drag(path: Floats, offset: float, heading: float) -> tuple[Floats, float]:
    pieces = [_tip(path[:1], np.array([heading]), offset)]
    for start, end in pairwise(path):
        length = float(np.hypot(*(end - start)))
        if length == 0:
            continue
        stations = np.append(_STEPS[_STEPS * offset < length] * offset, length)
        course = float(np.arctan2(*(end - start)[::-1]))
        headings = course + _angles(heading - course, stations, offset)
        holder = start + (stations / length)[:, None] * (end - start)
        pieces.append(_tip(holder, headings, offset))
        heading = float(headings[-1])
    return np.vstack(pieces), heading


def _angles(angle: float, stations: Floats, offset: float) -> Floats:
    half = (angle + np.pi) % (2 * np.pi) - np.pi
    angles: Floats = 2 * np.arctan(np.tan(half / 2) * np.exp(-stations / offset))
    return angles


def _tip(holder: Floats, headings: Floats, offset: float) -> Floats:
    tip: Floats = holder - offset * np.column_stack([np.cos(headings), np.sin(headings)])
    return tip
