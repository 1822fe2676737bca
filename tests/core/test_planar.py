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
