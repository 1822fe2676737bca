"""A rosette that is slit along one l2, from the centre through p_2, p_4 … to the outline.

The slit has no width: its two banks lie upon each other in the pattern and, as long as the form is
closed, in space. Every point of the slit is two vertices, one on each bank, which the folded form
names as seams. The centre is one vertex: the paper round it is whole up to the slit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from foldmill.axisymmetric.along_arc import FOLDING_RATE, Arc, find_reach, in_space, meridians
from foldmill.axisymmetric.rosette import HalfWedge, Rosette, Seat, VertexKey, weld
from foldmill.axisymmetric.strip import Paper, Strip
from foldmill.motion import Motion

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SlitRosette(Rosette):
    """A half wedge, mirrored and turned; open along the l2 before the first wedge.

    ``turn`` is -1 on the first bank and N - 1 on the second.
    """

    @cached_property
    def seams(self) -> Indices:
        """(S, 2) the vertices of the first and the second bank, outwards."""
        first, second = (np.flatnonzero(self._on_bank(turn)) for turn in (-1, self.half.order - 1))
        pairs: Indices = np.column_stack([first, second])
        return pairs[np.argsort(self.origin[first])]

    @cached_property
    def rim(self) -> Indices:
        """The vertices of the outline, that of the closed rosette: without the slit inside it."""
        single = self.edges[(self.edge_faces < 0).any(axis=1)]
        on_bank = (self._seated(Seat.L2) | self._seated(Seat.CENTRE))[single].all(axis=1)
        return np.setdiff1d(single[~on_bank], self.seams[:, 1])

    def _on_bank(self, turn: int) -> Flags:
        found: Flags = self._seated(Seat.L2) & (self.turn == turn)
        return found

    def _seated(self, where: Seat) -> Flags:
        found: Flags = np.array([seat is where for seat in self.half.seats])[self.origin]
        return found

    def _spread(self, spots: Floats) -> Floats:
        """Return points in the closed form: both banks at one and the same place, to the bit."""
        whole = replace(self, turn=self.turn % self.half.order)
        return whole.turned(spots, np.pi / self.half.order)


def assemble(half: HalfWedge) -> SlitRosette:
    """Weld N copies; the l2 before the first wedge stays open, and its second bank's edges last."""
    rose = weld(SlitRosette, half, _key)
    second = np.append(rose.seams[:, 1], np.flatnonzero(rose._seated(Seat.CENTRE)))
    last = np.isin(rose.edges, second).all(axis=1)
    return replace(rose, edges=np.vstack([rose.edges[~last], rose.edges[last]]))


def _key(point: int, seat: Seat, turn: int, mirrored: bool, _: int) -> VertexKey:
    if seat is Seat.CENTRE:
        return (point, 0, False)
    if seat is Seat.INSIDE:
        return (point, turn, mirrored)
    return (point, turn - (mirrored and seat is Seat.L2), False)


def motion(rose: SlitRosette, solved: Strip, branches: Mapping[int, int]) -> Motion:
    """Return the motion along the arc: φ and every branch stay, the slit opens."""
    solve = partial(meridians, solved, branches)
    arc = Arc(solved.theta, solve, partial(_reaches, solved.flat), first=0)
    reach, reason = find_reach(arc)

    def path(t: float) -> Floats:
        if t == 0:
            return rose.spatial.copy()
        theta = arc.theta * (1 - t)
        return rose.turned(in_space(solve(np.array([theta]))[0], theta, first=0), theta)

    title = "Fold flat along the arc, the slit open"
    return Motion("along-arc", title, path, reach, reason, FOLDING_RATE)


def _reaches(flat: Floats, i: int) -> float:
    return Paper.of(flat, i).h
