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
from foldmill_fabricate.toolpath.priced_trees import Places, least_tree
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


def _dearest(places: Places, prices: np.ndarray) -> float:
    """The least tree by Kruskal's way over all pairs, mates first: a second implementation."""
    count = len(places.mates)
    root = list(range(count))

    def top(k: int) -> int:
        return k if root[k] == k else top(root[k])

    ways = []
    for j in range(count):
        for i in range(j):
            mated = places.mates[i] == j
            near = min(np.hypot(*(p - q)) for p in places.spots[i] for q in places.spots[j])
            cost = prices[i] + prices[j] + (0.0 if mated else near)
            ways.append((not mated, cost, i, j))
    total = 0.0
    for _, cost, i, j in sorted(ways):
        if top(i) != top(j):
            root[top(i)] = top(j)
            total += cost
    return total


@pytest.mark.parametrize("returning", [False, True])
def test_prices_never_prove_more_than_the_least_tree_over_all_pairs(returning: bool) -> None:
    rng = np.random.default_rng(3)
    spots = rng.random((24, 2, 2))
    spots[:, 1] = spots[:, 1] if returning else spots[:, 0]
    mates = np.full(24, -1) if returning else np.arange(24) ^ 1
    places = Places(spots, mates, loose=True)
    for _ in range(5):
        prices = 0.2 * rng.standard_normal(24)
        assert least_tree(places, prices)[0] == pytest.approx(_dearest(places, prices))


def test_rows_of_strokes_on_one_line_have_a_bound() -> None:
    ends = np.array([[[5.0 * k, 0], [5.0 * k + 3, 0]] for k in range(40)])
    assert travel_bound(list(ends), np.zeros(2)) == pytest.approx(2 * 39)
    assert travel_bound(list(ends), np.zeros(2), dense=10) == pytest.approx(2 * 39)
    assert travel_bound(list(ends[:1]), np.array([-4.0, 0])) == pytest.approx(4)
    assert travel_bound(list(ends[:1]), None, returns=True) == 0
    assert travel_bound(list(ends[:2]), None, returns=True) == pytest.approx(2)


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
