"""What pattern, process rule and placement ask for, worked out from the pattern alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill_fabricate.passes import Face, Plan
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.cover import Pieces

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

FACES = (Face.FRONT, Face.REVERSE)
NOWHERE = -1


@dataclass(frozen=True, eq=False)
class Asked:
    """A pattern as it lies on the sheet, and on which face each edge is scored."""

    plan: Plan
    pattern: CreasePattern

    @cached_property
    def spots(self) -> Floats:
        """(V, 2) mm: the vertices on the sheet: turned about the pattern's origin, then shifted."""
        placement = self.plan.placement
        angle = np.radians(placement.angle)
        x, y = self.pattern.vertices.T
        return np.column_stack(
            [
                x * np.cos(angle) - y * np.sin(angle) + placement.dx,
                x * np.sin(angle) + y * np.cos(angle) + placement.dy,
            ]
        )

    @cached_property
    def ends(self) -> Floats:
        """(E, 2, 2) mm: the ends of every edge on the sheet."""
        ends: Floats = self.spots[self.pattern.edges]
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
        """Tell which edges carry an assignment."""
        return np.asarray(self.pattern.assignments == assignment)

    @cached_property
    def score_face(self) -> NDArray[np.int8]:
        """(E,) 0 where an edge is scored on the front, 1 on the reverse, -1 on neither.

        A half-cut opens on the outside of the fold: mountains on the front, valleys on the reverse.
        What goes on the inside is the opposite; what works either way is done on the reverse.
        """
        score = self.plan.material.score
        mountain, valley = {"outside": (0, 1), "inside": (1, 0), "either": (1, 1)}[score.score_face]
        folds = np.abs(self.pattern.fold_angles) >= score.min_scored_angle
        face = np.full(len(self.pattern.edges), NOWHERE, np.int8)
        face[self.has(Assignment.M) & folds] = mountain
        face[self.has(Assignment.V) & folds] = valley
        if self.plan.unassigned in FACES:
            face[self.has(Assignment.U)] = FACES.index(Face(self.plan.unassigned))
        return face

    @cached_property
    def rim(self) -> Flags:
        """(E,) whether an edge belongs to the outline, not to a loop within it."""
        border = np.flatnonzero(self.has(Assignment.B))
        found = np.zeros(len(self.pattern.edges), bool)
        loops = self.pattern.outline()
        if not loops:
            return found
        sides = {frozenset(side) for side in zip(loops[0], np.roll(loops[0], -1), strict=True)}
        for edge in border.tolist():
            found[edge] = frozenset(self.pattern.edges[edge].tolist()) in sides
        return found

    @cached_property
    def setbacks(self) -> tuple[Floats, Floats]:
        """(E, 2) twice, mm: least and most that each end of a score stops short of its vertex.

        It stops short of interior vertices where at least two scored creases meet that are not one
        groove: one straight line on one face. Where two are nearly that, either answer is right.
        """
        setback = self.plan.material.score.setback
        bends = self._bends()
        least = np.where(bends > tolerances.NEARLY_STRAIGHT_DEG, setback, 0.0)
        most = np.where(bends > tolerances.STRAIGHT_DEG, setback, 0.0)
        return least[self.pattern.edges], most[self.pattern.edges]

    def _bends(self) -> Floats:
        """Return for each vertex (V,) by how many degrees its scored creases miss one groove."""
        scored = self.score_face != NOWHERE
        edges = self.pattern.edges[scored]
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
        inner = np.zeros(len(self.spots), bool)
        inner[self.pattern.interior_vertices] = True
        result: Floats = np.where(inner, bends, 0.0)
        return result

    def name(self, edge: int) -> str:
        """Name an edge for people."""
        a, b = self.pattern.edges[edge]
        x, y = self.ends[edge].mean(axis=0)
        kinds = {"M": "mountain", "V": "valley", "F": "flat", "B": "outline", "C": "inner cut"}
        kind = kinds.get(Assignment(int(self.pattern.assignments[edge])).name, "unassigned")
        return f"{kind} edge {edge} ({a}-{b}) at ({x:.2f}, {y:.2f}) mm"
