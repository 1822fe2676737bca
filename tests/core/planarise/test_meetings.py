"""Lines that meet are found in bounded memory; too many are counted and refused, not made."""

from __future__ import annotations

import tracemalloc
from itertools import combinations

import numpy as np
import pytest
from shapely import LineString

from foldmill.errors import InvalidPattern
from foldmill.planarise import planarise, planarise_graph
from foldmill.planarise.meetings import meetings


def across(count: int, seed: int = 0) -> np.ndarray:
    """Lines from the left side of a square of 400 mm to its right one, no two with one end."""
    rng = np.random.default_rng(seed)
    sides = rng.permuted(np.tile(np.arange(count), (2, 1)), axis=1) + rng.uniform(0.2, 0.8, count)
    left, right = sides * 400 / count
    zero, wide = np.zeros(count), np.full(count, 400.0)
    return np.stack([np.stack([zero, left], axis=1), np.stack([wide, right], axis=1)], axis=1)


@pytest.mark.parametrize("seed", range(4))
def test_every_crossing_is_found_as_by_trying_every_pair(seed: int) -> None:
    lines = np.random.default_rng(seed).uniform(0, 100, (40, 2, 2))
    points, edges = lines.reshape(-1, 2), np.arange(80).reshape(-1, 2)
    shapes = [LineString(line) for line in lines]
    wanted = [a.intersection(b) for a, b in combinations(shapes, 2) if a.crosses(b)]
    edge, place, vertex, spots = meetings(points, edges, 1e-3)
    assert len(edge) == 2 * len(wanted) == 2 * (len(spots) - len(points))
    for e, t, v in zip(edge, place, vertex, strict=True):
        on = lines[e, 0] + t * (lines[e, 1] - lines[e, 0])
        assert np.allclose(on, spots[v], atol=1e-9)
    assert np.allclose(np.sort([p.x for p in wanted]), np.sort(spots[len(points) :, 0]))


def inversions(lines: np.ndarray) -> int:
    """How often lines from side to side cross: pairs in another order at the right."""
    right = lines[np.argsort(lines[:, 0, 1]), 1, 1]
    return sum(int((right[k + 1 :] < right[k]).sum()) for k in range(len(right)))


def test_too_many_crossings_are_refused_with_their_number_and_not_made() -> None:
    lines = across(1500)
    count = inversions(lines)
    tracemalloc.start()
    with pytest.raises(InvalidPattern) as refused:
        planarise(lines, most=200_000)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert f"at {count:,} places" in str(refused.value)
    assert f"{1500 + 2 * count:,}" in str(refused.value)
    assert "200,000" in str(refused.value)
    assert peak < 500e6


def test_as_many_pieces_as_are_allowed_are_made() -> None:
    lines = across(40)
    pieces = len(lines) + 2 * inversions(lines)
    assert len(planarise(lines, most=pieces).edges) == pieces
    with pytest.raises(InvalidPattern, match=f"{pieces:,}; the most that is read is"):
        planarise(lines, most=pieces - 1)
    with pytest.raises(InvalidPattern):
        planarise_graph(lines.reshape(-1, 2), np.arange(80).reshape(-1, 2), [0] * 40, most=1)


def test_ends_upon_other_lines_count_as_well() -> None:
    # Lines upon each other, each with ends of its own, would become n² pieces without a crossing.
    low = np.arange(60.0)
    lines = np.stack([np.stack([low, 0 * low], 1), np.stack([200 - low, 0 * low], 1)], axis=1)
    assert len(planarise(lines).edges) == 1
    with pytest.raises(InvalidPattern, match="meet each other"):
        planarise(lines, most=2000)


def test_a_thousand_lines_through_one_point_become_its_spokes() -> None:
    turn = np.pi * np.arange(500) / 500
    tips = 100 * np.stack([np.cos(turn), np.sin(turn)], axis=1) + 7 / 3
    tracemalloc.start()
    found = planarise(np.stack([tips, 14 / 3 - tips], axis=1))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (len(found.edges), len(found.points)) == (1000, 1001)
    assert found.count("crossing") == 1
    assert peak < 500e6


def test_a_crowd_of_points_becomes_its_first_one() -> None:
    ends = np.random.default_rng(1).uniform(0, 4e-4, (800, 2))
    lines = np.stack([ends, np.tile([[10.0, 0.0]], (800, 1))], axis=1)
    found = planarise(lines)
    assert found.points.tolist() == [ends[0].tolist(), [10.0, 0.0]]
    assert len(found.edges) == 1


def test_hatching_that_takes_too_long_to_look_through_is_refused() -> None:
    along = np.arange(5000.0)
    lines = np.stack([np.stack([along, 0 * along], 1), np.stack([along + 9e3, 0 * along + 9e3], 1)])
    with pytest.raises(InvalidPattern, match="so close together"):
        planarise(lines.transpose(1, 0, 2), most=200_000)
