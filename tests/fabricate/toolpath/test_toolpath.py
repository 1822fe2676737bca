"""Strokes: trails, order, the way of the tool, time."""

from __future__ import annotations

from itertools import pairwise, permutations, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate.passes import Operation, Role, Stroke
from foldmill_fabricate.toolpath import motion, sequence, trails
from foldmill_fabricate.toolpath.bounds import travel_bound
from foldmill_fabricate.toolpath.traversal import traversal


def op(repeats: int, overcut: float = 0.0) -> Operation:
    return Operation(role=Role.SCORE, repeats=repeats, overcut=overcut, strokes=())


@given(st.integers(0, 10_000), st.integers(2, 25))
def test_trails_go_over_every_edge_exactly_once(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.random((8, 2))
    pairs = [(a, b) for a in range(8) for b in range(a)]
    edges = np.array([pairs[k] for k in rng.permutation(len(pairs))[:count]])
    walked = [
        tuple(sorted(side))
        for trail in trails.straightest(points, edges)
        for side in pairwise(trail)
    ]
    assert sorted(walked) == sorted(tuple(sorted(edge)) for edge in edges.tolist())


def test_a_trail_goes_straight_on_at_a_crossing() -> None:
    points = np.array([[0, 0], [1, 0], [2, 0], [1, 1], [1, -1]], float)
    edges = np.array([[0, 1], [1, 2], [1, 3], [4, 1]])
    found = {tuple(min(t, t[::-1])) for t in trails.straightest(points, edges)}
    assert found == {(0, 1, 2), (3, 1, 4)}


def shortest(ends: np.ndarray, start: np.ndarray, returns: bool) -> float:
    best = np.inf
    for way in permutations(range(len(ends))):
        for sides in product((0, 1), repeat=len(ends)):
            at, total = start, 0.0
            for k, side in zip(way, sides, strict=True):
                total += float(np.hypot(*(ends[k, side] - at)))
                at = ends[k, side if returns else 1 - side]
            best = min(best, total)
    return best


@pytest.mark.parametrize("returns", [False, True])
def test_few_strokes_are_ordered_as_well_as_can_be_and_never_below_the_bound(returns: bool) -> None:
    rng = np.random.default_rng(7)
    for _ in range(12):
        ends, start = rng.random((5, 2, 2)), np.zeros(2)
        found = sequence.order(ends, start, returns=returns)
        assert sorted(k for k, _ in found) == list(range(5))
        at, total = start, 0.0
        for k, backwards in found:
            total += float(np.hypot(*(ends[k, int(backwards)] - at)))
            at = ends[k, int(backwards) if returns else 1 - int(backwards)]
        best = shortest(ends, start, returns)
        assert travel_bound(list(ends), start, returns) <= best + 1e-9
        assert total == pytest.approx(best)


def test_a_knife_goes_there_and_back_without_lifting() -> None:
    line = Stroke(points=((0, 0), (10, 0), (10, 5)))
    assert traversal(line, op(2)).tolist() == [[0, 0], [10, 0], [10, 5], [10, 0], [0, 0]]
    assert len(traversal(line, op(3))) == 7


def test_a_closed_cut_goes_round_and_runs_on_by_its_overcut() -> None:
    ring = Stroke(points=((0, 0), (4, 0), (4, 4), (0, 4), (0, 0)))
    path = traversal(ring, op(2, overcut=5.0))
    assert np.hypot(*np.diff(path, axis=0).T).sum() == pytest.approx(2 * 16 + 5)
    assert path[-1].tolist() == [4, 1]


@given(st.floats(0.01, 1e4), st.floats(1, 1e3), st.floats(10, 1e5))
def test_a_move_is_never_faster_than_its_speed_or_its_acceleration(
    length: float, speed: float, acceleration: float
) -> None:
    [seconds] = motion.move_seconds([length], speed, acceleration)
    assert seconds >= length / speed * (1 - 1e-12)
    assert seconds >= 2 * np.sqrt(length / acceleration) * (1 - 1e-12)
