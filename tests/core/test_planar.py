"""Faces and loops of lines in the plane."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import planar

TWO_SQUARES = np.array([[0, 0], [5, 0], [5, 5], [0, 5], [10, 5], [10, 10], [5, 10.0]])
TOUCHING = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [2, 4], [4, 5], [5, 6], [6, 2]])


def test_an_area_is_positive_counter_clockwise() -> None:
    square = np.array([[0, 0], [3, 0], [3, 2], [0, 2.0]])
    assert planar.signed_area(square) == 6
    assert planar.signed_area(square[::-1]) == -6


def test_loops_that_touch_in_a_vertex_stay_two_loops() -> None:
    loops = planar.loops(TWO_SQUARES, TOUCHING)
    assert sorted(sorted(loop.tolist()) for loop in loops) == [[0, 1, 2, 3], [2, 4, 5, 6]]


def test_the_largest_loop_comes_first_and_all_run_counter_clockwise() -> None:
    small, large = (
        np.array([[4, 4], [4, 6], [6, 6], [6, 4.0]]),
        np.array([[0, 0], [10, 0], [10, 10], [0, 10.0]]),
    )
    edges = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]])
    loops = planar.loops(np.vstack([small, large]), edges)
    points = np.vstack([small, large])
    assert [planar.signed_area(points[loop]) for loop in loops] == [100, 4]


def test_edges_that_close_no_loop_are_left_out() -> None:
    assert planar.loops(TWO_SQUARES, np.array([[0, 1], [1, 2]])) == []
    assert planar.loops(TWO_SQUARES, np.zeros((0, 2), np.intp)) == []


@pytest.mark.parametrize("seed", range(5))
def test_a_grid_with_random_diagonals_has_every_face_once(seed: int) -> None:
    rng = np.random.default_rng(seed)
    side = 5
    points = np.array([[x, y] for y in range(side) for x in range(side)], float)
    points += rng.uniform(-0.2, 0.2, points.shape)
    edges, faces = [], 0
    for y in range(side):
        for x in range(side):
            here = y * side + x
            edges += [[here, here + 1]] * (x < side - 1) + [[here, here + side]] * (y < side - 1)
            if x < side - 1 and y < side - 1:
                choice = int(rng.integers(3))
                edges += [[[here, here + side + 1]], [[here + 1, here + side]], []][choice]
                faces += 1 + (choice < 2)
    found = planar.polygons(points, np.array(edges))
    assert len(found) == faces
    rim = [
        *range(side - 1),
        *range(side - 1, side * side - 1, side),
        *range(side * side - 1, side * (side - 1), -1),
        *range(side * (side - 1), 0, -side),
    ]
    total = sum(planar.signed_area(points[loop]) for loop in found)
    assert total == pytest.approx(planar.signed_area(points[rim]), rel=1e-12)


def test_the_face_left_and_right_of_an_edge_is_told_apart() -> None:
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    edges = np.array([[0, 2], [2, 0], [0, 1], [1, 0]])
    assert planar.edge_faces(edges, faces).tolist() == [[1, 0], [0, 1], [0, -1], [-1, 0]]


def test_an_edge_drawn_both_ways_is_one_pair() -> None:
    pairs, first = planar.unique_pairs(np.array([[7, 2], [0, 3], [2, 7], [3, 0], [1, 1]]))
    assert pairs.tolist() == [[0, 3], [1, 1], [2, 7]]
    assert first.tolist() == [1, 4, 0]
    assert len(planar.unique_pairs(np.zeros((0, 2), np.intp))[0]) == 0


def test_of_two_faces_with_the_same_side_the_last_has_it() -> None:
    faces = np.array([[0, 1, 2], [3, 0, 1]])
    assert planar.edge_faces(np.array([[0, 1], [1, 3]]), faces).tolist() == [[1, -1], [1, -1]]
    assert planar.edge_faces(np.array([[0, 1]]), np.zeros((0, 3), np.intp)).tolist() == [[-1, -1]]
    assert planar.edge_faces(np.zeros((0, 2), np.intp), faces).shape == (0, 2)


@pytest.mark.parametrize(
    ("edges", "faces", "said"),
    [
        ([[0, 1], [1, 2], [2, 0]], [[0, 1, 2]], None),
        ([[0, 1], [1, 2]], [[0, 1, 2]], "face 0 has the side 2-0, which is no edge"),
        (
            [[0, 1], [1, 2], [2, 0], [1, 3], [3, 0]],
            [[0, 1, 2], [0, 1, 3]],
            "face 1 overlaps another face along the edge 0-1",
        ),
        ([[0, 1]], [], None),
    ],
)
def test_a_fault_of_faces_and_edges_is_named(
    edges: list[list[int]], faces: list[list[int]], said: str | None
) -> None:
    found = planar.topology_fault(np.array(edges), np.array(faces, np.intp).reshape(-1, 3))
    assert found == said
