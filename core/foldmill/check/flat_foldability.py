"""Can the paper round a vertex be folded flat? Kawasaki's and Maekawa's theorems, vertex by vertex.

Both are necessary and neither is sufficient: whether layers get in each other's way is not seen
here. A form in space need not fold flat, so ``check`` does not ask this of every fold.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from foldmill.check.report import Figure, Report, vertex_name
from foldmill.design import Fold
from foldmill.finding import Finding, Severity
from foldmill.pattern import Assignment, CreasePattern, Floats, Indices
from foldmill.tolerances import KAWASAKI_DEG


@dataclass(frozen=True)
class FlatVertex:
    """What the creases of a vertex say of folding it flat."""

    vertex: int
    creases: int
    """How many of them fold."""
    kawasaki_deg: float
    """By how much every other sector angle sums to another value than 180; 180 where an odd number
    of creases folds, as then nothing alternates."""
    mountains_minus_valleys: int

    @property
    def holds(self) -> bool:
        """Whether Kawasaki and Maekawa hold: 180° each way, and two more of one kind."""
        if not self.creases:
            return True
        return self.kawasaki_deg <= KAWASAKI_DEG and abs(self.mountains_minus_valleys) == 2


def flat_vertex(points: Floats, edges: Indices, vertex: int, signs: ArrayLike) -> FlatVertex:
    """Judge an inner vertex of a flat pattern.

    points : (V, 2); edges : (E, 2);
    signs : (E,) what each edge does in the flat state: +1 valley, -1 mountain, 0 not folded.
    """
    turns = np.asarray(signs, int)
    creases = np.flatnonzero((edges == vertex).any(axis=1) & (turns != 0))
    gap = _kawasaki(points[edges[creases].sum(axis=1) - vertex] - points[vertex])
    return FlatVertex(vertex, len(creases), gap, -int(turns[creases].sum()))


def _kawasaki(rays: Floats) -> float:
    """Return the gap, deg, for creases along rays (k, 2)."""
    if not len(rays):
        return 0.0
    if len(rays) % 2:
        return 180.0
    x, y = rays.T
    around = np.sort(np.degrees(np.arctan2(y, x)))
    sectors = np.diff(around, append=around[:1] + 360)
    return abs(float(sectors[::2].sum() - sectors[1::2].sum())) / 2


def flat_foldability(fold: Fold) -> Report:
    """Judge every inner vertex by the pattern's own mountains and valleys, each folded to 180°."""
    pattern, codes = fold.pattern, fold.pattern.assignments
    signs = (codes == Assignment.V).astype(int) - (codes == Assignment.M)
    points, edges = pattern.vertices, pattern.edges
    seen = [flat_vertex(points, edges, int(v), signs) for v in pattern.interior_vertices]
    figures: dict[str, Figure] = {
        "kawasaki_deg": max((each.kawasaki_deg for each in seen), default=0.0),
        "kawasaki_limit_deg": KAWASAKI_DEG,
        "flat_foldable_vertices": sum(each.holds for each in seen),
        "inner_vertices": len(seen),
    }
    wrong = [each for each in seen if not each.holds]
    return Report(tuple(_finding(pattern, each) for each in wrong), figures)


def _finding(pattern: CreasePattern, seen: FlatVertex) -> Finding:
    if seen.kawasaki_deg > KAWASAKI_DEG:
        code, said = "kawasaki", f"every other angle sums to {seen.kawasaki_deg:.4g}° off 180°"
    else:
        more = seen.mountains_minus_valleys
        code, said = "maekawa", f"mountains less valleys are {more}, not 2 or −2"
    return Finding(
        code,
        Severity.ERROR,
        vertex_name(pattern, seen.vertex),
        f"The paper cannot be folded flat here: of {seen.creases} creases {said}.",
        "Move the vertex, or turn a mountain into a valley.",
    )
