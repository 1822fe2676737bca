"""Scores as strokes: without setback they go round corners where that is quicker than a lift."""

from __future__ import annotations

import pytest
from stools import machine, material, stool

from foldmill import Fold
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify


def plan_without_setback(repeats: int, **tools: object) -> tuple[Fold, Plan]:
    fold, shipped, profile = stool(), material(), machine()
    score = shipped.score.model_copy(update={"setback": 0.0, "repeats": repeats})
    own: Machine = profile.model_copy(update={"tools": profile.tools.model_copy(update=tools)})
    return fold, make(fold, shipped.model_copy(update={"score": score}), own)


@pytest.mark.parametrize("repeats", [1, 2])
@pytest.mark.parametrize("trails", [True, False])
def test_strokes_that_go_round_corners_are_proved_like_straight_ones(
    repeats: int, trails: bool
) -> None:
    fold, plan = plan_without_setback(repeats, trails=trails)
    found = verify(plan, fold.pattern, hpgl.write(plan, fold))
    wrong = {finding.code for finding in found.findings}
    assert not wrong & {"moved", "missing-stroke", "extra-line", "repeats", "stroke-order"}


def test_a_pen_needs_fewer_strokes_than_a_knife() -> None:
    _, knife = plan_without_setback(1, trails=True)
    _, pen = plan_without_setback(1, trails=False)
    assert pen.figures.strokes < knife.figures.strokes
    assert pen.figures.travel_bound <= pen.figures.travel
