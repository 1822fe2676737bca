"""Scale and skew of a machine: applied last, and undone by the second proof on its own."""

from __future__ import annotations

import math

import numpy as np
import pytest
import stools
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Axes
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify
from foldmill_fabricate.verify.virtual_sheet import on_carrier

SCALES = st.floats(0.95, 1.05)


def axes(**changes: object) -> Axes:
    return Axes.model_validate({"units_per_mm": 40, **changes})


@given(x=SCALES, y=SCALES, skew=st.floats(-2, 2), swap=st.booleans())
def test_what_calibration_does_is_undone(x: float, y: float, skew: float, swap: bool) -> None:
    made = axes(scale_x=x, scale_y=y, skew=skew, swap=swap, lowest=-1000)
    spots = np.array([(10.0, 20.0), (400.0, 30.0), (123.4, 456.7)])
    steps = hpgl.steps(spots, made, "A line")
    assert on_carrier(steps, made) == pytest.approx(spots, abs=1 / 40)


def test_a_bar_that_comes_out_short_is_asked_for_longer() -> None:
    """A machine that draws 400 mm as 398.8 mm gets x × 400 / 398.8; then it draws 400 mm."""
    made = axes(scale_x=400 / 398.8)
    ends = hpgl.steps([(50.0, 50.0), (450.0, 50.0)], made, "A bar")
    really = np.ptp(ends[:, 0]) / 40 * 398.8 / 400
    assert really == pytest.approx(400, abs=1 / 40)


def test_a_machine_whose_y_leans_is_given_lines_that_lean_the_other_way() -> None:
    """Its y axis leans to the left by 0.2°, so that it draws (x - y·tan 0.2°, y)."""
    made = axes(skew=0.2)
    ends = hpgl.steps([(100.0, 0.0), (100.0, 300.0)], made, "A line") / 40
    really = ends[:, 0] - ends[:, 1] * math.tan(math.radians(0.2))
    assert really == pytest.approx([100, 100], abs=1 / 40)


def calibrated(**changes: object) -> Plan:
    machine = stools.machine()
    made = machine.axes.model_copy(update=changes)
    tuned = machine.model_copy(update={"axes": made})
    return make(stools.stool(), stools.material(), tuned)


def test_a_calibrated_plotter_draws_the_same_plan_and_verification_knows_it() -> None:
    fold = stools.stool()
    plain, tuned = stools.stool_plan(), calibrated(scale_x=1.003, scale_y=0.998, skew=0.1)
    assert tuned.passes == plain.passes
    programs = hpgl.write(tuned, fold)
    assert programs != hpgl.write(plain, fold)
    assert verify(tuned, fold.pattern, programs).ok
    codes = {finding.code for finding in verify(plain, fold.pattern, programs).findings}
    assert codes & {"scale", "displaced", "moved", "missing-stroke"}
