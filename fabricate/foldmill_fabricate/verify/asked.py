"""What pattern, process rule and placements ask for, worked out from the pattern alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.cover import Pieces
from foldmill_fabricate.verify.laid import Laid
from foldmill_fabricate.verify.slit import Slits

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

FACES = (Face.FRONT, Face.REVERSE)
NOWHERE = -1


@dataclass(frozen=True, eq=False)
class Asked:
    """A pattern as its copies lie on the sheet, and on which face each edge is scored."""

    plan: Plan
    pattern: CreasePattern

    @cached_property
    def laid(self) -> Laid:
        """The copies of the pattern on the sheet; edges and vertices below are those of all."""
        return Laid(self.plan, self.pattern)

    @property
    def spots(self) -> Floats:
        """(V, 2) mm: the vertices of all copies on the sheet."""
        return self.laid.spots

    @cached_property
    def ends(self) -> Floats:
        """(E, 2, 2) mm: the ends of every edge on the sheet."""
        ends: Floats = self.spots[self.laid.edges]
        return ends

    def lines(self, which: Flags) -> Pieces:
        """Return the chosen edges as pieces; the number of each line is that of its edge."""
        numbers = np.flatnonzero(which)
        return Pieces(self.ends[which], numbers, np.zeros(len(numbers)))

    @cached_property
    def lengths(self) -> Floats:
        """(E,) mm."""
        lengths: Floats = np.hypot(*(self.ends[:, 1] - self.ends[:, 0]).T)
        return lengths

    def has(self, assignment: Assignment) -> Flags:
        """Tell which edges carry an assignment; of a slit the first bank is an inner cut.

        The second bank is nothing any more: a slit is one line.
        """
        given = np.asarray(self.laid.assignments == assignment) & ~self.slits.second
        if assignment is Assignment.B:
            return given & ~self.slits.first
        return given | self.slits.first if assignment is Assignment.C else given

    @property
    def slits(self) -> Slits:
        """The slits of the pattern."""
        return self.laid.slits

    @cached_property
    def mouths(self) -> Floats:
        """(k, 2) mm: where inner cuts come out at the outline, on the sheet."""
        nodes = self.slits.node[self.laid.edges]
        found = np.intersect1d(nodes[self.has(Assignment.C)], nodes[self.rim])
        mouths: Floats = self.spots[found]
        return mouths

    @cached_property
    def score_face(self) -> NDArray[np.int8]:
        """(E,) 0 where an edge is scored on the front, 1 on the reverse, -1 on neither.

        A half-cut opens on the outside of the fold: mountains on the front, valleys on the reverse.
        What goes on the inside is the opposite; what works either way is done on the reverse.
        """
        score = self.plan.material.score
        mountain, valley = {"outside": (0, 1), "inside": (1, 0), "either": (1, 1)}[score.score_face]
        folds = np.abs(self.laid.fold_angles) >= score.min_scored_angle
        face = np.full(len(self.laid.edges), NOWHERE, np.int8)
        face[self.has(Assignment.M) & folds] = mountain
        face[self.has(Assignment.V) & folds] = valley
        if self.plan.unassigned in FACES:
            face[self.has(Assignment.U)] = FACES.index(Face(self.plan.unassigned))
        return face

    @cached_property
    def loops(self) -> list[Indices]:
        """The vertices (n,) of each copy's outline, past the mouths of slits."""
        banks = self.slits.node[self.laid.edges[self.slits.first]]
        inside = {frozenset(bank) for bank in banks.tolist()}
        found = []
        for outline in self.laid.outlines:
            nodes = self.slits.node[outline]
            sides = zip(nodes.tolist(), np.roll(nodes, -1).tolist(), strict=True)
            kept = np.array([frozenset(side) not in inside for side in sides], bool)
            found.append(nodes[kept])
        return found

    @cached_property
    def rim(self) -> Flags:
        """(E,) whether an edge belongs to an outline, not to a loop within it nor to a slit."""
        found = np.zeros(len(self.laid.edges), bool)
        sides = {
            frozenset(side)
            for loop in self.loops
            for side in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)
        }
        nodes = self.slits.node[self.laid.edges]
        for edge in np.flatnonzero(self.has(Assignment.B)).tolist():
            found[edge] = frozenset(nodes[edge].tolist()) in sides
        return found

    @cached_property
    def setbacks(self) -> tuple[Floats, Floats]:
        """(E, 2) twice, mm: least and most that each end of a score stops short of its vertex.

        It stops short of vertices with paper all round where at least two scored creases meet that
        are not one groove: one straight line on one face. Where two are nearly that, either answer
        is right.
        """
        bends = self._bends()
        least = np.where(bends > tolerances.NEARLY_STRAIGHT_DEG, self._short_by(), 0.0)
        most = np.where(bends > tolerances.STRAIGHT_DEG, self._short_by(), 0.0)
        return least[self.laid.edges], most[self.laid.edges]

    @cached_property
    def stops_at(self) -> Flags:
        """(V,) whether scores stop short of a vertex."""
        stops: Flags = self._bends() > tolerances.STRAIGHT_DEG
        return stops

    def _short_by(self) -> Floats:
        """Return how far scores stop short of each vertex (V,) if they do: in a hole, its radius.

        A plan that says a hole is where none belongs is told so elsewhere.
        """
        short = np.full(len(self.spots), self.plan.material.score.setback)
        for hole in self.plan.reliefs:
            near = np.hypot(*(self.spots - (hole.x, hole.y)).T) <= tolerances.PLAN_MM
            short[near] = hole.diameter / 2
        return short

    def _bends(self) -> Floats:
        """Return for each vertex (V,) by how many degrees its scored creases miss one groove."""
        scored = self.score_face != NOWHERE
        edges = self.slits.node[self.laid.edges[scored]]
        steps = self.spots[edges[:, 1]] - self.spots[edges[:, 0]]
        steps /= np.hypot(*steps.T)[:, None]
        count = np.bincount(edges.ravel(), minlength=len(self.spots))
        sums = np.zeros_like(self.spots)
        np.add.at(sums, edges[:, 0], steps)
        np.add.at(sums, edges[:, 1], -steps)
        # two unit vectors that miss one line by β add up to a vector of length 2·sin(β/2)
        miss = np.degrees(2 * np.arcsin(np.minimum(np.hypot(*sums.T) / 2, 1.0)))
        ends_of_reverse = np.bincount(
            edges.ravel(), np.repeat(self.score_face[scored], 2), minlength=len(self.spots)
        )
        two_faces = (ends_of_reverse > 0) & (ends_of_reverse < count)
        bends = np.where((count > 2) | two_faces, 180.0, np.where(count == 2, miss, 0.0))
        result: Floats = np.where(self._surrounded(), bends, 0.0)[self.slits.node]
        return result

    def _surrounded(self) -> Flags:
        """Tell which places (V,) have paper all round: not at a border, or at the end of a cut."""
        nodes, size = self.slits.node[self.laid.edges], len(self.spots)
        at_border = np.bincount(nodes[self.has(Assignment.B)].ravel(), minlength=size) > 0
        cuts = np.bincount(nodes[self.has(Assignment.C)].ravel(), minlength=size)
        surrounded: Flags = ~at_border & (cuts < 2)
        return surrounded

    def name(self, edge: int) -> str:
        """Name an edge for people."""
        copy, own = self.laid.split(edge)
        a, b = self.pattern.edges[own]
        x, y = self.ends[edge].mean(axis=0)
        kinds = {"M": "mountain", "V": "valley", "F": "flat", "B": "outline", "C": "inner cut"}
        kind = kinds.get(Assignment(int(self.laid.assignments[edge])).name, "unassigned")
        kind = "slit" if self.slits.first[edge] else kind
        of = f" of copy {copy + 1}" if self.laid.count > 1 else ""
        return f"{kind} edge {own} ({a}-{b}){of} at ({x:.2f}, {y:.2f}) mm"
