"""Lines that cover lines: interval arithmetic against plain sampling."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill_fabricate.verify.cover import difference, pairs, pieces, stretches, uncovered

Floats = np.ndarray


def gap(points: Floats, ends: Floats) -> Floats:
    """Return the distance (n,) of points from the nearest of straight pieces (m, 2, 2)."""
    a, b = ends[:, 0], ends[:, 1]
    along = b - a
    share = ((points[:, None] - a) * along).sum(axis=2) / (along**2).sum(axis=1)
    foot = a + np.clip(share, 0, 1)[..., None] * along
    nearest: Floats = np.hypot(*(points[:, None] - foot).transpose(2, 0, 1)).min(axis=1)
    return nearest


@pytest.mark.parametrize("seed", range(8))
def test_what_is_near_other_lines_is_what_sampling_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    these = pieces([rng.uniform(0, 10, (4, 2)) for _ in range(5)])
    those = pieces([rng.uniform(0, 10, (3, 2)) for _ in range(6)])
    lonely = uncovered(these, pairs(these, those, 0.8).near())
    for k in range(5):
        mine = these.line == k
        length = float(these.lengths[mine].sum())
        places = np.linspace(0, length, 400)
        points = np.array([these.at(k, place) for place in places])
        far = gap(points, those.ends) > 0.8
        rows = lonely.take(lonely.line == k)
        told = ((places[:, None] > rows.low) & (places[:, None] < rows.high)).any(axis=1)
        at_an_end = np.abs(places[:, None] - np.append(rows.low, rows.high)).min(axis=1, initial=9)
        assert (told == far)[at_an_end > 1e-6].all()


def test_a_piece_along_another_is_counted_once_however_it_is_divided() -> None:
    line = np.array([[0, 0], [40, 30]], float)
    whole = pieces([line])
    there_and_back = [line, line[::-1]]
    broken = [line[0] + (line[1] - line[0]) * np.linspace(0, 1, 7)[:, None]]
    for drawn, often in ((there_and_back, 2), (broken, 1)):
        _, on_line, _, _ = pairs(pieces(drawn), whole, 0.01).along()
        assert not len(difference(on_line, stretches([(0, 0, 50, often)])).line)


def test_crossing_lines_do_not_count_as_running_along_each_other() -> None:
    cross = pieces([np.array([[0, -5], [0, 5]], float), np.array([[-5, 0.4], [5, -0.4]], float)])
    flat = pieces([np.array([[-5, 0], [5, 0]], float)])
    assert not len(pairs(cross, flat, 0.02).along()[1].line)


def test_a_difference_tells_where_and_how_often() -> None:
    found = stretches([(0, 0, 10, 1), (0, 4, 6, 1), (1, 0, 3, 1)])
    wanted = stretches([(0, 0, 10, 1), (1, 0, 5, 1)])
    left = difference(found, wanted)
    rows = zip(left.line, left.low, left.high, left.count, strict=True)
    assert list(rows) == [(0, 4, 6, 1), (1, 3, 5, -1)]
