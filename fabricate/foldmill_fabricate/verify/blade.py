"""Where the tip of a drag knife goes when its holder goes along a line.

The tip trails the holder's axis at a fixed distance and always moves towards it: a tractrix. Along
a straight line the angle φ between blade and motion obeys tan(φ/2) = tan(φ0/2)·exp(−s/offset), so
each step is exact however long it is. With the pen up the blade keeps its direction.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import atan, pi, tan

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

STARTS = np.radians(np.arange(0.0, 360.0, 30.0))
"""(12,) rad. Directions in which a blade may point when the machine is switched on."""
_STEPS = 12.0 * np.linspace(0.0, 1.0, 97)[1:] ** 2
"""Stations along a straight line, in offsets: fine while the blade turns; after twelve offsets the
angle is 6e-6 of itself."""
_COARSE = np.where(np.arange(96) % 8 == 7, _STEPS, np.inf)
"""The same where the blade hardly turns: every eighth, the others nowhere."""
_SAME = 1e-9
"""rad. Blades that point this nearly the same way draw the same: 1e-9 mm apart at the most."""
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
    and their headings (k, n) there; the last are those before the next way. Blades that have come
    to point the same way go on as one, k = 1.
    """
    for path in paths:
        ways, turned = _drag(path, offset, headings)
        yield ways, turned
        headings = turned[:, -1]
        if np.ptp(_wrapped(headings - headings[0])) < _SAME:
            headings = headings[:1]


def _drag(path: Floats, offset: float, headings: Floats) -> tuple[Floats, Floats]:
    """Return the ways (k, n, 2) and headings (k, n) of tips along one way of the holder (m, 2)."""
    steps = np.diff(path, axis=0)
    moves = steps.any(axis=1)
    steps, starts = steps[moves], path[:-1][moves]
    lengths, courses = np.hypot(*steps.T), np.arctan2(steps[:, 1], steps[:, 0])
    left = _left(lengths, courses, offset, headings)
    coarse = (lengths < _SHORT * offset) | (np.abs(left).max(axis=0) < np.tan(_HARDLY / 2))
    owner, gone = _stations(lengths, coarse, offset)
    turned = courses[owner] + 2 * np.arctan(left[:, owner] * np.exp(-gone / offset))
    turned = np.hstack([headings[:, None], turned])
    spots = starts[owner] + (gone / lengths[owner])[:, None] * steps[owner]
    arms = np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    return np.vstack([path[:1], spots]) - offset * arms, turned


def _left(lengths: Floats, courses: Floats, offset: float, headings: Floats) -> Floats:
    """Return tan(φ0/2) (k, m) of each blade where each straight line begins."""
    fading = np.exp(-lengths / offset)
    if len(headings) == 1:
        return np.array([_one_left(courses.tolist(), fading.tolist(), float(headings[0]))])
    found = np.zeros((len(headings), len(courses)))
    for k, (course, fade) in enumerate(zip(courses.tolist(), fading.tolist(), strict=True)):
        found[:, k] = np.tan(_wrapped(headings - course) / 2)
        headings = course + 2 * np.arctan(found[:, k] * fade)
    return found


def _one_left(courses: list[float], fading: list[float], heading: float) -> list[float]:
    found = []
    for course, fade in zip(courses, fading, strict=True):
        left = tan(((heading - course + pi) % (2 * pi) - pi) / 2)
        heading = course + 2 * atan(left * fade)
        found.append(left)
    return found


def _stations(
    lengths: Floats, coarse: NDArray[np.bool_], offset: float
) -> tuple[NDArray[np.intp], Floats]:
    """Return the line (n,) of each place where tips are looked at, and how far along it, mm."""
    tables = np.where(coarse[:, None], _COARSE, _STEPS) * offset
    inside = tables < lengths[:, None]
    places = np.hstack([np.where(inside, tables, np.inf), lengths[:, None]])
    kept = np.isfinite(places)
    owner, _ = np.nonzero(kept)
    return owner, places[kept]


def _wrapped(angles: Floats) -> Floats:
    wrapped: Floats = (angles + np.pi) % (2 * np.pi) - np.pi
    return wrapped
