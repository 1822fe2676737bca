"""The matching of hops is the shortest there is, and the proof of it holds by itself."""

from __future__ import annotations

import networkx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill import installed
from foldmill_fabricate.toolpath import corners, hops, matching, prices, proven
from foldmill_fabricate.toolpath.routing import route

FREE = [np.nan, np.nan]


def scattered(seed: int, count: int, *, grid: float = 0.0) -> np.ndarray:
    """Return random ends, on a grid where asked, and the depot at the origin."""
    ends = np.random.default_rng(seed).uniform(0, 500, (count, 2))
    ends = np.unique(np.round(ends / grid) * grid, axis=0) if grid else ends
    return np.vstack([ends[: len(ends) // 2 * 2], FREE, [0.0, 0.0]])


def least(places: np.ndarray) -> float:
    """Match every pair there is by another implementation."""
    graph = networkx.Graph()
    ends = range(len(places) - 2)
    for k in ends:
        graph.add_edge(k, "end", weight=0.0)
        graph.add_edge(k, "start", weight=float(np.hypot(*(places[k] - places[-1]))))
        for other in range(k):
            graph.add_edge(k, other, weight=float(np.hypot(*(places[k] - places[other]))))
    pairs = networkx.min_weight_matching(graph)
    return float(sum(graph.edges[pair]["weight"] for pair in pairs))


def all_costs(places: np.ndarray) -> np.ndarray:
    cost: np.ndarray = np.nan_to_num(
        np.hypot(*(places[:, None] - places[None, :]).transpose(2, 0, 1))
    )
    cost[-1, -2] = cost[-2, -1] = np.inf
    np.fill_diagonal(cost, np.inf)
    return cost


@given(st.integers(0, 10_000), st.integers(2, 30), st.sampled_from([0.0, 40.0]))
@settings(max_examples=25, deadline=None)
def test_few_ends_are_matched_as_another_program_matches_them(
    seed: int, half: int, grid: float
) -> None:
    places = scattered(seed, 2 * half, grid=grid)
    found = proven.match(places)
    assert sorted(found.pairs.ravel().tolist()) == list(range(len(places)))
    assert found.length == pytest.approx(least(places), abs=1e-4)
    assert found.bound == found.length


@pytest.mark.parametrize(("seed", "grid"), [(1, 0.0), (3, 20.0)])
def test_ends_with_too_many_pairs_to_look_at_are_matched_exactly(seed: int, grid: float) -> None:
    places = scattered(seed, 110, grid=grid)
    found = proven.match(places)
    assert found.length == pytest.approx(least(places), abs=1e-4)
    assert found.bound == found.length


def test_matching_among_neighbours_alone_can_be_longer_than_the_least() -> None:
    """Twelve near ends close in on themselves: two crowds of 51 need a link between them."""
    crowd = np.random.default_rng(4).uniform(0, 10, (51, 2))
    places = np.vstack([crowd, crowd + np.array([300, 0]), FREE, [150.0, 500.0]])
    found = proven.match(places)
    assert found.length == pytest.approx(least(places), abs=1e-4)
    assert found.bound == found.length


def test_a_thousand_scattered_ends_are_shorter_than_among_twelve_neighbours_and_proved() -> None:
    places = scattered(2, 1000)
    found = proven.match(places)
    among_neighbours = hops.match(places)[1]
    assert found.length < among_neighbours - 0.5
    assert found.bound == found.length


@given(st.integers(0, 10_000), st.integers(2, 25), st.integers(1, 6))
@settings(max_examples=25, deadline=None)
def test_prices_never_promise_more_than_the_least(seed: int, half: int, rounds: int) -> None:
    places = scattered(seed, 2 * half)
    cost, best = all_costs(places), least(places)
    some = np.arange(len(places)).reshape(-1, 2)  # a matching that can be made, however long
    some[0, 1], some[-1, 0] = some[-1, 0], some[0, 1]
    near = np.stack(matching.nearest(places[:-2], 3)[:2], axis=1)
    i, j = np.unique(np.vstack([near, some]), axis=0).T
    found = prices.bound(cost, i, j, best, rounds)
    assert found.least <= best + 1e-6
    assert (found.spare >= 0).all()


def test_prices_that_hold_only_for_some_pairs_are_lowered_until_they_hold_for_all() -> None:
    """Four ends on a line, of which only the long pairs are priced at first."""
    places = np.array([[0.0, 0], [1, 0], [2, 0], [3, 0]])
    cost = np.hypot(*(places[:, None] - places[None, :]).transpose(2, 0, 1))
    np.fill_diagonal(cost, np.inf)
    found = prices.bound(cost, np.array([0, 1]), np.array([2, 3]), 4.0, rounds=1)
    assert found.least <= 2 + 1e-9
    assert (found.spare >= 0).all()


def test_an_odd_crowd_pays_for_the_link_that_leaves_it() -> None:
    """Two triangles far apart: prices on points alone would bound the matching by their sides."""
    triangle = np.array([[0.0, 0], [2, 0], [1, 3**0.5]])
    places = np.vstack([triangle, triangle + np.array([100, 0])])
    cost = np.hypot(*(places[:, None] - places[None, :]).transpose(2, 0, 1))
    np.fill_diagonal(cost, np.inf)
    i, j = np.triu_indices(6, 1)
    best = 2 + 2 + 98
    assert prices.bound(cost, i, j, best, rounds=1).least == pytest.approx(6)
    assert prices.bound(cost, i, j, best).least == pytest.approx(best)


def test_a_sheet_of_zigzags_is_ordered_with_proof() -> None:
    design = installed().design("rotational")
    pattern = design.run(design.preset(next(iter(design.presets)))).pattern
    found = route(pattern.vertices, pattern.edges, np.zeros(2), corners.free_turning())
    assert found.gap == 0
    assert found.bound > 0
