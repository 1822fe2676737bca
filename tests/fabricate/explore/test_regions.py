"""Regions against a second implementation: a flood that walks from neighbour to neighbour."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from foldmill_fabricate.explore import Axis, Grid
from foldmill_fabricate.explore.regions import closes, regions

Cells = NDArray[np.bool_]


def axis(count: int, *, whole: bool = False, name: str = "x") -> Axis:
    return Axis(name, np.arange(count, dtype=float), "mm", whole)


def neighbours(
    place: tuple[int, ...], shape: tuple[int, ...], joined: tuple[bool, ...], whole: list[bool]
) -> list[tuple[int, ...]]:
    found = []
    for k, length in enumerate(shape):
        for step in (-1, 1):
            moved = place[k] + step
            if joined[k]:
                moved %= length
            if not whole[k] and 0 <= moved < length:
                found.append((*place[:k], moved, *place[k + 1 :]))
    return found


def flooded(cells: Cells, joined: tuple[bool, ...], whole: list[bool]) -> set[frozenset[int]]:
    left = {tuple(map(int, place)) for place in np.argwhere(cells)}
    found = set()
    while left:
        front, region = [left.pop()], []
        while front:
            place = front.pop()
            region.append(int(np.ravel_multi_index(place, cells.shape)))
            near = [n for n in neighbours(place, cells.shape, joined, whole) if n in left]
            left -= set(near)
            front += near
        found.add(frozenset(region))
    return found


@pytest.mark.parametrize("seed", range(30))
def test_regions_are_what_a_flood_reaches(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shape = tuple(int(n) for n in rng.integers(1, 9, rng.integers(1, 4)))
    cells = rng.random(shape) < rng.choice([0.3, 0.5, 0.8])
    joined = tuple(bool(j) for j in rng.random(len(shape)) < 0.4)
    whole = [bool(w) and not j for w, j in zip(rng.random(len(shape)) < 0.3, joined, strict=True)]
    axes = [
        axis(n, whole=w, name=f"x{k}") for k, (n, w) in enumerate(zip(shape, whole, strict=True))
    ]
    labels, found = regions(Grid(tuple(axes)), cells.ravel(), joined)
    assert {frozenset(np.flatnonzero(labels == r.number).tolist()) for r in found} == flooded(
        cells, joined, whole
    )
    assert [r.size for r in found] == sorted((r.size for r in found), reverse=True)
    assert all(labels[r.centre] == r.number for r in found)
    assert np.array_equal(labels > 0, cells.ravel())


def test_the_centre_is_the_row_farthest_from_all_that_is_not_free() -> None:
    rng = np.random.default_rng(7)
    cells = rng.random((15, 20)) < 0.85
    grid = Grid((axis(15, name="a"), axis(20, name="b")))
    labels, found = regions(grid, cells.ravel(), (False, False))
    edge = np.pad(cells, 1)
    taken = np.argwhere(~edge) - 1
    depth = np.array(
        [np.linalg.norm(taken - place, axis=1).min() for place in np.ndindex(*cells.shape)]
    )
    for region in found:
        assert depth[region.centre] == pytest.approx(depth[labels == region.number].max())
        assert region.depth == pytest.approx(depth[region.centre])


def test_a_region_across_the_end_of_a_turn_is_one_and_its_range_goes_on() -> None:
    round_ = Axis("beta", np.arange(0.0, 360.0, 10.0), "deg", False)
    is_free = (round_.values >= 330) | (round_.values <= 20)
    apart = regions(Grid((round_,)), is_free, (False,))[1]
    whole = regions(Grid((round_,)), is_free, (True,))[1]
    assert [r.size for r in apart] == [3, 3]
    assert [(r.size, r.ranges["beta"]) for r in whole] == [(6, (330, 380))]
    assert round_.values[whole[0].centre] in {350, 0}


def test_whole_numbers_have_nothing_between_them() -> None:
    cells = np.ones((3, 5), bool)
    grid = Grid((axis(3, whole=True, name="n"), axis(5, name="x")))
    found = regions(grid, cells.ravel(), (False, False))[1]
    assert [(r.size, r.centre) for r in found] == [(5, 2), (5, 7), (5, 12)]


def test_where_nothing_is_free_there_is_no_region() -> None:
    labels, found = regions(Grid((axis(4),)), np.zeros(4, bool), (True,))
    assert not labels.any()
    assert found == ()


@pytest.mark.parametrize(
    ("values", "unit", "does"),
    [
        (np.arange(0.0, 360.0, 10.0), "deg", True),
        (np.arange(0.0, 361.0, 10.0), "deg", True),
        (np.arange(180.0, -180.0, -5.0), "deg", True),
        (np.arange(0.0, 350.0, 10.0), "deg", False),
        (np.arange(0.0, 371.0, 10.0), "deg", False),
        (np.arange(0.0, 360.0, 10.0), "mm", False),
        (np.array([0.0, 10.0, 350.0]), "deg", False),
    ],
)
def test_a_range_closes_that_goes_once_round(
    values: NDArray[np.float64], unit: str, does: bool
) -> None:
    assert closes(Axis("beta", values, unit, False)) is does
