"""Where a slit comes out at a straight side, no tie bridges it: there a tie would hold one bank."""

from __future__ import annotations

import numpy as np
import pytest
from stools import machine, material, through_cut

from foldmill import Assignment, CreasePattern, Fold
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.sheet import placed
from foldmill_fabricate.verify import verify

SIDE = 200.0


def square(x: float, *, slit: bool) -> Fold:
    """A square whose lower side is slit at x, up to its middle, where four creases meet."""
    spots = [(x, 0), (100, 100), (0, 0), (0, SIDE), (SIDE, SIDE), (SIDE, 0), (x, 0)]
    right = 6 if slit else 0
    faces = [(2, 0, 1), (2, 1, 3), (3, 1, 4), (4, 1, 5), (5, 1, right)]
    sides = [(f[k - 1], f[k]) for f in faces for k in range(3)]
    edges = sorted({(min(side), max(side)) for side in sides})
    twice = [(a, b) in sides and (b, a) in sides for a, b in edges]
    codes = np.where(twice, Assignment.F, Assignment.B)
    count = 6 + slit
    none = np.zeros(len(edges))
    return Fold(CreasePattern(np.array(spots[:count], float), edges, codes, none, faces))  # type: ignore[arg-type]


def plan_of(fold: Fold) -> Plan:
    return make(fold, material(), machine())


def gap(plan: Plan, x: float) -> float:
    """Return how far the nearest tie is from the mouth at x, mm."""
    mouth = placed([(x, 0.0)], plan.placement)[0]
    return min(float(np.hypot(tie.x - mouth[0], tie.y - mouth[1])) for tie in plan.ties)


def tied_place() -> float:
    """Return where on the lower side a sheet without a slit has a tie."""
    plan = plan_of(square(100.0, slit=False))
    low = placed([(0.0, 0.0)], plan.placement)[0]
    return next(float(tie.x - low[0]) for tie in plan.ties if abs(tie.y - low[1]) < 1e-6)


@pytest.mark.parametrize("beside", [-6.0, -1.0, 0.0, 1.0, 6.0])
def test_a_tie_makes_way_for_the_mouth_of_a_slit(beside: float) -> None:
    x = tied_place() + beside
    fold = square(x, slit=True)
    plan = plan_of(fold)
    cut = through_cut(plan.material)
    clearance = cut.tie_corner + cut.tie_width / 2
    assert gap(plan_of(square(x, slit=False)), x) < clearance or abs(beside) > clearance
    assert gap(plan, x) >= clearance - 1e-9
    assert verify(plan, fold.pattern, hpgl.write(plan, fold)).findings == ()


def test_a_tie_over_the_mouth_is_found() -> None:
    x = tied_place()
    whole, fold = plan_of(square(x, slit=False)), square(x, slit=True)
    plan = plan_of(fold)
    wrong = plan.model_copy(update={"ties": whole.ties})
    codes = {finding.code for finding in verify(wrong, fold.pattern, {}).findings}
    assert {"tie-corner", "missing-cut", "tie-cut"} <= codes
