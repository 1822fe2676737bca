"""Few strokes are ordered as well as can be: compared with programmes that leave nothing out."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import coo_array, csr_array, vstack
from scipy.sparse.csgraph import connected_components

from foldmill_fabricate.toolpath import sequence
from foldmill_fabricate.toolpath.rebuilt import rebuilt


def lines(count: int, half: float, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    middle, angle = 300 * rng.random((count, 2)), 2 * np.pi * rng.random(count)
    reach = half * rng.random((count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.stack([middle - reach, middle + reach], axis=1)


def spokes(wheels: int, count: int, seed: int) -> np.ndarray:
    """Return the first so many spokes of wheels, which meet at hubs and with each other."""
    rng = np.random.default_rng(seed)
    hubs = 300 * rng.random((wheels, 2))
    which = [(a, b) for a in range(wheels) for b in range(a + 1, wheels)]
    chosen = rng.permutation(len(which))[:count]
    return np.array([[hubs[which[k][0]], hubs[which[k][1]]] for k in chosen])


def least_of_returning(ends: np.ndarray, start: np.ndarray) -> float:
    """Return the least travel over strokes that return, by the sets already drawn (Held, Karp)."""
    count = len(ends)
    places = ends.reshape(-1, 2)
    apart = np.hypot(*(places[:, None] - places).transpose(2, 0, 1))
    best = np.full((1 << count, 2 * count), np.inf)
    for end in range(2 * count):
        best[1 << (end // 2), end] = np.hypot(*(places[end] - start))
    for drawn in range(1, 1 << count):
        onward = (best[drawn][:, None] + apart).min(axis=0)
        for end in range(2 * count):
            more = drawn | 1 << (end // 2)
            if more != drawn:
                best[more, end] = min(best[more, end], onward[end])
    return float(best[-1].min())


def least_along(ends: np.ndarray, start: np.ndarray) -> float:
    """Return the least travel over strokes drawn once along, by an integer programme.

    Every end has one hop, the start too; the last end hops to nowhere. As long as hops and strokes
    fall apart into rings, the programme is told that these must be left, and solved again.
    """
    count = 2 * len(ends)
    places = np.vstack([ends.reshape(-1, 2), start])
    i, j = np.triu_indices(count + 1, 1)
    other = i // 2 != j // 2
    i, j = i[other], j[other]
    cost = np.r_[np.hypot(*(places[i] - places[j]).T), np.zeros(count)]
    i, j = np.r_[i, np.arange(count)], np.r_[j, np.full(count, count + 1)]
    hop = np.arange(len(cost))
    each = coo_array((np.ones(2 * len(hop)), (np.r_[i, j], np.r_[hop, hop]))).tocsr()
    rows = [LinearConstraint(each, 1, 1)]
    while True:
        found = milp(cost, integrality=np.ones(len(cost)), bounds=Bounds(0, 1), constraints=rows)
        used = np.flatnonzero(found.x > 0.5)
        stroke = np.arange(0, count + 2, 2)
        one, two = np.r_[i[used], stroke], np.r_[j[used], stroke + 1]
        rings, own = connected_components(
            coo_array((np.ones(len(one)), (one, two)), shape=(count + 2,) * 2)
        )
        if rings == 1:
            return float(found.fun)
        leaving = [
            csr_array([((own[i] == k) != (own[j] == k)).astype(float)]) for k in range(rings)
        ]
        rows.append(LinearConstraint(vstack(leaving).tocsr(), 2, np.inf))


def travel(ends: np.ndarray, start: np.ndarray, returns: bool) -> float:
    way = sequence.order(ends, start, returns=returns)
    assert sorted(stroke for stroke, _ in way) == list(range(len(ends)))
    return sequence.travelled(ends, start, way, returns)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("kind", ["apart", "meeting"])
def test_ten_strokes_that_return_are_drawn_with_the_least_travel(kind: str, seed: int) -> None:
    ends = lines(10, 90.0, seed) if kind == "apart" else spokes(7, 10, seed)
    start = np.array([-20.0, 10.0])
    assert travel(ends, start, True) == pytest.approx(least_of_returning(ends, start), abs=1e-6)


@pytest.mark.parametrize(("seed", "half"), [(1, 20.0), (2, 40.0), (3, 90.0)])
def test_twenty_five_lines_are_drawn_with_the_least_travel(seed: int, half: float) -> None:
    ends, start = lines(25, half, seed), np.zeros(2)
    assert travel(ends, start, False) == pytest.approx(least_along(ends, start), abs=1e-6)


@pytest.mark.parametrize("returns", [False, True])
def test_a_way_is_never_longer_when_it_is_rebuilt(returns: bool) -> None:
    ends, start = lines(60, 40.0, 4), np.zeros(2)
    flat = np.vstack([ends.reshape(-1, 2), np.full((1, 2), np.nan), start])
    way = [(k, False) for k in range(60)]
    lengths = []
    for rounds in (0, 1, 10, 100, 1000):
        found = rebuilt(flat, way, returns, rounds)
        assert sorted(k for k, _ in found) == list(range(60))
        lengths.append(sequence.travelled(ends, start, found, returns))
    assert lengths[0] == sequence.travelled(ends, start, way, returns)
    assert max(lengths) == lengths[0]
    assert lengths[-1] < 0.5 * lengths[0]
