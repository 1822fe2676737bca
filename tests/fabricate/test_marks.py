"""Fitting the reverse to where the registration holes are seen."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stools import stool_plan

from foldmill_fabricate.errors import CannotSend
from foldmill_fabricate.marks import fit_marks
from foldmill_fabricate.passes import Face
from foldmill_fabricate.sheet import flipped, seen_by_machine, turned

Marks = list[tuple[float, float]]


def expected() -> np.ndarray:
    plan = stool_plan()
    return seen_by_machine(plan, Face.REVERSE, [(h.x, h.y) for h in plan.holes])


def as_marks(points: np.ndarray) -> Marks:
    return [(float(x), float(y)) for x, y in points]


@given(st.floats(-0.4, 0.4), st.floats(-3, 3), st.floats(-3, 3), st.permutations(range(4)))
def test_a_shifted_and_turned_sheet_is_found_again_in_any_order_of_marks(
    angle: float, dx: float, dy: float, shuffle: list[int]
) -> None:
    seen = turned(expected(), angle) + np.array([dx, dy])
    found = fit_marks(stool_plan(), as_marks(seen[shuffle]))
    assert found.residual < 1e-9
    again = seen_by_machine(
        stool_plan(), Face.REVERSE, [(h.x, h.y) for h in stool_plan().holes], found.fit
    )
    assert np.abs(again - seen).max() < 1e-9
    assert found.fit.angle == pytest.approx(angle, abs=1e-9)


def test_a_sheet_that_was_turned_the_wrong_way_is_refused() -> None:
    plan = stool_plan()
    wrong = plan.flip.model_copy(update={"kind": "end-over-end"})
    seen = flipped([(h.x, h.y) for h in plan.holes], wrong) + np.array([50.0, 50.0])
    with pytest.raises(CannotSend, match="turned over the wrong way"):
        fit_marks(plan, as_marks(seen))


def test_one_mark_is_not_enough() -> None:
    with pytest.raises(CannotSend, match="at least two"):
        fit_marks(stool_plan(), as_marks(expected()[:1]))


def test_a_mark_far_from_every_hole_is_refused_with_its_distance() -> None:
    with pytest.raises(CannotSend, match="mm away"):
        fit_marks(stool_plan(), [(300.0, 300.0), (310.0, 300.0)])


def test_a_scale_that_no_temperature_explains_is_refused() -> None:
    middle = expected().mean(axis=0)
    with pytest.raises(CannotSend, match="scale"):
        fit_marks(stool_plan(), as_marks(middle + (expected() - middle) * 1.005))


def test_a_residual_beyond_the_machine_is_refused() -> None:
    seen = expected()
    seen[0] += (1.2, -0.9)
    seen[1] += (-0.4, 0.9)
    with pytest.raises(CannotSend, match="rigid"):
        fit_marks(stool_plan(), as_marks(seen))
