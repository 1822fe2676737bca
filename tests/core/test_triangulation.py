"""Polygons become triangles that cover them exactly, whichever way they are asked for."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from foldmill.errors import InvalidPattern
from foldmill.planar import polygons, signed_area
from foldmill.planarise import planarise
from foldmill.triangulation import triangulate


def drawn(seed: int) -> tuple[np.ndarray, list[list[int]]]:
    """A square that random lines divide into polygons of all sizes."""
    rng = np.random.default_rng(seed)
    box = np.array([[0, 0], [100, 0], [100, 100], [0, 100], [0, 0.0]])
    tall = np.stack([np.full(12, 0.0), rng.uniform(0, 100, 12)], 1)
    wide = np.stack([np.full(12, 100.0), rng.uniform(0, 100, 12)], 1)
    lines = np.vstack([np.stack([box[:-1], box[1:]], 1), np.stack([tall, wide], 1)])
    found = planarise(lines)
    return found.points, polygons(found.points, found.edges)


@pytest.mark.parametrize("seed", range(6))
def test_triangles_cover_each_polygon_and_nothing_else(seed: int) -> None:
    points, loops = drawn(seed)
    faces, owners, added = triangulate(points, loops)
    assert owners.tolist() == sorted(owners.tolist())
    for number, loop in enumerate(loops):
        own = faces[owners == number]
        assert len(own) == len(loop) - 2
        assert all(signed_area(points[face]) > 0 for face in own)
        whole = shapely.union_all(shapely.polygons(points[own]))
        assert whole.symmetric_difference(shapely.Polygon(points[loop])).area < 1e-9
    assert len(added) == sum(len(loop) - 3 for loop in loops)


@pytest.mark.parametrize("seed", range(3))
def test_many_polygons_are_cut_as_each_would_be_alone(seed: int) -> None:
    points, loops = drawn(seed)
    alone = [triangulate(points, [loop]) for loop in loops]
    faces, _, added = triangulate(points, loops)
    assert faces.tolist() == [face for each in alone for face in each[0].tolist()]
    assert added.tolist() == [pair for each in alone for pair in each[2].tolist()]


def test_the_first_corner_of_a_polygon_does_not_matter() -> None:
    points, loops = drawn(7)
    turned = [loop[2:] + loop[:2] if len(loop) > 3 else loop for loop in loops]
    assert triangulate(points, turned)[0].tolist() == triangulate(points, loops)[0].tolist()


def test_no_polygons_are_no_triangles() -> None:
    faces, owners, added = triangulate(np.zeros((0, 2)), [])
    assert (faces.shape, owners.shape, added.shape) == ((0, 3), (0,), (0, 2))


def test_a_polygon_whose_lines_cross_is_refused_by_its_place() -> None:
    points = np.array([[0, 0], [9, 0], [1, 9], [9, 5], [30, 0], [40, 0], [40, 9], [30, 9.0]])
    with pytest.raises(InvalidPattern, match=r"polygon at \(0, 0\)"):
        triangulate(points, [[4, 5, 6, 7], [0, 1, 2, 3]])
