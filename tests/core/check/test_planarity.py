"""Lines on a sheet meet only in vertices, and its faces fill one outline."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from foldmill import CreasePattern, Fold
from foldmill.check import planarity
from foldmill.check.planarity import faults
from foldmill.pattern import Floats, codes_of

SQUARE: list[Any] = [[0, 0], [100, 0], [100, 100], [0, 100]]
RIM = [[0, 1], [1, 2], [2, 3], [3, 0]]


def lines(vertices: list[Any], edges: list[list[int]]) -> Fold:
    """Make a sheet of boundary edges and flat lines without faces."""
    letters = "B" * len(RIM) + "F" * (len(edges) - len(RIM))
    codes, none = codes_of(letters), np.zeros((0, 3), np.intp)
    points = np.array(vertices, float)
    return Fold(CreasePattern(points, np.array(edges), codes, np.zeros(len(edges)), none))


def found(fold: Fold) -> dict[str, str]:
    return {finding.code: str(finding) for finding in planarity(fold).findings}


def test_a_square_with_one_crease_is_a_sheet() -> None:
    fold = Fold(CreasePattern.from_lines(SQUARE, [*RIM, [0, 2]], "BBBBM"))
    report = planarity(fold)
    assert not report.findings
    assert report.figures["area_mm2"] == 10_000
    assert report.figures["area_gap_mm2"] == 0


def test_two_diagonals_without_a_vertex_cross() -> None:
    said = found(lines(SQUARE, [*RIM, [0, 2], [1, 3]]))["edges-cross"]
    assert "1 pair of edges crosses" in said
    assert "(50.000, 50.000) mm" in said


def test_a_vertex_inside_an_edge_is_named_with_the_edge() -> None:
    fold = lines([*SQUARE, [40, 0]], [*RIM, [4, 2]])
    assert "vertex 4 at (40.000, 0.000) mm on edge 0 (0-1)" in found(fold)["vertex-on-edge"]


@pytest.mark.parametrize(("gap", "is_one_point"), [(0.9e-6, True), (1.1e-6, False)])
def test_two_vertices_nearer_than_a_millionth_of_a_millimetre_are_one(
    gap: float, is_one_point: bool
) -> None:
    vertices = [*SQUARE, [50, 50], [50 + gap, 50]]
    fold = lines(vertices, [*RIM, [0, 4], [5, 2]])
    assert ("coincident-vertices" in found(fold)) is is_one_point


def test_an_edge_upon_an_edge_is_seen_by_the_vertex_inside_it() -> None:
    assert "vertex-on-edge" in found(lines([*SQUARE, [40, 40]], [*RIM, [0, 2], [0, 4]]))


def test_a_sheet_has_one_outline() -> None:
    hole = [[40, 40], [60, 40], [50, 60]]
    fold = lines([*SQUARE, *hole], [*RIM, [4, 5], [5, 6], [6, 4]])
    rim = CreasePattern(
        fold.pattern.vertices,
        fold.pattern.edges,
        codes_of("B" * 7),
        np.zeros(7),
        fold.pattern.faces,
    )
    assert "2 closed loops" in found(Fold(rim))["outline"]


def test_an_outline_that_crosses_itself_is_no_outline() -> None:
    bow = [[0, 0], [100, 0], [0, 100], [150, 100]]
    assert "outline" in found(lines(bow, RIM))


def test_a_sheet_without_faces_leaves_its_outline_open() -> None:
    assert "leave open 10000 of the 10000 mm²" in found(lines(SQUARE, RIM))["faces"]


def test_a_fan_that_goes_round_twice_is_paper_upon_paper() -> None:
    angles = np.radians(np.arange(12) * 60 + np.arange(12) / 12)
    radius = np.linspace(50, 100, 12)
    rim = np.column_stack([radius * np.cos(angles), radius * np.sin(angles)])
    edges = [[0, k + 1] for k in range(12)] + [[k + 1, (k + 1) % 12 + 1] for k in range(12)]
    faces = np.array([[0, k + 1, (k + 1) % 12 + 1] for k in range(12)])
    points = np.vstack([[0.0, 0.0], rim])
    letters = codes_of("F" * 12 + "B" * 12)
    fold = Fold(CreasePattern(points, np.array(edges), letters, np.zeros(24), faces))
    assert {"edges-cross", "outline"} <= set(found(fold))


def test_crossings_agree_with_exact_arithmetic() -> None:
    rng = np.random.default_rng(7)
    points = rng.integers(0, 60, (80, 2)).astype(float)
    points = np.unique(points, axis=0)
    order = rng.permutation(len(points) // 2 * 2).reshape(-1, 2)
    expected = {
        (i, j)
        for (i, one), (j, two) in combinations(enumerate(order.tolist()), 2)
        if _cross(points[one], points[two])
    }
    crossing = faults(points, order).crossing
    assert {(int(i), int(j)) for i, j in crossing} == expected
    assert len(expected) > 50


def _cross(one: Floats, two: Floats) -> bool:
    def side(line: Floats, spot: Floats) -> Fraction:
        (ax, ay), (bx, by), (cx, cy) = ([Fraction(v) for v in p] for p in (*line, spot))
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    straddles = [side(a, b[0]) * side(a, b[1]) for a, b in ((one, two), (two, one))]
    return all(product < 0 for product in straddles)
