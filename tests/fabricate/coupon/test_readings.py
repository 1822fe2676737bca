"""What bars and verniers say of a machine: scale, skew and where a flipped sheet comes to lie."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from coupons import coupon, declared
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill.errors import InvalidInput
from foldmill_fabricate.coupon.answers import Answers
from foldmill_fabricate.coupon.readings import measure
from foldmill_fabricate.ladders import Vernier
from foldmill_fabricate.machines import Machine, TwoSides
from foldmill_fabricate.passes import Plan

SCALES = st.floats(0.995, 1.005)


def answers(**read: Any) -> Answers:
    return Answers.model_validate({"read_by": "A", "read_on": "2026-05-04", **read})


def matrix(x: float, y: float, skew: float) -> np.ndarray:
    """x' = x·(u + v·tan skew), y' = y·v."""
    return np.array([[x, x * math.tan(math.radians(skew))], [0.0, y]])


class Mechanics:
    """A plotter written down once more: homogeneous matrices, both passes, exact readings."""

    def __init__(self, plan: Plan, real: np.ndarray, lies: tuple[float, float]) -> None:
        """lies : how far a flipped sheet really lies; it is turned as the machine knows."""
        axes, stored = plan.machine.axes, plan.machine.two_sides
        told = matrix(axes.scale_x, axes.scale_y, axes.skew)
        whole = np.eye(3)
        whole[:2, :2] = real @ told
        corner = _shift(plan.sheet.dx, plan.sheet.dy)
        left_right = plan.flip.kind == "left-right"
        turn = np.diag([-1.0, 1, 1] if left_right else [1.0, -1, 1])
        turn[0 if left_right else 1, 2] = 2 * plan.flip.axis
        self.front = np.linalg.inv(corner) @ whole @ corner
        same = stored.flip == plan.flip.kind
        leant = _turn(stored.angle * same)
        sheet = corner @ _shift(*lies) @ leant  # where the flipped sheet really lies
        follow = _shift(stored.dx, stored.dy) @ leant if same else np.eye(3)
        self.reverse = turn @ np.linalg.inv(sheet) @ whole @ corner @ follow @ turn

    def distance(self, a: tuple[float, float], b: tuple[float, float]) -> float:
        one, two = (self.front @ [*p, 1.0] for p in (a, b))
        return float(np.hypot(*(one - two)[:2]))

    def read(self, vernier: Vernier) -> float | None:
        """Return where the lines of both faces would meet, between lines as well."""
        k, n = (0 if vernier.axis == "x" else 1), vernier.each_way
        gaps = []
        for line in range(-n, n + 1):
            spots = []
            for drawn, place in (
                (self.front, vernier.front_pitch * line),
                (self.reverse, vernier.shift + vernier.reverse_pitch * line),
            ):
                at = [*vernier.at, 1.0]
                at[k] += place
                spots.append((drawn @ at)[k])
            gaps.append(spots[1] - spots[0])
        if not min(gaps) <= 0 <= max(gaps):
            return None
        numbers = -round(10 * vernier.shift) - np.arange(-n, n + 1)
        return float(np.interp(0.0, gaps, numbers))


def _shift(dx: float, dy: float) -> np.ndarray:
    moved = np.eye(3)
    moved[:2, 2] = dx, dy
    return moved


def _turn(angle: float) -> np.ndarray:
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def told(plan: Plan, **changes: Any) -> Plan:
    """Return the plan on a machine that was calibrated before."""
    machine: Machine = plan.machine.model_copy(update=changes)
    return plan.model_copy(update={"machine": machine})


@settings(max_examples=25)
@given(
    x=SCALES,
    y=SCALES,
    skew=st.floats(-0.1, 0.1),
    lies=st.tuples(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4)),
    before=st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)),
    angle=st.sampled_from([0.0, 0.0, 0.05, -0.03]),
    flip=st.sampled_from(["left-right", "end-over-end"]),
)
def test_exact_readings_give_the_machine_back_exactly(
    x: float,
    y: float,
    skew: float,
    lies: tuple[float, float],
    before: tuple[float, float],
    angle: float,
    flip: Any,
) -> None:
    _, plan = coupon(flip=flip)
    axes = plan.machine.axes.model_copy(update={"scale_x": 1.002, "scale_y": 0.999, "skew": 0.03})
    stored = TwoSides.model_validate(
        {"dx": before[0], "dy": before[1], "angle": angle, "flip": flip}
    )
    plan = told(plan, axes=axes, two_sides=stored)
    made = Mechanics(plan, matrix(x, y, skew), lies)
    bars = declared(plan).bars
    (left, low), w, h = bars.at, bars.width, bars.height
    a, b, c, d = (left, low), (left + w, low), (left + w, low + h), (left, low + h)
    lengths = {"ab": (a, b), "ad": (a, d), "ac": (a, c), "bd": (b, d)}
    numbers = {}
    for vernier in declared(plan).verniers:
        number = made.read(vernier)
        if number is not None:
            numbers[vernier.axis] = number
    if set(numbers) != {"x", "y"}:
        return  # further off than any vernier reads: the bars are recorded alone
    read = answers(
        bars={name: made.distance(*ends) for name, ends in lengths.items()}, vernier=numbers
    )
    found = measure(plan, declared(plan), read)
    calibrated = matrix(found.scale_x, found.scale_y, found.skew)
    assert matrix(x, y, skew) @ calibrated == pytest.approx(np.eye(2), abs=2e-6)
    assert (found.dx, found.dy) == pytest.approx(lies, abs=3e-4)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_where_one_vernier_was_read_the_other_axis_stays_as_it_was(axis: str) -> None:
    _, plan = coupon()
    stored = TwoSides.model_validate({"dx": 0.2, "dy": -0.1, "angle": 0.05})
    plan = told(plan, two_sides=stored)
    k = 0 if axis == "x" else 1
    lies = (0.35, -0.1) if k == 0 else (0.2, -0.3)
    made = Mechanics(plan, np.eye(2), lies)
    own = [made.read(each) for each in declared(plan).verniers if each.axis == axis]
    [number] = [each for each in own if each is not None]
    found = measure(plan, declared(plan), answers(vernier={axis: number}))
    wanted: list[Any] = [None, None]
    wanted[k] = pytest.approx(lies[k], abs=1e-3)
    assert [found.dx, found.dy] == wanted


def test_a_machine_without_a_fault_is_left_as_it_is() -> None:
    _, plan = coupon()
    bars = declared(plan).bars
    across = math.hypot(bars.width, bars.height)
    lengths = {"ab": bars.width, "ad": bars.height, "ac": across, "bd": across}
    found = measure(plan, declared(plan), answers(bars=lengths, vernier={"x": 0, "y": 0}))
    assert found.scale_x == found.scale_y == 1.0
    assert (found.skew, found.dx, found.dy) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("read", "sentence"),
    [
        ({"bars": {"ab": 47.0}}, r"A to B was read as 47 mm, and 470.0 mm were drawn"),
        ({"bars": {"ab": 470, "ad": 400, "ac": 617.2, "bd": 621.2}}, "contradict each other"),
        ({"bars": {"ac": 634.0, "bd": 600.0}}, r"leans by -?\d"),
        ({"bars": {"ab": 470, "ac": 617.2}}, "A to C was read without B to D"),
        ({"bars": {"bd": 617.2}}, "B to D was read without A to C"),
        ({"vernier": {"x": 51}}, "its numbers go from -50 to 50"),
        ({"vernier": {"y": -30.5}}, "record the bars alone"),
    ],
)
def test_readings_that_cannot_be_right_are_refused_with_a_sentence(
    read: dict[str, Any], sentence: str
) -> None:
    _, plan = coupon()
    with pytest.raises(InvalidInput, match=sentence):
        measure(plan, declared(plan), answers(**read))
