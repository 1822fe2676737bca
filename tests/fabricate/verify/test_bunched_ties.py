"""Ties hold a part all round it; a plan whose ties are all on one side is refused."""

from __future__ import annotations

from itertools import pairwise

import pytest
from fabricate.verify import square_job
from fabricate.verify.corrupt_plans import replanned
from fabricate.verify.square_job import on_sheet

from foldmill.finding import Severity
from foldmill_fabricate.passes import Plan, Role, Stroke, Tie
from foldmill_fabricate.verify import verify

CORNERS = [(100, 0), (100, 100), (0, 100), (0, 0)]
HALF = 0.3
"""mm, half a tie's width."""


def with_ties(plan: Plan, places: list[float]) -> Plan:
    """Leave ties at these places along the lower side of the square, ascending, mm."""
    ways = [[(a + HALF, 0), (b - HALF, 0)] for a, b in pairwise(places)]
    ways.append([(places[-1] + HALF, 0), *CORNERS, (places[0] - HALF, 0)])
    strokes = tuple(Stroke(points=tuple(on_sheet(*spot) for spot in way)) for way in ways)
    spots = [on_sheet(place, 0) for place in places]
    passes = tuple(
        side.model_copy(
            update={
                "setups": tuple(
                    setup.model_copy(
                        update={
                            "operations": tuple(
                                op.model_copy(update={"strokes": strokes})
                                if op.role is Role.CUT_OUTER
                                else op
                                for op in setup.operations
                            )
                        }
                    )
                    for setup in side.setups
                )
            }
        )
        for side in plan.passes
    )
    ties = tuple(Tie(x=x, y=y, width=2 * HALF) for x, y in spots)
    return plan.model_copy(update={"passes": passes, "ties": ties})


def errors(plan: Plan) -> list[tuple[str, str]]:
    job = square_job.job()
    spoilt = replanned(job, lambda _: plan)
    found = verify(spoilt.plan, spoilt.pattern, spoilt.programs).findings
    return [(f.code, f.message) for f in found if f.severity is Severity.ERROR]


@pytest.mark.parametrize("places", [[30, 32, 34, 36], [10, 15, 20, 25], [10, 35, 60, 90]])
def test_ties_on_one_side_do_not_hold_a_part(places: list[float]) -> None:
    [(code, message)] = errors(with_ties(square_job.job().plan, places))
    assert code == "ties-bunched"
    away = float(message.split("nearest one is ")[1].split(" mm")[0])
    outline = 400.0
    farthest = (outline - (places[-1] - places[0])) / 2
    assert 100 < away <= farthest + 0.05
