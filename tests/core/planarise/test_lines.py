"""Any lines become a planar graph; a pattern of our own stays as it is."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from foldmill import InvalidInput, installed
from foldmill.planarise import Planar, planarise, planarise_pattern

PRESETS = [(slug, name) for slug, design in installed().designs.items() for name in design.presets]


def lines(found: Planar) -> shapely.Geometry:
    return shapely.multilinestrings(shapely.linestrings(found.points[found.edges]))


def shape(found: Planar) -> list[list[list[float]]]:
    return sorted(sorted(ends.tolist()) for ends in found.points[found.edges].round(6))


@pytest.mark.parametrize(("slug", "name"), PRESETS)
def test_a_pattern_of_our_own_passes_unchanged(slug: str, name: str) -> None:
    design = installed().design(slug)
    pattern = design.run(design.preset(name)).pattern
    found = planarise_pattern(pattern)
    assert np.array_equal(found.points, pattern.vertices)
    assert np.array_equal(found.edges, pattern.edges)
    assert np.array_equal(found.roles, pattern.assignments)
    assert not found.changes


def test_lines_that_cross_are_split_where_they_do() -> None:
    found = planarise([[[0, 0], [10, 0]], [[5, -5], [5, 5]], [[8, 0], [8, 3]]])
    assert found.count("crossing") == 2
    assert len(found.edges) == 6
    assert {(c.x, c.y) for c in found.changes} == {(5.0, 0.0), (8.0, 0.0)}


def test_a_line_on_a_longer_one_is_dropped_and_the_longer_stays_whole() -> None:
    found = planarise([[[3, 0], [6, 0]], [[10, 0], [0, 0]], [[0, 0], [10, 0]]], [7, 1, 2])
    assert shape(found) == [[[0, 0], [10, 0]]]
    assert found.roles.tolist() == [1]
    assert {c.line for c in found.changes if c.what == "overlap"} == {0, 2}


def test_lines_that_overlap_by_their_ends_become_one() -> None:
    found = planarise([[[0, 0], [10, 0]], [[8, 0], [12, 0]]])
    assert shape(found) == [[[0, 0], [12, 0]]]


def test_collinear_crumbs_become_one_line_but_never_across_roles() -> None:
    ends = np.stack([np.arange(5.0), np.zeros(5)], axis=1)
    run = np.stack([ends[:-1], ends[1:]], axis=1)
    assert shape(planarise(run)) == [[[0, 0], [4, 0]]]
    assert len(planarise(run, [0, 0, 1, 1]).edges) == 2


def test_a_fine_polygon_keeps_its_shape() -> None:
    angle = np.linspace(0, 2 * np.pi, 2001)
    rim = 100 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    found = planarise(np.stack([rim[:-1], rim[1:]], axis=1))
    assert shapely.hausdorff_distance(lines(found), shapely.LineString(rim)) < 2e-3


def test_the_report_says_what_was_done() -> None:
    crumb = planarise([[[0, 0], [0, 0]], [[0, 0], [4, 0]], [[0, 0], [4, 0]]])
    assert crumb.report() == "1 overlapping stretches dropped, 1 crumbs dropped."
    assert planarise([[[0, 0], [4, 0]]]).report() == "Nothing had to be changed."


def test_what_is_no_table_of_lines_is_refused() -> None:
    with pytest.raises(InvalidInput, match="n, 2, 2"):
        planarise([[0, 1], [2, 3]])


@given(st.integers(0, 10_000), st.integers(1, 14), st.integers(3, 9))
def test_lines_on_a_grid_keep_their_union_and_nothing_crosses(
    seed: int, count: int, size: int
) -> None:
    rng = np.random.default_rng(seed)
    given_lines = rng.integers(0, size, (count, 2, 2)).astype(float)
    found = planarise(given_lines)
    whole = shapely.union_all(shapely.linestrings(given_lines))  # a second implementation
    if whole.length:
        assert shapely.hausdorff_distance(lines(found), whole) < 5e-3
    assert lines(found).length == pytest.approx(whole.length, abs=1e-2)
    if len(found.edges):
        assert not planarise(found.points[found.edges]).changes
