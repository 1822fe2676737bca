"""Relief holes: a vertex too tight for its grooves is taken away, and the sheet is proved."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import stools
from slit_forms import form

from foldmill import Fold
from foldmill.finding import Severity
from foldmill_fabricate import shelf
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Operation, Plan, Role, Stroke
from foldmill_fabricate.plan import make
from foldmill_fabricate.plan.relief import diameter
from foldmill_fabricate.sheet import placed
from foldmill_fabricate.verify import verify
from foldmill_fabricate.verify.rule import prove_rule


@cache
def lampshade() -> Fold:
    return form("lampshade-n12", slit=False)


@cache
def relieved() -> Plan:
    return make(lampshade(), stools.material(), stools.machine(), relief="needed")


def errors(plan: Plan) -> set[str]:
    return {f.code for f in plan.findings if f.severity is Severity.ERROR}


def test_the_lampshade_is_too_tight_and_a_relief_hole_in_its_centre_is_the_cure() -> None:
    tight = make(lampshade(), stools.material(), stools.machine())
    assert errors(tight) == {"vertex-rule"}
    told = next(finding for finding in tight.findings if finding.code == "vertex-rule")
    assert "--relief needed" in told.remedy
    plan = relieved()
    assert not errors(plan)
    assert [hole.diameter for hole in plan.reliefs] == [2.25]
    assert verify(plan, lampshade().pattern, hpgl.write(plan, lampshade())).findings == ()


def test_relief_holes_are_cut_on_the_reverse_after_the_scores_and_before_the_outline() -> None:
    plan = relieved()
    roles = [op.role for setup in plan.passes[-1].setups for op in setup.operations]
    assert roles == [Role.SCORE, Role.RELIEF, Role.CUT_OUTER]
    assert Role.RELIEF not in {
        op.role for setup in plan.passes[0].setups for op in setup.operations
    }


def test_scores_end_at_the_rim_of_the_hole() -> None:
    plan = relieved()
    [hole] = plan.reliefs
    ends = [
        np.array(point) - (hole.x, hole.y)
        for side in plan.passes
        for setup in side.setups
        for operation in setup.operations
        if operation.role is Role.SCORE
        for stroke in operation.strokes
        for point in (stroke.points[0], stroke.points[-1])
    ]
    near = [float(np.hypot(*end)) for end in ends if np.hypot(*end) < 5]
    assert len(near) >= 6
    assert near == pytest.approx([hole.diameter / 2] * len(near))


@pytest.mark.parametrize(
    ("slug", "few", "many"),
    [("pp-0.75", 2.0, 2.25), ("pp-0.5", 2.0, 2.0), ("pp-0.8", 2.0, 2.4), ("card-250", 1.5, 1.5)],
)
def test_a_hole_is_two_and_a_half_or_three_thicknesses_wide(
    slug: str, few: float, many: float
) -> None:
    material = shelf.material(slug)
    assert [diameter(n, material) for n in (4, 5, 6, 12)] == pytest.approx([few, few, many, many])


def test_all_vertices_of_the_stool_can_be_relieved() -> None:
    fold = stools.stool()
    plan = make(fold, stools.material(), stools.machine(), relief="all")
    assert len(plan.reliefs) == 40
    spots = placed(fold.pattern.vertices, plan.placement)
    for hole in plan.reliefs:
        assert np.hypot(*(spots - (hole.x, hole.y)).T).min() < 1e-9
    assert prove_rule(plan, fold.pattern) == []


def test_relief_holes_need_a_cut_that_goes_through() -> None:
    with pytest.raises(CannotPlan, match="1 relief holes are wanted"):
        make(
            lampshade(), stools.material(), stools.machine(), relief="needed", cut="score-and-snap"
        )


def edited(plan: Plan, strokes: tuple[Stroke, ...]) -> Plan:
    def change(operation: Operation) -> Operation:
        own = operation.role is Role.RELIEF
        return operation.model_copy(update={"strokes": strokes}) if own else operation

    passes = tuple(
        side.model_copy(
            update={
                "setups": tuple(
                    s.model_copy(update={"operations": tuple(map(change, s.operations))})
                    for s in side.setups
                )
            }
        )
        for side in plan.passes
    )
    return plan.model_copy(update={"passes": passes})


def test_a_wrong_relief_hole_is_found() -> None:
    plan, pattern = relieved(), lampshade().pattern
    [hole] = plan.reliefs

    def codes(changed: Plan) -> set[str]:
        return {finding.code for finding in prove_rule(changed, pattern)}

    wide = hole.model_copy(update={"diameter": 3.0})
    aside = hole.model_copy(update={"x": hole.x + 1})
    assert {"relief-diameter", "relief-strokes"} <= codes(
        plan.model_copy(update={"reliefs": (wide,)})
    )
    assert {"relief-astray", "relief-strokes"} <= codes(
        plan.model_copy(update={"reliefs": (aside,)})
    )
    assert "no-such-relief" in codes(plan.model_copy(update={"reliefs": ()}))
    assert codes(edited(plan, ())) == {"relief-strokes"}
