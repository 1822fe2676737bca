"""A tool that may only pull goes one way along the feed, and draws every stroke all the same."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from stools import machine

from foldmill_fabricate import shelf
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Operation, Role, Stroke
from foldmill_fabricate.toolpath import order, pulled
from foldmill_fabricate.toolpath.ways import stroke_ways

Pull = Literal["up", "down"]
SPOTS = st.tuples(st.integers(0, 6), st.integers(0, 6))
RING = Stroke(points=((0, 0), (4, 0), (4, 4), (0, 4), (0, 0)))


def op(repeats: int, overcut: float = 0.0) -> Operation:
    return Operation(role=Role.SCORE, repeats=repeats, overcut=overcut, strokes=())


def sides(way: np.ndarray) -> Counter[tuple[tuple[float, ...], ...]]:
    points = [tuple(point) for point in way.tolist()]
    return Counter(tuple(sorted(side)) for side in pairwise(points))


def length(ways: list[np.ndarray]) -> float:
    return sum(float(np.hypot(*np.diff(way, axis=0).T).sum()) for way in ways)


@given(st.lists(SPOTS, min_size=2, max_size=12), st.sampled_from(["up", "down"]))
def test_each_part_goes_one_way_and_all_parts_are_the_whole(
    spots: list[tuple[int, int]], pull: Pull
) -> None:
    way = np.array(spots, float)
    parts = pulled.parts(way, pull)
    for part in parts:
        rise = np.diff(part[:, 1]) * (1 if pull == "up" else -1)
        assert (rise >= 0).all()
    assert sum((sides(part) for part in parts), Counter()) == sides(way)


@given(st.integers(1, 4), st.sampled_from(["up", "down"]), st.floats(0, 3))
def test_a_repeat_lifts_and_goes_back(repeats: int, pull: Pull, rise: float) -> None:
    line = Stroke(points=((0, 0), (5, 1), (9, 1 + rise)))
    ways = pulled.ways(line, np.array(line.points), op(repeats), pull)
    assert len(ways) == repeats
    first = (0, 0) if pull == "up" else (9, 1 + rise)
    assert all(tuple(way[0]) == first for way in ways)


def test_a_line_across_the_feed_is_followed_there_and_back() -> None:
    line = Stroke(points=((0, 2), (5, 2), (9, 2)))
    (way,) = pulled.ways(line, np.array(line.points), op(2), "up")
    assert way[:, 0].tolist() == [0, 5, 9, 5, 0]


@pytest.mark.parametrize("pull", ["up", "down"])
def test_a_ring_is_gone_round_in_halves_and_overcut(pull: Pull) -> None:
    ways = pulled.ways(RING, np.array(RING.points), op(3, overcut=5.0), pull)
    assert length(ways) == pytest.approx(3 * 16 + 5)
    for way in ways:
        assert (np.diff(way[:, 1]) * (1 if pull == "up" else -1) >= 0).all()


def test_elsewhere_a_stroke_is_one_way() -> None:
    (way,) = stroke_ways(RING, op(2, overcut=1.0), machine(), lambda points: np.asarray(points))
    assert length([way]) == pytest.approx(2 * 16 + 1)


def test_strokes_with_a_direction_are_ordered_by_their_middles() -> None:
    rng = np.random.default_rng(2)
    strokes = [
        Stroke(points=((x, 0), (x, 50))) for x in rng.permutation(np.arange(0.0, 100, 5)).tolist()
    ]
    found = order.by_middles(strokes, np.zeros(2))
    assert [stroke.points[0][0] for stroke in found] == sorted(s.points[0][0] for s in strokes)


def test_a_holder_that_is_led_round_corners_is_not_for_a_sheet_that_is_only_pulled() -> None:
    knife = shelf.machine("generic-hpgl-drag-knife")
    text = knife.model_dump()
    assert "pull" not in text["bed"]
    with pytest.raises(ValidationError, match=r"bed\.pull is for machines that make up"):
        Machine.model_validate({**text, "bed": {**text["bed"], "pull": "up"}})
