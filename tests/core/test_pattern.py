"""The crease pattern refuses what is no sheet, and finds the facets between lines."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill import Assignment, CreasePattern, InvalidPattern
from foldmill.planar import signed_area

SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10]]
RIM = [[0, 1], [1, 2], [2, 3], [3, 0]]


def folded_square(**changes: Any) -> CreasePattern:
    """Make a square with a valley diagonal 0-2 as edge 4."""
    values: dict[str, Any] = {
        "vertices": SQUARE,
        "edges": [*RIM, [0, 2]],
        "assignments": [0, 0, 0, 0, 2],
        "fold_angles": [0, 0, 0, 0, 90],
        "faces": [[0, 1, 2], [0, 2, 3]],
    }
    return CreasePattern(**(values | changes))


def test_a_folded_square_knows_its_creases_and_outline() -> None:
    sheet = folded_square()
    assert sheet.letters() == "BBBBV"
    assert sheet.count(Assignment.B) == 4
    assert sheet.edge_faces.tolist()[4] == [1, 0]  # left of 0→2 lies the upper triangle
    assert sheet.size == 10
    assert [signed_area(sheet.vertices[loop]) for loop in sheet.outline()] == [100]
    assert sheet.interior_vertices.size == 0


def test_a_pattern_cannot_be_changed_after_it_was_made() -> None:
    given = np.array(SQUARE, float)
    sheet = folded_square(vertices=given)
    given[0] = 99
    assert sheet.vertices[0].tolist() == [0, 0]
    with pytest.raises(ValueError, match="read-only"):
        sheet.vertices[0] = 1


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"vertices": [[0, 0], [10, np.nan], [10, 10], [0, 10]]}, "vertex 1 is not finite"),
        ({"vertices": [0, 10, 10, 0]}, r"vertices has the shape \(4,\), not \(n, 2\)"),
        ({"vertices": [[0, 0], [10]]}, "vertices: "),
        ({"vertices": "a square"}, "vertices: could not convert"),
        ({"edges": [*RIM, [0, 7]]}, "edge 4 names no vertex"),
        ({"edges": [*RIM, [0, -2]]}, "edge 4 names no vertex"),
        ({"edges": [*RIM, [0, 2.5]]}, "edges: its numbers must be whole"),
        ({"edges": [*RIM, [0, np.nan]]}, "edges: "),
        ({"edges": [*RIM, [2, 2]]}, "edge 4 has no length"),
        ({"edges": [*RIM, [1, 0]]}, "edge 4 repeats an earlier edge"),
        ({"edges": [*RIM, [1, 3]]}, "face 0 has the side 2-0, which is no edge"),
        ({"assignments": [0, 0, 0, 0]}, "5 edges need as many assignments"),
        ({"assignments": [0, 0, 0, 0, 9]}, "edge 4 has an unknown assignment"),
        ({"assignments": [0, 0, 0, 0, 300]}, "assignments: "),
        ({"assignments": np.array([0, 0, 0, 0, 258])}, "assignments: its numbers"),
        ({"assignments": [[0, 0, 0, 0, 2]]}, r"assignments has the shape \(1, 5\), not \(n,\)"),
        ({"assignments": [0, 0, 0, 0, 1]}, "edge 4: a mountain folds by a negative angle"),
        ({"assignments": [0, 0, 0, 0, 3]}, "edge 4 is no crease and yet has a fold angle"),
        ({"assignments": [0, 0, 0, 0, 0], "fold_angles": [0] * 5}, "edge 4 is boundary"),
        ({"assignments": [2, 0, 0, 0, 2]}, "edge 0 is a crease, but has not a face"),
        ({"fold_angles": [0, 0, 0, 0]}, "5 edges need as many fold_angles"),
        ({"fold_angles": [0, 0, 0, 0, 181]}, "edge 4 folds by more than 180"),
        ({"fold_angles": [0, 0, 0, 0, np.nan]}, "edge 4 folds by more than 180"),
        ({"fold_angles": [0, 0, 0, 0, -90]}, "edge 4: a mountain folds by a negative"),
        ({"faces": [[0, 1, 2], [0, 3, 2]]}, "face 1 does not run counter-clockwise"),
        ({"faces": [[0, 1, 2], [0, 2, 4]]}, "face 1 names no vertex"),
        ({"faces": [[0, 1, 2], [0, 1, 2]]}, "face 1 overlaps another face along the edge 0-1"),
        ({"faces": [[0, 1, 2.5]]}, "faces: its numbers must be whole"),
        ({"added": [True]}, "5 edges need as many added"),
        ({"polygons": [0]}, "2 faces need as many polygon numbers"),
    ],
)
def test_what_is_no_sheet_is_refused_by_index_and_reason(
    changes: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InvalidPattern, match=sentence) as refusal:
        folded_square(**changes)
    assert isinstance(refusal.value, ValueError)
    assert str(refusal.value).endswith(".")


def test_several_faults_are_counted() -> None:
    with pytest.raises(InvalidPattern, match=r"edge 0 folds by more .* \(and 1 more\)"):
        folded_square(fold_angles=[200, 0, 300, 0, 90])


def test_lines_alone_become_facets() -> None:
    sheet = CreasePattern.from_lines(SQUARE, [*RIM, [2, 0]], "BBBBM")
    assert {frozenset(face) for face in sheet.faces.tolist()} == {
        frozenset({0, 1, 2}),
        frozenset({0, 2, 3}),
    }
    assert sheet.fold_angles.tolist() == [0, 0, 0, 0, -180]
    assert sheet.added is not None
    assert not sheet.added.any()


L_SHAPE = [[0, 0], [20, 0], [20, 10], [10, 10], [10, 20], [0, 20]]
ARROW = [[0, 0], [10, 4], [20, 0], [10, 30]]
COMB = [[0, 0], [50, 0], [50, 20], [40, 3], [30, 20], [20, 3], [10, 20], [5, 3], [0, 20]]
KITE_WITH_STRAIGHT_CORNER = [[0, 0], [5, 0], [10, 0], [5, 9]]


@pytest.mark.parametrize("rim", [L_SHAPE, ARROW, COMB, KITE_WITH_STRAIGHT_CORNER])
def test_polygons_are_cut_into_triangles_by_edges_marked_as_added(rim: list[list[int]]) -> None:
    n = len(rim)
    sheet = CreasePattern.from_lines(rim, [[k, (k + 1) % n] for k in range(n)], "B" * n)
    areas = [signed_area(sheet.vertices[face]) for face in sheet.faces]
    assert len(areas) == n - 2
    assert min(areas) > 0
    assert sum(areas) == pytest.approx(signed_area(sheet.vertices), rel=1e-12)
    assert sheet.added is not None
    assert sheet.added.tolist() == [False] * n + [True] * (n - 3)
    assert sheet.letters() == "B" * n + "F" * (n - 3)
    assert sheet.polygons is not None
    assert set(sheet.polygons.tolist()) == {0}


def test_each_triangle_remembers_its_polygon() -> None:
    corners = [[0, 0], [10, 0], [20, 0], [20, 10], [10, 10], [0, 10]]
    lines = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 0], [1, 4]]
    sheet = CreasePattern.from_lines(corners, lines, "BBBBBBV", [0, 0, 0, 0, 0, 0, 30])
    assert sheet.polygons is not None
    centres = sheet.vertices[sheet.faces].mean(axis=1)
    left = set(sheet.polygons[centres[:, 0] < 10].tolist())
    right = set(sheet.polygons[centres[:, 0] > 10].tolist())
    assert len(left) == len(right) == 1
    assert left != right


@pytest.mark.parametrize(
    ("corners", "lines", "letters", "sentence"),
    [
        (SQUARE, [*RIM, [0, 2], [1, 3]], "BBBBMM", "cross or overlap .* give them a vertex"),
        (SQUARE, [*RIM, [0, 9]], "BBBBM", "edge 4 names no vertex"),
        (SQUARE, [*RIM, [0, -1]], "BBBBM", "edge 4 names no vertex"),
        (SQUARE, [[0, 1, 2]], "B", r"edges has the shape \(1, 3\)"),
        (SQUARE, RIM, "BBBX", "one of B M V F U C, not 'X'"),
        (SQUARE, RIM, "BBB", "4 edges need as many assignments, not 3"),
        ([[0, 0], [np.inf, 0], [0, 9]], [[0, 1], [1, 2], [2, 0]], "BBB", "vertex 1 is not finite"),
        ([*SQUARE, [3, 2], [6, 4]], [*RIM, [4, 5]], "BBBBM", "edge 4 is a crease, but has not"),
    ],
)
def test_lines_that_make_no_facets_are_refused(
    corners: list[list[float]], lines: list[list[int]], letters: str, sentence: str
) -> None:
    with pytest.raises(InvalidPattern, match=sentence):
        CreasePattern.from_lines(corners, lines, letters)
