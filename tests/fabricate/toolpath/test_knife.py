"""A blade's tip, dragged along the holder's way, stays on the line it is to cut."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from foldmill_fabricate.machines import Axes
from foldmill_fabricate.toolpath.knife import (
    FACETTED,
    SHARP_DEG,
    facets,
    holder_ways,
    is_facetted,
    last_heading,
    lead_in,
    lifted_ways,
)
from foldmill_fabricate.toolpath.snapping import Grid

Floats = NDArray[np.float64]
OFFSETS = (0.25, 0.9)
STARTS = np.radians(np.arange(0, 360, 30))
GRID = Grid(Axes(units_per_mm=40))


def drag(holder: Floats, offset: float, headings: Floats) -> tuple[Floats, Floats]:
    """Pull tips (k) behind a holder (n, 2) in steps of 0.005 mm: no formula of a tractrix at all.

    Returns their ways (steps, k, 2) and the directions (k,) in which they point at the end.
    """
    fine = [holder[:1]]
    for a, b in pairwise(holder):
        count = max(2, int(np.ceil(np.hypot(*(b - a)) / 0.005)))
        fine.append(a + np.linspace(0, 1, count + 1)[1:, None] * (b - a))
    tip = holder[0] - offset * np.column_stack([np.cos(headings), np.sin(headings)])
    trace = [tip]
    for spot in np.vstack(fine)[1:]:
        pull = spot - tip
        tip = spot - offset * pull / np.hypot(pull[:, :1], pull[:, 1:])
        trace.append(tip)
    pull = holder[-1] - tip
    return np.array(trace), np.arctan2(pull[:, 1], pull[:, 0])


def corner(degrees: float) -> Floats:
    """Return two legs of 20 mm that enclose an angle."""
    angle = np.radians(degrees)
    return np.array([[20.0, 0.0], [0.0, 0.0], [20 * np.cos(angle), 20 * np.sin(angle)]])


def fan() -> list[Floats]:
    """Return twelve creases that leave one point, 1 mm away from it."""
    return [
        np.array([[np.cos(a), np.sin(a)], [15 * np.cos(a), 15 * np.sin(a)]])
        for a in np.radians(np.arange(12) * 30 + 7)
    ]


SQUARE = np.array([[0, 0], [20, 0], [20, 20], [0, 20], [0, 0], [1, 0]], float)
SHAPES = {
    "square": [SQUARE],
    "60 degrees": [corner(60)],
    "15 degrees": [corner(15)],
    "fan of twelve": fan(),
    "there and back": [np.array([[0, 0], [12, 5], [0, 0]], float)],
}


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("name", SHAPES)
def test_the_tip_stays_on_the_line_whatever_way_it_pointed_at_first(
    name: str, offset: float
) -> None:
    entry = lead_in((-60.0, -60.0), offset, along=0.4)
    ways, heading = SHAPES[name], last_heading(entry)
    assert_follows(ways, [entry, *holder_ways(ways, offset, heading)], offset)
    assert_follows(ways, [entry, *holder_ways(ways, offset, heading, GRID)], offset)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(
    offset=st.floats(0.2, 1.0),
    turn=st.floats(0, 360),
    shift=st.tuples(st.floats(0, 0.025), st.floats(0, 0.025)),
    corners=st.lists(st.tuples(st.floats(4, 30), st.floats(-170, 170)), min_size=1, max_size=4),
)
def test_in_steps_the_tip_stays_on_lines_of_any_direction_and_place(
    offset: float, turn: float, shift: tuple[float, float], corners: list[tuple[float, float]]
) -> None:
    courses = np.radians(turn + np.cumsum([bend for _, bend in corners]))
    lengths = [length for length, _ in corners]
    legs = np.column_stack([lengths * np.cos(courses), lengths * np.sin(courses)])
    way = np.vstack([np.zeros((1, 2)), np.cumsum(legs, axis=0)]) + shift
    entry = lead_in((-60.0, -60.0), offset, along=0.4)
    assert_follows([way], [entry, *holder_ways([way], offset, last_heading(entry), GRID)], offset)


def assert_follows(ways: list[Floats], holders: list[Floats], offset: float) -> None:
    """Drag twelve blades through a lead-in and along; each cuts all of the ways, and no more."""
    _, headings = drag(holders[0], offset, STARTS)
    assert np.ptp(np.unwrap(headings)) < 1e-3
    for way, holder in zip(ways, holders[1:], strict=True):
        tips, headings = drag(holder, offset, headings)
        assert np.abs(tips - tips[:, :1]).max() < 1e-3
        cut, line = shapely.LineString(tips[:, 0]), shapely.LineString(way)
        assert shapely.hausdorff_distance(cut, line) <= 0.02
        assert cut.buffer(0.02).covers(line)


def test_without_a_lead_in_the_blade_strays_by_as_much_as_its_offset_allows() -> None:
    way = np.array([[0, 0], [20, 0]], float)
    tips, _ = drag(holder_ways([way], 0.9, 0.0)[0], 0.9, np.array([np.pi / 2]))
    assert np.abs(tips[:, 0, 1]).max() == pytest.approx(0.9, abs=0.01)


def test_the_blade_keeps_its_direction_while_it_is_lifted() -> None:
    first, second = np.array([[0, 0], [5, 0]], float), np.array([[9, 9], [9, 20]], float)
    holder = holder_ways([first, second], 0.5, 0.0)[1]
    assert holder[0] == pytest.approx([9.5, 9.0])
    assert last_heading(second) == pytest.approx(np.pi / 2)


def test_a_way_that_leads_nowhere_turns_no_blade() -> None:
    spot = np.array([[3.0, 4.0], [3.0, 4.0]])
    assert holder_ways([spot], 0.25, 0.0)[0] == pytest.approx(np.array([[3.25, 4.0]]))
    assert last_heading(spot, heading=1.5) == 1.5


def test_a_circle_is_facetted_below_three_offsets() -> None:
    assert is_facetted(2.5, 0.9)
    assert not is_facetted(2.5, 0.25)
    assert not is_facetted(FACETTED * 0.9, 0.9)


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("name", SHAPES)
def test_a_blade_that_is_lifted_out_at_sharp_corners_is_turned_nowhere_else(
    name: str, offset: float
) -> None:
    ways = SHAPES[name]
    entry = lead_in((-60.0, -60.0), offset, along=0.4)
    planned = lifted_ways(ways, offset, last_heading(entry), GRID)
    _, headings = drag(entry, offset, STARTS)
    cut = []
    for holder, light in planned:
        tips, after = drag(holder, offset, headings)
        turned = np.abs((after - headings + np.pi) % (2 * np.pi) - np.pi).max()
        if light:
            assert np.hypot(*(tips - tips[:1]).transpose(2, 0, 1)).max() <= 0.025
            assert turned > np.radians(SHARP_DEG - 1)
        else:
            assert turned <= np.radians(SHARP_DEG + 1)
            cut.append(shapely.LineString(tips[:, 0]))
        headings = after
    lines = shapely.MultiLineString(ways)
    assert shapely.hausdorff_distance(shapely.MultiLineString(cut), lines) <= 0.02
    assert shapely.MultiLineString(cut).buffer(0.02).covers(lines)


@pytest.mark.parametrize("offset", [0.3, 0.6, 0.9])
@pytest.mark.parametrize("radius", [0.5, 1.0, 2.0, 2.5])
def test_facets_are_as_many_as_the_blade_settles_on(radius: float, offset: float) -> None:
    count = facets(radius, offset)
    side = 2 * radius * np.tan(np.pi / count)
    finer = 2 * radius * np.tan(np.pi / (count + 1))
    assert count == 6 or side >= 2 * offset > finer
