"""Dragging the points of an axisymmetric form."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill.axisymmetric.points import LinePoint
from foldmill.handle import Handle, Space
from foldmill.tolerances import HANDLE_GAP_MM
from foldmill_plugins.rotational import DESIGN, RotationalParams

SEATED = RotationalParams(
    n=6,
    phi=90,
    points={
        1: LinePoint(a=50),
        2: LinePoint(a=50 / np.cos(np.pi / 6)),
        3: LinePoint(a=80, gamma=-70),
    },
)


def handle(params: RotationalParams, name: str) -> Handle:
    return next(each for each in DESIGN.run(params).handles if each.name == name)


@pytest.mark.parametrize("params", [*DESIGN.presets.values(), SEATED])
def test_letting_go_at_once_changes_nothing(params: RotationalParams) -> None:
    for each in DESIGN.run(params).handles:
        after = each.drag(params, each.position)
        old, new = DESIGN.run(params).folded, DESIGN.run(after).folded
        assert old is not None
        assert new is not None
        assert np.abs(old.vertices - new.vertices).max() < 1e-9


@pytest.mark.parametrize("params", list(DESIGN.presets.values()))
def test_a_dragged_point_follows_along_its_line(params: RotationalParams) -> None:
    grip = handle(params, "points.2.a")
    aside = np.array([-grip.position[1], grip.position[0]]) * 0.3
    after = grip.drag(params, grip.position * 1.05 + aside)
    moved = handle(after, "points.2.a").position
    assert np.allclose(moved, grip.position * 1.05)


def test_a_point_cannot_be_dragged_past_its_neighbour_on_the_line() -> None:
    params = DESIGN.presets["bowl-n8"]
    grip = handle(params, "points.2.a")
    far = grip.drag(params, grip.position * 100)
    assert far.points[2].a == params.points[4].a - HANDLE_GAP_MM
    assert grip.drag(params, -grip.position).points[2].a == HANDLE_GAP_MM
    for after in (far, grip.drag(params, -grip.position)):
        assert DESIGN.run(DESIGN.validate(after.model_dump())).folded is not None


def test_nothing_is_dragged_farther_out_than_may_be_typed_in() -> None:
    params = DESIGN.presets["bowl-n8"]
    grip = handle(params, "points.6.a")
    far = grip.drag(params, grip.position * 1e9)
    assert DESIGN.validate(far.model_dump()) == far
    assert far.points[6].a > 99_999


def test_a_point_that_already_is_nearer_than_a_handle_goes_may_stay_there() -> None:
    close = {**DESIGN.presets["bowl-n8"].points, 3: LinePoint(a=40 + HANDLE_GAP_MM / 4)}
    params = RotationalParams(n=8, phi=75, points=close)
    for name in ("points.1.a", "points.3.a"):
        grip = handle(params, name)
        after = grip.drag(params, grip.position).points
        assert [point.a for point in after.values()] == pytest.approx(
            [point.a for point in close.values()], abs=1e-12
        )


def test_the_opening_angle_follows_the_first_point_on_its_circle() -> None:
    params = DESIGN.presets["bowl-n8"]
    grip = handle(params, "phi")
    assert grip.space is Space.FOLDED
    assert grip.drag(params, np.array([1.0, 0.0, 0.0])).phi == pytest.approx(90)
    assert grip.drag(params, np.array([-1.0, 0.0, 5.0])).phi == 0
    assert grip.drag(params, np.array([-1.0, 0.0, -5.0])).phi == 180


def test_a_free_direction_follows_its_point() -> None:
    grip = handle(SEATED, "points.3.gamma")
    down = grip.drag(SEATED, np.array([50.0, 0.0, -100.0]))
    assert down.points[3].gamma == pytest.approx(-90)
