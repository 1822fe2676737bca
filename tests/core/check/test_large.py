"""The tree that finds the penetrations of large forms agrees with looking at every pair."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from foldmill.check import intersection, large

Mesh = tuple[np.ndarray, np.ndarray]


def edges_of(faces: np.ndarray) -> np.ndarray:
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return np.unique(sides, axis=0)


def heap(seed: int) -> Mesh:
    """Loose triangles anywhere in a box."""
    points = np.random.default_rng(seed).uniform(0, 10, (60, 3))
    return points, np.arange(60).reshape(-1, 3)


def lattice(seed: int) -> Mesh:
    """Triangles with corners on whole numbers: creases lie in planes, corners on corners."""
    points = np.random.default_rng(seed).integers(0, 4, (90, 3)).astype(float)
    return points, np.arange(90).reshape(-1, 3)


def sheet(seed: int) -> Mesh:
    """A crumpled sheet of triangles on whole heights."""
    n = 9
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), rng.integers(-2, 3, n * n)]).astype(float)
    points[:, :2] += rng.integers(-1, 2, (n * n, 2))
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    low = np.column_stack([corner, corner + n, corner + 1])
    high = np.column_stack([corner + n, corner + n + 1, corner + 1])
    return points, np.vstack([low, high])


def crossed(_: int) -> Mesh:
    """A folded sheet that passes through a facet exactly along its own crease."""
    points = [[0, 0, 0], [10, 0, 0], [0, 10, 0], [2, 2, 0], [4, 2, 0], [3, 3, 3], [3, 3, -3]]
    return np.array(points, float), np.array([[0, 1, 2], [3, 4, 5], [4, 3, 6]])


@pytest.mark.parametrize("make", [heap, lattice, sheet, crossed])
@pytest.mark.parametrize("seed", range(6))
def test_both_ways_find_the_same_pairs(make: Callable[[int], Mesh], seed: int) -> None:
    points, faces = make(seed)
    eps = 1e-6
    normals = np.cross(
        points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]
    )
    faces = faces[np.linalg.norm(normals, axis=1) > 0]
    whole = intersection.penetrations(points, edges_of(faces), faces)
    assert np.array_equal(large.penetrations(points, faces, eps), whole)
    assert len(whole)
    some = np.arange(0, len(faces), 3)
    few = intersection.penetrations(points, edges_of(faces), faces, some)
    assert np.array_equal(large.penetrations(points, faces, eps, some), few)


def test_a_large_form_is_handed_to_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    points, faces = sheet(1)
    whole = intersection.penetrations(points, edges_of(faces), faces)
    monkeypatch.setattr(intersection, "MANY", 0)
    monkeypatch.setattr(intersection, "_straddling", None)
    assert np.array_equal(intersection.penetrations(points, edges_of(faces), faces), whole)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_boxes_that_overlap_are_found_whichever_way_they_are_stacked(axis: int) -> None:
    rng = np.random.default_rng(axis)
    corners = rng.uniform(0, 1, (300, 3, 3)) + 8 * rng.uniform(0, 1, (300, 1, 3))
    corners[:, :, axis] *= 0.01
    low, high = corners.min(axis=1), corners.max(axis=1)
    meets = ((low[:, None] <= high[None]) & (high[:, None] >= low[None])).all(axis=2)
    np.fill_diagonal(meets, False)
    found = np.vstack(list(large.near_pairs(corners, np.arange(300))))
    assert {tuple(pair) for pair in found.tolist()} == {
        (int(a), int(b)) for a, b in np.argwhere(meets)
    }
