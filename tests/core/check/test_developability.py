"""Round an inner vertex of a flat sheet there are 360 degrees, in the pattern and in space."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from foldmill import CreasePattern, Fold, FoldedForm
from foldmill.check import developability
from foldmill.check.developability import angle_sums

SQUARE = [[0, 0], [100, 0], [100, 100], [0, 100], [50, 50]]
LINES = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]]


@pytest.fixture
def flat() -> Fold:
    pattern = CreasePattern.from_lines(SQUARE, LINES, "BBBBFFFF")
    return Fold(pattern, FoldedForm(np.column_stack([pattern.vertices, np.zeros(5)])))


def test_a_flat_sheet_has_360_degrees_at_its_only_inner_vertex(flat: Fold) -> None:
    report = developability(flat)
    assert not report.findings
    assert report.figures["angle_sum_vertex"] == 4
    assert float(report.figures["angle_sum_rad"]) < 1e-15


def test_a_pyramid_lacks_angle_at_its_tip_though_its_pattern_has_none_missing(flat: Fold) -> None:
    raised = np.column_stack([flat.pattern.vertices, [0, 0, 0, 0, 50]])
    report = developability(replace(flat, folded=FoldedForm(raised)))
    (finding,) = report.findings
    # The four sides of this pyramid have 70.53° at the tip: arccos(1/3).
    assert report.figures["folded_angle_sum_rad"] == pytest.approx(
        2 * np.pi - 4 * np.arccos(1 / 3), abs=1e-12
    )
    assert finding.code == "folded-angle-sum"
    assert "77.9° too few" in finding.message
    assert finding.where == "vertex 4 at (50.000, 50.000) mm"


def test_the_angles_of_all_triangles_sum_to_half_turns() -> None:
    rng = np.random.default_rng(3)
    points = rng.normal(size=(30, 3))
    faces = np.array([rng.choice(30, 3, replace=False) for _ in range(40)])
    assert angle_sums(points, faces).sum() == pytest.approx(40 * np.pi, abs=1e-11)


def test_a_sheet_without_inner_vertices_has_nothing_to_sum() -> None:
    pattern = CreasePattern.from_lines(SQUARE[:4], LINES[:4], "BBBB")
    assert developability(Fold(pattern)).figures["angle_sum_vertex"] == "none"
