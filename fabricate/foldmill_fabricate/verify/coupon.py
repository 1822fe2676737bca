"""A coupon holds what it declares: worked out again from its section of the plan, and compared.

Every stroke has to be one that the declared ladders, verniers, bars and words ask for, on its face,
with its figures; and each of those has to be there once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.ladders import Coupon
from foldmill_fabricate.passes import Plan, Role
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.coupon_cells import Wanted, cells
from foldmill_fabricate.verify.coupon_rules import prove_declared
from foldmill_fabricate.verify.coupon_signs import signs
from foldmill_fabricate.verify.planned import Planned, at
from foldmill_fabricate.verify.virtual_sheet import modelled_offset
from foldmill_fabricate.verify.waste import is_rim

Floats = NDArray[np.float64]
ELSEWHERE = (Role.HOLE, Role.WITNESS)
"""Roles that are proved with the waste."""


def prove_coupon(asked: Asked, coupon: Coupon, strokes: Sequence[Planned]) -> list[Finding]:
    """Compare what a plan draws with what its coupon declares; nothing of the builder is used."""
    plan = asked.plan
    wanted = [*cells(plan, coupon), *signs(plan, coupon)]
    given = [stroke for stroke in strokes if stroke.role not in ELSEWHERE]
    found = [*prove_declared(plan, coupon), *_compare(plan, wanted, given), *_holes(plan, coupon)]
    return [*found, *_within(asked, given)]


def _within(asked: Asked, given: Sequence[Planned]) -> list[Finding]:
    """Check that everything lies on the board, which holes and mark keep clear of."""
    low, high = asked.spots.min(axis=0), asked.spots.max(axis=0)
    return [
        _error("coupon-off-board", f"{s} at {at(s.points[0])}", "It lies beside the board.")
        for s in given
        if (s.points < low - tolerances.PLAN_MM).any()
        or (s.points > high + tolerances.PLAN_MM).any()
    ]


def _compare(plan: Plan, wanted: list[Wanted], given: list[Planned]) -> list[Finding]:
    found: list[Finding] = []
    shapes = _Shapes(plan, given)
    left = set(range(len(given)))
    for want in wanted:
        there = [k for k in shapes.like(want) if k in left]
        best = min(there, key=lambda k: len(_differences(want, given[k])), default=None)
        if best is None:
            text = f"It is not drawn on the {want.face}."
            found.append(_error("coupon-missing", want.name, text))
            continue
        left.discard(best)
        found += [
            _error("coupon-figures", want.name, text) for text in _differences(want, given[best])
        ]
    found += [
        _error("coupon-stray", f"{given[k]} at {at(given[k].points[0])}", "No ladder asks for it.")
        for k in sorted(left)
    ]
    return found


def _error(code: str, where: str, message: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message, "Make the coupon again.")


def _differences(want: Wanted, stroke: Planned) -> list[str]:
    """Return what a stroke of the right shape does otherwise than it should."""
    setup = stroke.setup
    pairs = {
        "role": (stroke.role, want.role),
        "face": (stroke.face, want.face),
        "process": (setup.process, want.process),
        "tool": (setup.tool, want.tool),
        "blade (mm)": (round(setup.exposure, 6), round(want.exposure, 6)),
        "force (gf)": (round(setup.force, 6), round(want.force, 6)),
        "speed (mm/s)": (setup.speed, want.speed),
        "repeats": (stroke.operation.repeats, want.repeats),
    }
    return [
        f"Its {what} is {given}, not {right}."
        for what, (given, right) in pairs.items()
        if given != right
    ]


class _Shapes:
    """The strokes of a plan, to be found by where they run."""

    def __init__(self, plan: Plan, strokes: list[Planned]) -> None:
        self.strokes, self.offset = strokes, modelled_offset(plan.machine)
        self.middles = np.array([_middle(stroke.points) for stroke in strokes]).reshape(-1, 2)

    def like(self, want: Wanted) -> list[int]:
        """Return the strokes that run where one is wanted, in either direction."""
        gaps = np.hypot(*(self.middles - want.middle).T)
        reach = tolerances.PLAN_MM + want.loose
        return [k for k in np.flatnonzero(gaps <= reach).tolist() if self._same(want, k)]

    def _same(self, want: Wanted, k: int) -> bool:
        stroke = self.strokes[k]
        if want.hole is not None:
            return is_rim(stroke, want.hole, self.offset)
        points = stroke.points
        if points.shape != want.points.shape:
            return False
        ways = (points, points[::-1])
        return any(bool(np.abs(way - want.points).max() <= tolerances.PLAN_MM) for way in ways)


def _middle(points: Floats) -> Floats:
    middle: Floats = (points.min(axis=0) + points.max(axis=0)) / 2
    return middle


def _holes(plan: Plan, coupon: Coupon) -> list[Finding]:
    """Compare the holes and ties that the plan lists with those of the patches."""
    found = []
    patches = [r for ladder in coupon.ladders if ladder.kind == "relief" for r in ladder.rungs]
    holes = sorted(round(rung.value, 6) for rung in patches if rung.value)
    if sorted(round(hole.diameter, 6) for hole in plan.reliefs) != holes:
        text = "The plan's list of relief holes is not that of the patches."
        found.append(_error("coupon-holes", "plan", text))
    if len(plan.ties) != 4 * len(patches):
        text = f"{len(plan.ties)} ties hold {len(patches)} patches; each needs four."
        found.append(_error("coupon-ties", "plan", text))
    return found
