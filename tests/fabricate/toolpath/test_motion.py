"""How long motions take: a machine brakes for corners, and not where it goes straight on."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import stools
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate.machines import Motion
from foldmill_fabricate.toolpath.motion import Pace, move_seconds, path_seconds, told_speed

MODEL = stools.machine().motion
points = st.tuples(st.integers(-400, 400), st.integers(-400, 400))
ways = st.lists(points, min_size=2, max_size=12).map(lambda way: np.array(way) / 10)


def with_corners(speed: float) -> Motion:
    return MODEL.model_copy(update={"corner_speed": speed})


def by_two_passes(way: np.ndarray, speed: float, model: Motion) -> float:
    """Return the time along a way, known as a whole: forwards, backwards, then piece by piece."""
    steps = [step for step in np.diff(way, axis=0) if step.any()]
    if not steps:
        return 0.0
    a, lengths = model.acceleration, [float(np.hypot(*step)) for step in steps]
    speeds = [0.0]
    for one, two in pairwise(steps):
        change = float(np.hypot(*(two / np.hypot(*two) - one / np.hypot(*one))))
        speeds.append(min(speed, model.corner_speed / change if change > 1e-12 else speed))
    speeds.append(0.0)
    for k, length in enumerate(lengths):
        speeds[k + 1] = min(speeds[k + 1], math.sqrt(speeds[k] ** 2 + 2 * a * length))
    for k, length in reversed(list(enumerate(lengths))):
        speeds[k] = min(speeds[k], math.sqrt(speeds[k + 1] ** 2 + 2 * a * length))
    total = 0.0
    for u, v, length in zip(speeds[:-1], speeds[1:], lengths, strict=True):
        peak = min(speed, math.sqrt(a * length + (u * u + v * v) / 2))
        ramps = (peak - u) / a + (peak - v) / a
        ramped = (peak * peak - u * u) / (2 * a) + (peak * peak - v * v) / (2 * a)
        total += ramps + (length - ramped) / peak
    return total


@given(ways, st.sampled_from([20.0, 80.0, 400.0]), st.sampled_from([1.0, 10.0, 200.0]))
def test_a_stroke_that_becomes_known_bit_by_bit_takes_as_long_as_one_known_whole(
    way: np.ndarray, speed: float, corner_speed: float
) -> None:
    model = with_corners(corner_speed)
    expected = by_two_passes(way, speed, model)
    assert path_seconds(way, speed, model) == pytest.approx(expected, rel=1e-6, abs=1e-9)


@given(ways, st.integers(1, 5))
def test_points_on_a_straight_line_cost_nothing(way: np.ndarray, parts: int) -> None:
    shares = np.linspace(0, 1, parts + 1)[1:, None]
    fine = [way[:1], *(a + shares * (b - a) for a, b in pairwise(way) if (a != b).any())]
    assert path_seconds(np.vstack(fine).round(9), 80.0, MODEL) == pytest.approx(
        path_seconds(way, 80.0, MODEL), rel=1e-6, abs=1e-9
    )


@given(ways)
def test_no_piece_takes_less_than_no_time_and_corners_never_save_any(way: np.ndarray) -> None:
    pace = Pace(MODEL)
    charges = [pace.go_on(dx, dy, 80.0) for dx, dy in np.diff(way, axis=0).tolist()]
    assert min(charges) >= -1e-12
    lengths = np.hypot(*np.diff(way, axis=0).T)
    stops = float(move_seconds(lengths, 80.0, MODEL.acceleration).sum())
    straight = float(move_seconds([lengths.sum()], 80.0, MODEL.acceleration)[0])
    assert straight - 1e-9 <= sum(charges) <= stops + 1e-9


def test_a_circle_is_gone_round_without_stopping_and_a_saw_is_not() -> None:
    turns = np.linspace(0, 2 * np.pi, 37)
    circle = 20 * np.column_stack([np.cos(turns), np.sin(turns)])
    length = float(np.hypot(*np.diff(circle, axis=0).T).sum())
    assert path_seconds(circle, 40.0, MODEL) == pytest.approx(length / 40 + 40 / 2000, rel=1e-6)
    saw = np.array([[k, k % 2] for k in range(37)], float)
    saw_length = 36 * math.sqrt(2)
    assert path_seconds(saw, 40.0, MODEL) > 1.3 * (saw_length / 40)


def test_a_machine_comes_to_rest_between_strokes() -> None:
    pace = Pace(MODEL)
    first = pace.go_on(30.0, 0.0, 80.0)
    pace.stop()
    assert pace.go_on(30.0, 0.0, 80.0) == pytest.approx(first)


def test_the_speed_that_is_told_is_in_whole_cm_per_second() -> None:
    machine = stools.machine()
    assert [told_speed(speed, machine) for speed in (2.0, 84.0, 85.0, 120.0)] == [10, 80, 90, 120]
    dialect = machine.dialect.model_copy(update={"speed": False})
    deaf = machine.model_copy(update={"dialect": dialect})
    assert told_speed(80.0, deaf) == machine.motion.travel_speed
