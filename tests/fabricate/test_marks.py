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


def test_a_scale_that_readings_alone_can_make_is_refused_with_how_well_to_read() -> None:
    seen = expected()
    near = seen[[0, 1]] if np.hypot(*(seen[0] - seen[1])) < 470 else seen[[2, 3]]
    apart = float(np.hypot(*(near[0] - near[1])))
    off = 0.0015 * apart
    way = (near[1] - near[0]) / apart
    wide = as_marks(seen.mean(axis=0) + 1.0015 * (seen - seen.mean(axis=0)))
    with pytest.raises(CannotSend, match=r"0\.15 %.*calibrate the machine's scale"):
        fit_marks(stool_plan(), wide)
    coarse = stool_plan().machine.marks.model_copy(update={"hole_error": 0.4})
    machine = stool_plan().machine.model_copy(update={"marks": coarse})
    plan = stool_plan().model_copy(update={"machine": machine})
    with pytest.raises(CannotSend, match="lie so close together") as refused:
        fit_marks(plan, as_marks(np.array([near[0], near[1] + off * way])))
    share = 100 * 0.4 / (apart / np.sqrt(2))  # two marks: √Σr² is their distance over √2
    assert f"makes {share:.2f} % of it" in str(refused.value)
    assert f"to {0.001 * apart / np.sqrt(2) / 2:.2f} mm" in str(refused.value)


def test_the_error_of_the_scale_is_what_a_thousand_readings_show() -> None:
    plan, lot = stool_plan(), np.random.default_rng(6)
    seen = expected()
    read = seen + lot.normal(0, 0.02, (1000, *seen.shape))
    scales = [fit_marks(plan, as_marks(marks)).scale for marks in read]
    spread = np.sqrt(((seen - seen.mean(axis=0)) ** 2).sum())
    assert np.std(scales) == pytest.approx(0.02 / spread, rel=0.1)
