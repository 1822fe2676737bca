"""Boxes that meet and points inside them are found by sorting, as by looking at every pair."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import sweep

Floats = np.ndarray


def boxes(seed: int, count: int) -> tuple[Floats, Floats]:
    """Return boxes with whole-number corners, so that many touch exactly."""
    rng = np.random.default_rng(seed)
    low = rng.integers(0, 20, (count, 2)).astype(float)
    return low, low + rng.integers(0, 6, (count, 2))


@pytest.mark.parametrize("block", [3, 1_000_000])
@pytest.mark.parametrize("seed", range(3))
def test_boxes_that_overlap_or_touch_are_found_once(
    seed: int, block: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sweep, "_BLOCK", block)
    low, high = boxes(seed, 60)
    meets = ((low[:, None] <= high) & (high[:, None] >= low)).all(axis=2)
    expected = [(int(a), int(b)) for a, b in np.argwhere(meets) if a < b]
    assert sorted(map(tuple, sweep.meeting(low, high).tolist())) == expected
    assert len(expected) > 20


@pytest.mark.parametrize("seed", range(3))
def test_points_in_boxes_and_on_their_rims_are_found(seed: int) -> None:
    low, high = boxes(seed, 40)
    points = np.random.default_rng(seed).integers(0, 25, (50, 2)).astype(float)
    inside = ((points[:, None] >= low) & (points[:, None] <= high)).all(axis=2)
    found = sweep.within(points, low, high)
    assert sorted(map(tuple, found.tolist())) == list(zip(*np.nonzero(inside), strict=True))
    assert len(found) > 20


def test_nothing_meets_nothing() -> None:
    none = np.zeros((0, 2))
    assert sweep.meeting(none, none).shape == (0, 2)
    assert sweep.within(none, none, none).shape == (0, 2)
    assert sweep.within(none, *boxes(0, 3)).shape == (0, 2)
