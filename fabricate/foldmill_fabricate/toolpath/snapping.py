"""The steps of a machine to which a holder's way is rounded so that the blade's tip strays least.

A holder that is rounded point by point is off by up to half a step's diagonal, and a blade that is
turned by such chords adds to it. Here the rounded way is followed with the blade that it drags: its
true direction leads the next stroke, and where the tip strays too far, other steps nearby are
tried. The tip cannot be set down nearer than half a diagonal in general; little is added to that.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill_fabricate.machines import Axes
from foldmill_fabricate.sheet import in_steps

Floats = NDArray[np.float64]

PLAIN = 0.6
"""Steps. Where a way that is rounded point by point strays by less, no other is looked for."""
CLOSE = 0.72
"""Steps. A way that strays by less is as good as can be; where none does, more are followed."""
_ROUND = np.array([[0.5, 0.5]])
_FOUR = np.array([(x, y) for x in (0.0, 1.0) for y in (0.0, 1.0)])
_SIXTEEN = np.array([(x, y) for x in (-1.0, 0.0, 1.0, 2.0) for y in (-1.0, 0.0, 1.0, 2.0)])
LADDER = ((_ROUND, 1, PLAIN), (_FOUR, 4, CLOSE), (_FOUR, 16, CLOSE), (_SIXTEEN, 32, CLOSE))
"""What is added to a point before it is rounded down, how many ways are followed at the same time,
and the straying, in steps, with which one is content."""


class Guide(NamedTuple):
    """Where a holder should go, and where the tip should be meanwhile; mm."""

    holder: Floats
    """(n, 2)"""
    tips: Floats
    """(n, 2) where the tip should be on arrival; nan where it should only be near."""
    lines: Floats
    """(n, 2, 2, 2) two segments; on the way there the tip should be near one of them."""


@dataclass(frozen=True, eq=False)
class Grid:
    """The places a machine can go to."""

    axes: Axes

    @cached_property
    def _level(self) -> Axes:
        """Where y is counted downwards its steps lie alike, the carrier's height being whole."""
        return self.axes.model_copy(update={"top": None})

    @cached_property
    def _back(self) -> Floats:
        """(2, 2) from steps to mm."""
        return np.linalg.inv(in_steps(np.eye(2), self._level).T).astype(np.float64)

    def rounded(self, points: ArrayLike) -> Floats:
        """Return the places (n, 2) nearest to points, mm."""
        near: Floats = np.floor(in_steps(points, self._level) + 0.5) @ self._back.T
        return near

    def snapped(self, guide: Guide, offset: float, heading: float) -> tuple[Floats, float]:
        """Return places (n, 2) mm for the holder, and how the blade points after them, rad.

        heading : rad, from tip to holder before, as it truly is.
        """
        found = []
        for choices, width, content in LADDER:
            found.append(self._search(guide, offset, heading, choices, width))
            if found[-1][2] <= content / self.axes.units_per_mm:
                break
        places, after, _ = min(found, key=lambda each: each[2])
        return places, after

    def _search(
        self, guide: Guide, offset: float, heading: float, choices: Floats, width: int
    ) -> tuple[Floats, float, float]:
        """Return places, the heading after them, and how far the tip strays, mm."""
        from foldmill_fabricate.toolpath.tractrix import search

        wanted = in_steps(guide.holder, self._level)
        found = np.zeros(wanted.shape)
        blade = np.array([offset, 1 / self.axes.units_per_mm])
        states = np.tile([np.nan, np.nan, heading, 0.0, 0.0], (width, 1))
        search(wanted, guide.tips, guide.lines, choices, self._back, blade, states, found)
        return found @ self._back.T, float(states[0, 2]), float(states[0, 3])
