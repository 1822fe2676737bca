"""The tip of a drag knife trails its holder."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from foldmill_fabricate.verify.blade import STARTS, dragged, tips

SQUARE = 6 * np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], float)


def stepped(path: np.ndarray, offset: float, heading: float, step: float = 1e-3) -> np.ndarray:
    """Pull the tip after the holder in small steps: what a tractrix is, without its formula."""
    tip = path[0] - offset * np.array([np.cos(heading), np.sin(heading)])
    track = [tip]
    for a, b in pairwise(path):
        for share in np.linspace(0, 1, int(np.hypot(*(b - a)) / step) + 2)[1:]:
            holder = a + share * (b - a)
            arm = holder - tip
            tip = holder - offset * arm / np.hypot(*arm)
            track.append(tip)
    return np.array(track)


@pytest.mark.parametrize("offset", [0.25, 0.9])
@pytest.mark.parametrize("heading", [0.0, 0.7, -2.0])
def test_the_tip_goes_where_small_steps_pull_it(offset: float, heading: float) -> None:
    (track,) = tips([SQUARE], offset, heading)
    slow = stepped(SQUARE, offset, heading)
    gaps = np.hypot(*(track[:, None] - slow[None]).transpose(2, 0, 1)).min(axis=1)
    assert gaps.max() < 2e-3


def test_the_blade_stays_as_long_as_it_is_and_keeps_its_direction_when_lifted() -> None:
    first, second = tips([SQUARE[:2], SQUARE[1:3] + 50], 0.25)
    assert first[-1] == pytest.approx([5.75, 0], abs=1e-4)
    assert second[0] == pytest.approx([55.75, 50], abs=1e-4)  # still pointing along +x
    assert second[-1] == pytest.approx([56, 55.75], abs=1e-4)


def test_corners_are_cut_short_by_no_more_than_the_offset() -> None:
    (track,) = tips([SQUARE], 0.25)
    corner = np.hypot(*(track - SQUARE[2]).T).min()
    assert 0.02 < corner < 0.25


def test_blades_that_have_come_to_point_the_same_way_go_on_as_one() -> None:
    paths = [SQUARE, SQUARE[:3] + 50, SQUARE[1:] + 9]
    ways = list(dragged(paths, 0.25, STARTS))
    assert [len(tip) for tip, _ in ways] == [12, 1, 1]
    for start in STARTS.tolist():
        alone = tips(paths, 0.25, start)
        for one, (all_of_them, _) in zip(alone[1:], ways[1:], strict=True):
            assert one == pytest.approx(all_of_them[0], abs=1e-8)


def test_a_holder_that_stays_where_it_is_drags_nothing() -> None:
    (track,) = tips([np.array([[3.0, 4.0], [3.0, 4.0]])], 0.25)
    assert track == pytest.approx(np.array([[2.75, 4.0]]))
