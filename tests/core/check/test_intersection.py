"""Which facets pass through each other: by hand, and by a slow second rule over random heaps."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import pytest

from foldmill.check import intersection
from foldmill.check.intersection import penetrations

Points = Sequence[Sequence[float]]
FLOOR: Points = [[0, 0, 0], [10, 0, 0], [0, 10, 0]]


def hits(vertices: Points, faces: Sequence[Sequence[int]]) -> list[list[int]]:
    sides = np.sort(np.array([[f[k], f[k - 1]] for f in faces for k in range(3)]), axis=1)
    edges = np.unique(sides, axis=0)
    found: list[list[int]] = penetrations(
        np.array(vertices, float), edges, np.array(faces)
    ).tolist()
    return found


def two(second: Points) -> list[list[int]]:
    return hits([*FLOOR, *second], [[0, 1, 2], [3, 4, 5]])


def test_a_triangle_stuck_through_another_penetrates() -> None:
    assert two([[2, 2, -3], [3, 2, 3], [2, 3, 3]]) == [[0, 1]]


def test_two_triangles_that_cut_each_others_edge_penetrate() -> None:
    assert two([[5, -2, 0.1], [2, 3, 4], [2, 3, -4]]) == [[0, 1]]


@pytest.mark.parametrize(
    "second",
    [
        [[2, 2, 0], [3, 2, 3], [2, 3, 3]],  # a corner on the face
        [[2, 2, 0], [4, 2, 0], [2, 3, 3]],  # an edge on the face
        [[2, 2, 0], [4, 2, 0], [2, 4, 0]],  # the whole triangle on the face
        [[-2, -2, 0], [8, 2, 0], [2, 8, 0]],  # overlapping in one plane
        FLOOR,  # one upon the other
        [[10, 0, 0], [12, 0, 3], [12, 0, -3]],  # a straddling edge beyond the corner
        [[5, 0, -3], [5, 0, 3], [5, -4, 0]],  # an edge that touches an edge from outside
        [[20, 20, -1], [21, 20, 1], [20, 21, 1]],  # far away
    ],
)
def test_touching_is_not_penetration(second: Points) -> None:
    assert two(second) == []


def test_facets_that_share_a_corner_may_still_penetrate() -> None:
    shared = [*FLOOR, [6, 4, -3], [6, 4, 3]]
    assert hits(shared, [[0, 1, 2], [0, 3, 4]]) == [[0, 1]]
    apart = [*FLOOR, [-6, 4, -3], [-6, 4, 3]]
    assert hits(apart, [[0, 1, 2], [0, 3, 4]]) == []


@pytest.mark.parametrize("height", [0.0, 1e-12, 3.0])
def test_facets_that_share_an_edge_never_penetrate(height: float) -> None:
    assert hits([*FLOOR, [2, 2, height]], [[0, 1, 2], [1, 0, 3]]) == []


CREASE: Points = [[1, 2, 0], [4, 2, 0]]


@pytest.mark.parametrize("reverse", [False, True])
def test_a_sheet_that_passes_exactly_along_its_own_crease_penetrates(reverse: bool) -> None:
    floor = [[0, 2, 1]] if reverse else [[0, 1, 2]]
    above_and_below = [*FLOOR, *CREASE, [2, 3, 5], [2, 1, -5]]
    assert hits(above_and_below, [*floor, [3, 4, 5], [4, 3, 6]]) == [[0, 1], [0, 2]]


def test_a_fold_that_rests_on_a_facet_with_its_crease_does_not_penetrate() -> None:
    tent = [*FLOOR, *CREASE, [2, 3, 5], [2, 1, 5]]
    assert hits(tent, [[0, 1, 2], [3, 4, 5], [4, 3, 6]]) == []


def test_a_crease_along_the_rim_of_a_facet_does_not_penetrate() -> None:
    rim = [*FLOOR, [1, 0, 0], [4, 0, 0], [2, 1, 5], [2, 1, -5]]
    assert hits(rim, [[0, 1, 2], [3, 4, 5], [4, 3, 6]]) == []


def test_penetration_less_than_the_tolerance_is_touching() -> None:
    for depth, expected in ((1e-9, []), (1e-3, [[0, 1]])):
        assert two([[2, 2, -depth], [3, 2, 3], [2, 3, 3]]) == expected


def penetrate(one: np.ndarray, other: np.ndarray) -> bool:
    """Judge by edges: in general position triangles cross iff an edge of one pierces the other."""

    def volume(a: np.ndarray, *others: np.ndarray) -> float:
        return float(np.linalg.det(np.array(others) - a))

    def pierces(p: np.ndarray, q: np.ndarray, triangle: np.ndarray) -> bool:
        if volume(p, *triangle) * volume(q, *triangle) >= 0:
            return False
        turns = [volume(p, q, triangle[k], triangle[(k + 1) % 3]) for k in range(3)]
        return min(turns) > 0 or max(turns) < 0

    pairs = ((one, other), (other, one))
    return any(pierces(t[k], t[k - 1], against) for t, against in pairs for k in range(3))


@pytest.mark.parametrize("seed", range(8))
def test_a_second_rule_agrees_on_random_heaps_of_triangles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = 26
    corners = rng.uniform(-1, 1, (count, 1, 3)) + rng.uniform(-1.2, 1.2, (count, 3, 3))
    expected = [
        [a, b]
        for a, b in itertools.combinations(range(count), 2)
        if penetrate(corners[a], corners[b])
    ]
    faces = np.arange(3 * count).reshape(-1, 3)
    found = hits(corners.reshape(-1, 3).tolist(), faces.tolist())
    assert found == expected
    assert len(found) > 10


def test_only_pairs_with_a_face_of_interest_are_reported() -> None:
    rng = np.random.default_rng(9)
    points, faces = rng.uniform(-1, 1, (60, 3)), np.arange(60).reshape(-1, 3)
    edges = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    every = penetrations(points, edges, faces)
    some = penetrations(points, edges, faces, np.array([3, 7]))
    assert some.tolist() == every[np.isin(every, [3, 7]).any(axis=1)].tolist()
    assert 0 < len(some) < len(every)


@pytest.mark.parametrize("seed", range(4))
def test_a_mesh_too_large_for_one_table_gets_the_same_verdicts(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(seed)
    # Corners on a coarse grid, so that facets also lie in each other's planes and cross at creases.
    points, faces = rng.integers(-3, 4, (40, 3)).astype(float), rng.integers(0, 40, (60, 3))
    faces = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    sides = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.unique(np.sort(sides, axis=1), axis=0)
    some = rng.integers(0, len(faces), 9)
    whole = [penetrations(points, edges, faces, among) for among in (None, some)]
    monkeypatch.setattr(intersection, "_BLOCK", 500)
    parts = [penetrations(points, edges, faces, among) for among in (None, some)]
    assert [each.tolist() for each in parts] == [each.tolist() for each in whole]
    assert len(whole[0]) > len(whole[1]) > 0
