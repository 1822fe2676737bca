"""Where the tip of a drag knife goes when its holder goes along a line.

The tip trails the holder's axis at a fixed distance and always moves towards it: a tractrix. Along
a straight line the angle φ between blade and motion obeys tan(φ/2) = tan(φ0/2)·exp(−s/offset), so
each step is exact however long it is. With the pen up the blade keeps its direction.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

STARTS = np.radians(np.arange(0.0, 360.0, 30.0))
"""(12,) rad. Directions in which a blade may point when the machine is switched on."""
_STEPS = 12.0 * np.linspace(0.0, 1.0, 97)[1:] ** 2
"""Stations along a straight line, in offsets: fine while the blade turns; after twelve offsets the
angle is 6e-6 of itself."""
_FEW = _STEPS[7::8]
"""Stations where the blade hardly turns."""
_SHORT = 0.5
"""Offsets. The tip hardly goes on along a line as short as a chord of a swivel."""
_HARDLY = 0.05
"""rad. A blade this near to its course leaves the chords between few stations by 0.006 mm."""


def tips(paths: list[Floats], offset: float, heading: float = 0.0) -> list[Floats]:
    """Return the tip's way (n, 2) for each way of the holder (m, 2), mm, in order of work.

    heading : rad, direction from tip to holder before the first; nobody knows it on a real machine.
    """
    return [ways[0] for ways, _ in dragged(paths, offset, np.array([heading]))]


def dragged(
    paths: Iterable[Floats], offset: float, headings: Floats
) -> Iterator[tuple[Floats, Floats]]:
    """Yield for each way of the holder (m, 2), mm, where tips go that point variously at first.

    headings : (k,) rad, from tip to holder before the first way. Yields the tips' ways (k, n, 2)
    and their headings (k, n) there; the last are those before the next way.
    """
    for path in paths:
        ways, turned = _drag(path, offset, headings)
        yield ways, turned
        headings = turned[:, -1]


def _drag(path: Floats, offset: float, headings: Floats) -> tuple[Floats, Floats]:
    holders, angles = [path[:1]], [headings[:, None]]
    for start, end in pairwise(path):
        length = float(np.hypot(*(end - start)))
        if length == 0:
            continue
        course = float(np.arctan2(*(end - start)[::-1]))
        astray = _wrapped(angles[-1][:, -1] - course)
        coarse = length < _SHORT * offset or np.abs(astray).max() < _HARDLY
        table = _FEW if coarse else _STEPS
        stations = np.append(table[table * offset < length] * offset, length)
        left = np.tan(astray / 2)[:, None] * np.exp(-stations / offset)
        angles.append(course + 2 * np.arctan(left))
        holders.append(start + (stations / length)[:, None] * (end - start))
    turned = np.hstack(angles)
    arms = np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    return np.vstack(holders) - offset * arms, turned


def _wrapped(angles: Floats) -> Floats:
    wrapped: Floats = (angles + np.pi) % (2 * np.pi) - np.pi
    return wrapped
