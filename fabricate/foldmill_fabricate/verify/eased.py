"""Where a tie may lie nearer to a corner than the material asks for.

Only where the outline leaves no choice: in the middle of a stretch that is too short for a tie as
asked for, with its own width cut on either side of it, and further than a quarter of a pitch along
the outline from any place where one could be. A stretch goes from corner to corner, or to where a
crease ends or an inner cut comes out. The outline is walked in small steps to find that out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment
from foldmill_fabricate.materials import ThroughCut
from foldmill_fabricate.passes import Tie
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

LEAST_TIES = 3
"""With fewer the part swings about the last one."""


@dataclass(frozen=True, eq=False)
class Eased:
    """An outline of a job as something to walk along, in mm from its first vertex."""

    asked: Asked
    cut: ThroughCut
    loop: Indices
    """The vertices (n,) of one copy's outline."""

    def objection(self, tie: Tie) -> str:
        """Return why a tie so near to a corner is wrong; empty where there is no better place."""
        place, stops = self._place(tie), self._stops
        before, after = (place - stops) % self._whole, (stops - place) % self._whole
        low, high = float(before.min()), float(after.min())
        least = 1.5 * tie.width - tolerances.UNEVEN_MM
        if min(low, high) < least:
            return f"less than its own width of {tie.width:g} mm is cut beside it"
        if low + high > 2 * self._room + 4 * tolerances.UNEVEN_MM:
            return f"that edge has {low + high:.2f} mm, room for a tie as asked for"
        if abs(low - high) > 4 * tolerances.UNEVEN_MM:
            return "it is not in the middle of a short edge"
        good = self._good_near(place)
        return "" if good is None else f"{good:.1f} mm further is room for a tie as asked for"

    def unheld(self, ties: Sequence[Tie]) -> tuple[float, Floats] | None:
        """Return the place (2,) on a straight edge furthest from all ties, and how far it is, mm.

        None where each place at which a tie as asked for could be has one within a pitch of it.
        Along the outline; to and fro is as far as ties may be moved to lie on straight edges.
        """
        whole = self._whole
        pitch = whole / max(LEAST_TIES, round(whole / self.cut.tie_pitch))
        spots = self._spots_as_asked()
        if not len(spots):
            return None
        apart = np.abs(spots[:, None] - np.array([self._place(tie) for tie in ties])[None, :])
        away = np.minimum(apart, whole - apart).min(axis=1, initial=np.inf)
        if away.max() <= pitch + 2 * self.cut.tie_corner + tolerances.BESIDE_MM:
            return None
        return float(away.max()), self._at(float(spots[int(np.argmax(away))]))

    def _spots_as_asked(self) -> Floats:
        """Return the first and last place (n,) of each straight side where a tie may be, mm."""
        stops = np.sort(self._along[:-1][self._bends() | self._is_mouth()])
        runs = np.diff(np.append(stops, stops[:1] + self._whole))
        low = stops[runs > 2 * self._room] + self._room
        high = (stops + runs)[runs > 2 * self._room] - self._room
        return np.concatenate([low, (low + high) / 2, high]) % self._whole

    def _bends(self) -> Flags:
        """Tell at which vertices the outline goes on otherwise than straight."""
        rim = self.asked.spots[self.loop]
        ahead = np.roll(rim, -1, axis=0) - rim
        z = ahead[:, 0] + 1j * ahead[:, 1]
        bends: Flags = np.abs(np.degrees(np.angle(z / np.roll(z, 1)))) > tolerances.STRAIGHT_DEG
        return bends

    def _is_mouth(self) -> Flags:
        """Tell at which vertices an inner cut comes out."""
        nodes = self.asked.slits.node[self.asked.laid.edges]
        mouths: Flags = np.isin(self.loop, nodes[self.asked.has(Assignment.C)])
        return mouths

    def _at(self, place: float) -> Floats:
        """Return the point (2,) at so many mm along the outline."""
        rim = self.asked.spots[np.append(self.loop, self.loop[0])]
        return np.array([np.interp(place, self._along, rim[:, k]) for k in (0, 1)])

    @property
    def _room(self) -> float:
        """What a tie's middle keeps from a corner, mm."""
        return self.cut.tie_corner + self.cut.tie_width / 2

    def _good_near(self, place: float) -> float | None:
        """Return how far it is to a place as asked for, if any is within a quarter of a pitch."""
        reach = tolerances.NEAR_PITCHES * self.cut.tie_pitch - 4 * tolerances.UNEVEN_MM
        step = min(self.cut.tie_width, self._room) / 4
        walked = np.arange(-reach, reach, step)
        spots = (place + walked) % self._whole
        apart = np.abs(spots[:, None] - self._stops[None, :])
        free = np.minimum(apart, self._whole - apart).min(axis=1)
        good = np.abs(walked[free > self._room + 4 * tolerances.UNEVEN_MM])
        return float(good.min()) if len(good) else None

    @cached_property
    def _along(self) -> Floats:
        """(n,) mm from the first vertex to each."""
        loop = self.asked.spots[self.loop]
        steps = np.hypot(*(np.roll(loop, -1, axis=0) - loop).T)
        along: Floats = np.append(0.0, np.cumsum(steps))
        return along

    @property
    def _whole(self) -> float:
        return float(self._along[-1])

    def _place(self, tie: Tie) -> float:
        """Return where along the outline the middle of a tie lies."""
        loop = self.asked.spots[self.loop]
        course = np.roll(loop, -1, axis=0) - loop
        off = np.array([tie.x, tie.y]) - loop
        share = np.clip((off * course).sum(axis=1) / (course**2).sum(axis=1), 0.0, 1.0)
        k = int(np.argmin(np.hypot(*(off - share[:, None] * course).T)))
        return float(self._along[k] + share[k] * np.hypot(*course[k]))

    @cached_property
    def _stops(self) -> Floats:
        """(m,) mm: corners, mouths and ends of creases, along the outline."""
        loop, laid = self.loop, self.asked.laid
        creases = np.isin(laid.assignments, [Assignment.M, Assignment.V, Assignment.U])
        nodes = self.asked.slits.node[laid.edges]
        ends = np.isin(loop, nodes[creases]) | np.isin(loop, nodes[self.asked.has(Assignment.C)])
        stops: Floats = self._along[:-1][ends | self._is_corner()]
        return stops

    def _is_corner(self) -> Flags:
        """Tell at which vertices the outline turns, to and fro added up, by more than it may.

        What counts is its turning within a tie's width of the vertex: a corner may be round.
        """
        loop, width = self.asked.spots[self.loop], self.cut.tie_width
        heading = np.roll(loop, -1, axis=0) - loop
        z = heading[:, 0] + 1j * heading[:, 1]
        turns = np.abs(np.degrees(np.angle(z / np.roll(z, 1))))
        apart = np.abs(self._along[:-1, None] - self._along[None, :-1])
        near = np.minimum(apart, self._whole - apart) <= width
        corner: Flags = (near * turns[None, :]).sum(axis=1) > tolerances.CORNER_DEG
        return corner
