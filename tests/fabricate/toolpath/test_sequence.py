"""Separate strokes are ordered well, alike with and without a compiler, and never for the worse."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foldmill.kernels.jit import SWITCH
from foldmill_fabricate.toolpath import sequence
from foldmill_fabricate.toolpath.arrays import reverse, turn
from foldmill_fabricate.toolpath.bounds import travel_bound
from foldmill_fabricate.toolpath.greedy import first_tour

ALIKE = """
import json, sys
import numpy as np
from foldmill_fabricate.toolpath import sequence
ends = 100 * np.random.default_rng(5).random((25, 2, 2))
found = [sequence.order(ends, np.zeros(2), returns=r, kicks=500) for r in (False, True)]
many = 100 * np.random.default_rng(6).random((202, 1, 2)) + np.array([[[0, 0], [1, 2]]])
found.append(sequence.order(many, None, kicks=10))
print(json.dumps(found))
"""


def lines(count: int, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    middle, angle = 300 * rng.random((count, 2)), 2 * np.pi * rng.random(count)
    half = 6 * rng.random((count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.stack([middle - half, middle + half], axis=1)


def test_strokes_are_ordered_alike_compiled_and_uncompiled() -> None:
    found = []
    for switch in ("0", "1"):
        env = {**os.environ, SWITCH: switch, "PYTHONPATH": os.pathsep.join(sys.path)}
        command = [sys.executable, "-c", ALIKE]
        out = subprocess.run(command, env=env, capture_output=True, text=True, check=True).stdout
        found.append(json.loads(out))
    assert found[0] == found[1]


@pytest.mark.parametrize("returns", [False, True])
def test_kicks_never_make_the_way_longer(returns: bool) -> None:
    ends, start = lines(150), np.zeros(2)
    ways = [sequence.order(ends, start, returns=returns, kicks=kicks) for kicks in (0, 300, 1500)]
    assert all(sorted(k for k, _ in way) == list(range(150)) for way in ways)
    plain, some, more = (sequence.travelled(ends, start, way, returns) for way in ways)
    assert max(some, more) <= plain + 1e-9
    assert min(some, more) < plain


def test_random_lines_end_within_four_per_cent_of_the_bound() -> None:
    ends = lines(250)
    way = sequence.order(ends, None)
    bound = travel_bound(list(ends), None)
    assert bound <= sequence.travelled(ends, None, way, False) <= 1.04 * bound


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 40), st.booleans(), st.booleans(), st.randoms(use_true_random=False))
def test_strokes_given_in_another_order_and_direction_are_drawn_the_same_way(
    count: int, returns: bool, is_grid: bool, dice: Random
) -> None:
    ends = lines(count, seed=count)
    if is_grid:  # hops of the same length in many places
        ends = np.round(ends / 30) * 30
    mixed = np.array([dice.choice((each, each[::-1])) for each in dice.sample(list(ends), count)])
    one, other = [
        [each[k, ::-1] if backwards else each[k] for k, backwards in way]
        for each in (ends, mixed)
        for way in [sequence.order(each, np.array([7.0, 3.0]), returns=returns, kicks=60)]
    ]
    np.testing.assert_array_equal(one, other)


def test_kicks_per_stroke_fall_on_a_large_sheet() -> None:
    each = [sequence._kicks(n) / n for n in (1000, 10_000, 300_000)]
    assert each[0] > each[1] > each[2]
    assert sequence._kicks(10_000) > sequence._kicks(1000)


@pytest.mark.parametrize("returns", [False, True])
def test_the_first_tour_passes_every_stroke_once_from_end_to_end_or_back(
    returns: bool,
) -> None:
    nowhere = np.full((2, 2), np.nan)
    ends = np.concatenate([lines(200, seed=3).reshape(-1, 2), nowhere])
    tour, at = first_tour(ends, returns)
    assert sorted(tour.tolist()) == list(range(402))
    assert (tour[1:-1:2] // 2 == tour[2::2] // 2).all()
    assert (at // 2 == np.arange(402) // 2).all()
    shared = at[:-2:2] == at[1:-2:2]
    assert shared.all() if returns else not shared.any()


def test_what_was_turned_round_is_taken_back_from_the_log() -> None:
    rng = np.random.default_rng(4)
    tour = np.roll(np.arange(40, dtype=np.int32), 1)
    pos = np.argsort(tour).astype(np.int32)
    log = np.zeros(100, np.int64)
    for _ in range(20):
        i, j = 2 * rng.integers(0, 20, 2) + (1, 0)
        turn(tour, pos, int(tour[i]), int(tour[j]), log)
    strokes = {frozenset((int(tour[p]), int(tour[(p + 1) % 40]))) for p in range(1, 40, 2)}
    assert strokes == {frozenset((2 * s, 2 * s + 1)) for s in range(20)}
    for k in range(int(log[0]) - 1, -1, -1):
        reverse(tour, pos, int(log[2 * k + 1]), int(log[2 * k + 2]))
    assert (tour == np.roll(np.arange(40), 1)).all()
    assert (pos[tour] == np.arange(40)).all()
