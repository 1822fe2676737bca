"""A half strip, mirrored and set side by side N times, is one band, and in space a tube."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill.axisymmetric import tube
from foldmill.axisymmetric.tube import Sheet, Tube

FLAT = np.array([(0, 0), (10, 3), (0, 14), (10, 17), (0, 30), (10, 33)], float)


def prism(order: int, last: int = 6) -> Tube:
    """Return an upright tube whose facets all stand on a circle: every r is the same."""
    radius = 10 / (2 * np.sin(np.pi / order / 2))
    places = np.column_stack([np.full(last, radius), FLAT[:last, 1]])
    return tube.assemble(tube.half_wedge(order, FLAT[:last], places))


@pytest.mark.parametrize("last", [4, 5, 6])
@pytest.mark.parametrize("order", [3, 8, 11])
def test_the_band_is_a_disc_whose_two_ends_are_one_in_space(order: int, last: int) -> None:
    whole = prism(order, last)
    on_l1, on_l2 = (last + 1) // 2, last // 2
    assert len(whole.flat) == order * on_l1 + (order + 1) * on_l2
    assert len(whole.faces) == 2 * order * (last - 2)
    assert len(whole.flat) - len(whole.edges) + len(whole.faces) == 1
    assert (whole.edge_faces < 0).any(axis=1).sum() == 4 * order + 2 * (on_l2 - 1)
    assert whole.seams.shape == (on_l2, 2)
    ends = whole.spatial[whole.seams]
    assert np.abs(ends[:, 1] - ends[:, 0]).max() <= 4e-15 * np.abs(whole.spatial).max()
    across = whole.flat[whole.seams[:, 1]] - whole.flat[whole.seams[:, 0]]
    assert across == pytest.approx(np.tile([20.0 * order, 0.0], (on_l2, 1)))
    assert (np.diff(whole.flat[whole.seams[:, 0], 1]) > 0).all()


def test_the_band_is_n_equal_wedges_between_its_two_seams() -> None:
    whole = prism(5)
    assert (whole.flat[:, 0].min(), whole.flat[:, 0].max()) == (-10, 90)
    inner = whole.flat[whole.flat[:, 0] < 70]
    moved = inner + np.array([20, 0])
    gaps = np.linalg.norm(moved[:, None] - whole.flat[None], axis=2).min(axis=1)
    assert gaps.max() < 1e-12


def test_a_pattern_keeps_its_lengths_in_space() -> None:
    whole = prism(8)
    lengths = [
        np.linalg.norm(np.diff(spots[whole.edges], axis=1)[:, 0], axis=1)
        for spots in (whole.flat, whole.spatial)
    ]
    assert np.abs(lengths[0] - lengths[1]).max() < 1e-12


def test_less_than_half_a_turn_a_wedge_leaves_the_tube_open() -> None:
    whole = prism(8)
    places = whole.turned(whole.half.spatial, np.pi / 16)
    ends = places[whole.seams]
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).min() > 10


@pytest.mark.parametrize("order", [3, 8])
def test_the_front_of_a_tube_is_its_outside_either_way_up(order: int) -> None:
    whole = prism(order)
    upright = Sheet.of(whole)
    assert not upright.is_inside_out
    hanging = Sheet(whole.flat, whole.spatial * [1, 1, -1], whole.edges, whole.faces, whole.seams)
    assert hanging.is_inside_out
    for sheet in (upright, hanging):
        pattern, form = sheet.finish(np.zeros(0, np.intp))
        a, b, c = (form.vertices[pattern.faces[:, k]] for k in range(3))
        outwards = (np.cross(b - a, c - a) * (a + b + c))[:, :2].sum(axis=1)
        assert (outwards > 0).all()
        assert np.array_equal(form.seams, whole.seams)
        # Standing on a circle, it turns by the same angle at every upright line: all mountains.
        assert pattern.letters().count("V") == 0
        assert pattern.letters().count("M") == 2 * order + 2 * (order - 1)
