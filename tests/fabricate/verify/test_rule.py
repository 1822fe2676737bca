"""The rule that says which crease is scored where, for other processes and other patterns."""

from __future__ import annotations

import pytest
import stools
from fabricate.verify import square_job
from fabricate.verify.corrupt_plans import mountains_and_valleys_are_swapped

from foldmill import CreasePattern, Fold
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Plan, Stroke
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import Verification, verify
from foldmill_fabricate.verify.rule import prove_rule

SQUARE = [(0, 0), (120, 0), (120, 120), (0, 120), (60, 60)]
RIM = [(0, 1), (1, 2), (2, 3), (3, 0)]
SPOKES = [(k, 4) for k in range(4)]


def codes(plan: Plan, pattern: CreasePattern) -> set[str]:
    return {finding.code for finding in prove_rule(plan, pattern)}


def spokes(letters: str, angle: float = 90.0) -> CreasePattern:
    """A square with four creases from its middle."""
    angles = [0.0] * 4 + [{"M": -angle, "V": angle}.get(letter, 0.0) for letter in letters]
    return CreasePattern.from_lines(SQUARE, RIM + SPOKES, f"BBBB{letters}", angles)


def planned(pattern: CreasePattern, score_face: str = "outside", **options: object) -> Plan:
    material = stools.material()
    score = material.score.model_copy(update={"score_face": score_face})
    chosen = material.model_copy(update={"score": score})
    return make(Fold(pattern), chosen, stools.machine(), **options)  # type: ignore[arg-type]


def verified(plan: Plan, pattern: CreasePattern) -> Verification:
    return verify(plan, pattern, hpgl.write(plan, Fold(pattern)))


@pytest.mark.parametrize("score_face", ["outside", "inside", "either"])
@pytest.mark.parametrize("letters", ["MVMV", "VVVV", "MMMM", "MFVF", "FFFF"])
def test_the_planner_and_the_rule_agree(letters: str, score_face: str) -> None:
    pattern = spokes(letters)
    result = verified(planned(pattern, score_face), pattern)
    assert result.findings == ()


def test_a_press_that_creases_the_inside_wants_the_opposite_faces() -> None:
    job = square_job.job()
    inside = job.plan.material.score.model_copy(update={"score_face": "inside"})
    material = job.plan.material.model_copy(update={"score": inside})
    plan = job.plan.model_copy(update={"material": material})
    assert codes(plan, job.pattern) == {"swapped-faces"}
    assert codes(mountains_and_valleys_are_swapped(plan), job.pattern) == set()


def test_creases_that_hardly_fold_are_not_to_be_scored() -> None:
    pattern = spokes("MVMV", angle=5.0)
    plan = planned(pattern)
    score = plan.material.score.model_copy(update={"min_scored_angle": 10.0})
    stricter = plan.model_copy(
        update={"material": plan.material.model_copy(update={"score": score})}
    )
    assert codes(plan, pattern) == set()
    assert codes(stricter, pattern) == {"not-to-score"}


@pytest.mark.parametrize("where", ["front", "reverse", "skip"])
def test_unassigned_creases_go_where_the_plan_says(where: str) -> None:
    pattern = spokes("MVUU")
    plan = planned(pattern, unassigned=where)
    assert codes(plan, pattern) == set()
    assert "unassigned" in codes(plan.model_copy(update={"unassigned": None}), pattern)


def test_a_straight_crease_runs_through_a_vertex_and_a_bent_one_stops() -> None:
    pattern = spokes("MFMF")
    plan = planned(pattern)
    assert codes(plan, pattern) == set()
    assert codes(stopping_in_the_middle(plan), pattern) == {"missing-score"}
    bent = spokes("MMMF")
    assert codes(planned(bent), bent) == set()
    assert codes(planned(pattern), bent) >= {"setback", "missing-score"}


def stopping_in_the_middle(plan: Plan) -> Plan:
    """Break the one long score into two that stop short of its middle."""
    side = plan.passes[0]
    setup = side.setups[0]
    operation = setup.operations[0]
    (line,) = operation.strokes
    (x, y), (u, v) = line.points
    a, b = (0.49 * (u - x), 0.49 * (v - y)), (0.51 * (u - x), 0.51 * (v - y))
    broken = (
        Stroke(points=((x, y), (x + a[0], y + a[1]))),
        Stroke(points=((x + b[0], y + b[1]), (u, v))),
    )
    operation = operation.model_copy(update={"strokes": broken})
    setup = setup.model_copy(update={"operations": (operation, *setup.operations[1:])})
    side = side.model_copy(update={"setups": (setup, *side.setups[1:])})
    return plan.model_copy(update={"passes": (side, *plan.passes[1:])})
