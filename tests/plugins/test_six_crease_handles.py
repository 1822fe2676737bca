"""What a person drags on a six-crease tube, and what becomes of the parameters."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import Fold
from foldmill.handle import Circle, Handle, Space
from foldmill_plugins.six_crease import DESIGN, solve

SHAPES = pytest.mark.parametrize("name", DESIGN.presets)


def handle(fold: Fold, name: str) -> Handle:
    return next(each for each in fold.handles if each.name == name)


@SHAPES
def test_every_handle_lies_on_a_vertex_and_on_its_locus(name: str) -> None:
    fold = DESIGN.run(DESIGN.preset(name))
    assert fold.folded is not None
    assert len(fold.handles) == 9 + 2
    for each in fold.handles:
        spots = fold.pattern if each.space is Space.PATTERN else fold.folded
        gaps = np.linalg.norm(spots.vertices - each.position, axis=1)
        assert gaps.min() < 1e-12
        assert np.abs(each.locus.nearest(each.position) - each.position).max() < 1e-12


@SHAPES
def test_a_handle_that_stays_where_it_is_changes_nothing(name: str) -> None:
    params = DESIGN.preset(name)
    fold = DESIGN.run(params)
    for each in fold.handles:
        again = each.drag(params, each.position)
        assert np.abs(solve.meridian(again) - solve.meridian(params)).max() < 1e-9


@pytest.mark.parametrize("tab", [0.0, 3.0])
@SHAPES
def test_a_dragged_point_goes_where_it_is_dragged(name: str, tab: float) -> None:
    params = DESIGN.preset(name).model_copy(update={"tab": tab})
    fold = DESIGN.run(params)
    for each in fold.handles:
        if each.name == "L" and np.hypot(*each.position[:2]) == 0:
            continue  # on the axis it can go inwards no more, and outwards changes much
        step = np.full(len(each.position), 0.05)
        target = each.locus.nearest(each.position + step)
        moved = DESIGN.run(each.drag(params, each.position + step))
        assert np.abs(handle(moved, each.name).position - target).max() < 1e-9


def test_a_height_stops_short_of_its_neighbours_on_the_line() -> None:
    params = DESIGN.preset("rugby")
    each = handle(DESIGN.run(params), "points.4.y")
    low, high = (each.drag(params, np.array([0.0, y])).points[4].y for y in (-500, 500))
    assert params.points[2].y < low < params.points[2].y + 1.1e-3
    assert params.points[6].y - 1.1e-3 < high < params.points[6].y
    top = handle(DESIGN.run(params), "points.9.y").drag(params, np.array([0.0, 500.0]))
    assert top.points[9].y == 500


def test_point_one_stops_at_the_axis_and_at_the_longest_l() -> None:
    params = DESIGN.preset("ball")
    each = handle(DESIGN.run(params), "L")
    inwards = each.drag(params, np.array([-30.0, 4.0, 12.0]))
    assert (inwards.L, inwards.phi) == (12, 0)
    below = each.drag(params, np.array([-30.0, 4.0, -12.0]))
    assert (below.L, below.phi) == (12, 180)
    outwards = each.drag(params, np.array([900.0, 0.0, 0.0]))
    assert outwards.phi == 90
    assert outwards.L == solve.longest(outwards) < 900


def test_point_two_turns_on_its_circle() -> None:
    params = DESIGN.preset("ball")
    each = handle(DESIGN.run(params), "beta")
    assert isinstance(each.locus, Circle)
    for beta in (0.0, 75.0, 190.0, 359.0):
        angle = np.radians(beta)
        spot = each.locus.centre + 3 * (np.cos(angle) * each.locus.u + np.sin(angle) * each.locus.v)
        assert each.drag(params, spot).beta == pytest.approx(beta, abs=1e-9)


def test_a_drag_leaves_the_parameters_it_was_given_as_they_were() -> None:
    params = DESIGN.preset("cup")
    before = params.model_dump()
    for each in DESIGN.run(params).handles:
        each.drag(params, each.position + 1.0)
    assert params.model_dump() == before
