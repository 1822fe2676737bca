"""Closed strokes begin where that saves travel, and what lies inside one is drawn before it."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from slit_forms import form

from foldmill_fabricate import shelf
from foldmill_fabricate.passes import Operation, Role, Stroke
from foldmill_fabricate.plan import make
from foldmill_fabricate.toolpath import closed, order
from foldmill_fabricate.toolpath.traversal import traversal

MACHINE = "generic-hpgl-600"


def rim(x: float, y: float, size: float, corners: int = 4, piece: int = 0) -> Stroke:
    angles = 2 * np.pi * np.arange(corners) / corners
    points = [(x + size * float(np.cos(a)), y + size * float(np.sin(a))) for a in angles]
    return Stroke(points=(*points, points[0]), piece=piece)


def line(*points: tuple[float, float]) -> Stroke:
    return Stroke(points=points)


def length(strokes: list[Stroke], start: np.ndarray, repeats: int) -> float:
    """Add up the hops, following each stroke as the tool does."""
    operation = Operation(role=Role.CUT_INNER, repeats=repeats, strokes=())
    return order.travel([traversal(stroke, operation) for stroke in strokes], start)


@given(st.integers(0, 10_000), st.integers(1, 4), st.sampled_from([1, 2]))
def test_no_other_starts_of_closed_strokes_travel_less(seed: int, count: int, repeats: int) -> None:
    rng = np.random.default_rng(seed)
    strokes = [
        rim(float(rng.uniform(0, 100)), float(rng.uniform(0, 100)), 8.0, int(rng.integers(3, 6)))
        if rng.random() < 0.7
        else line(*map(tuple, rng.uniform(0, 100, (2, 2)).tolist()))
        for _ in range(count)
    ]
    found = closed.begun(strokes, np.zeros(2), repeats % 2 == 0)
    choices = [
        [Stroke(points=(*s.points[k:-1], *s.points[: k + 1])) for k in range(len(s.points) - 1)]
        if s.closed
        else [s]
        for s in strokes
    ]
    best = min(length(list(way), np.zeros(2), repeats) for way in product(*choices))
    assert length(found, np.zeros(2), repeats) == pytest.approx(best)


def test_a_stroke_begun_elsewhere_is_the_same_stroke() -> None:
    before = rim(50, 50, 10, 7, piece=3)
    (after,) = closed.begun([before], np.array([0.0, 50.0]), returns=False)
    assert after.closed
    assert after.piece == 3
    assert after.points[0][0] == pytest.approx(min(x for x, _ in before.points))
    sides = [set(zip(s.points, s.points[1:], strict=False)) for s in (before, after)]
    assert sides[0] == sides[1]  # every side once, in the same direction


def test_an_overcut_goes_over_the_first_side_of_the_new_start() -> None:
    (stroke,) = closed.begun([rim(50, 50, 10)], np.array([50.0, 0.0]), returns=False)
    operation = Operation(role=Role.CUT_INNER, repeats=1, overcut=1.0, strokes=(stroke,))
    end = traversal(stroke, operation)[-1]
    first, second = np.array(stroke.points[:2])
    assert stroke.points[0] == pytest.approx((50, 40))
    assert end == pytest.approx(first + (second - first) / np.hypot(*(second - first)))


@pytest.mark.parametrize("repeats", [1, 2])
def test_inner_comes_before_outer_however_deep_and_however_far(repeats: int) -> None:
    nest = [rim(0, 0, size, 12) for size in (30.0, 20.0, 10.0)]
    slot = line((-1, 0), (1, 0))
    beside = rim(100, 0, 5)
    found = order.sorted_strokes(
        [*nest, slot, beside], repeats, np.array([100.0, 0.0]), nested=True
    )
    sizes = [float(np.ptp(np.array(s.points)[:, 0])) for s in found]
    assert [s for s in sizes if s != pytest.approx(10)] == pytest.approx([2, 20, 40, 60])
    assert len(found) == 5


def test_rims_that_touch_are_inside_neither() -> None:
    square = line((0, 0), (10, 0), (10, 10), (0, 10), (0, 0))
    other = line((10, 0), (20, 0), (20, 10), (10, 10), (10, 0))
    assert closed.depths([square, other]).tolist() == [0, 0]


def test_holes_of_a_planned_sheet_are_begun_where_that_saves_travel() -> None:
    plan = make(form("star-n6", slit=False), shelf.material("pp-0.75"), shelf.machine(MACHINE))
    operation = plan.passes[0].setups[0].operations[0]
    assert operation.role is Role.HOLE
    rims = list(operation.strokes)
    right = [max(range(len(s.points) - 1), key=lambda k: s.points[k][0]) for s in rims]
    as_drawn = [
        Stroke(points=(*s.points[k:-1], *s.points[: k + 1]))
        for s, k in zip(rims, right, strict=True)
    ]
    home = np.array([-plan.sheet.dx, -plan.sheet.dy])
    assert all(stroke.closed for stroke in rims)
    assert length(rims, home, 1) < length(as_drawn, home, 1) - 1
