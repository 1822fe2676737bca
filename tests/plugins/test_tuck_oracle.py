"""Random forms with points placed by hand, and their tucks, against spheres to forty digits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
import strip_oracle
from strip_oracle import Points, random_tucked

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric import strip
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill_plugins.tuck import blanks, corners
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.corners import Corners

DESIGNS, BLOCKS = 1020, 6


def designs(block: int) -> Iterator[tuple[int, int, float, Points]]:
    """Yield the random designs of a block: seed, N, φ and points."""
    for seed in range(block * DESIGNS // BLOCKS, (block + 1) * DESIGNS // BLOCKS):
        yield seed, *random_tucked(seed)


@dataclass(frozen=True)
class Tucked:
    """A closed blank and the corners of a random flap in it."""

    blank: Blank
    corners: Corners


def flaps(solved: strip.Strip, seed: int) -> list[Tucked]:
    """Return a random flap, clear of the ends of its range, for every closed blank with one."""
    rng, found = np.random.default_rng(seed), []
    try:
        closed = [blank for blank in blanks.find(solved) if not blank.is_open]
    except ImpossibleGeometry:  # the gap is too short
        return []
    for blank in closed:
        shape = (1, len(blank.points))
        shares, sides = rng.uniform(0.1, 0.9, shape), rng.choice([-1.0, 1.0], shape)
        placed = corners.place(blank, shares, sides, [None] * len(blank.points))
        if placed.exists[0]:
            found.append(Tucked(blank, placed))
    return found


@pytest.mark.parametrize("block", range(BLOCKS))
def test_spheres_planes_and_circles_find_the_same_points_and_corners(block: int) -> None:
    worst, tucked = 0.0, 0
    for seed, order, phi, points in designs(block):
        quick = strip.solve(order, phi, points)
        slow = strip_oracle.solve(order, phi, points)
        size = float(np.abs(quick.flat).max())
        gaps = [np.abs(quick.meridian - slow.meridian()), np.abs(quick.flat - slow.pattern())]
        for flap in flaps(quick, seed):
            t, sides = flap.corners.t[0].tolist(), flap.corners.sides[0].astype(int).tolist()
            spots = strip_oracle.corner(slow, flap.blank.chain, t, sides)
            gaps.append(np.abs(flap.corners.spots[0] - np.array(spots)))
            tucked += 1
        worst = max(worst, *(float(gap.max()) / size for gap in gaps))
    assert worst <= 1e-12
    assert tucked > 0.6 * DESIGNS / BLOCKS


def upside_down(points: Points) -> dict[int, LinePoint | FreePoint]:
    """Return the points of the form mirrored in z = 0."""
    mirrored: dict[int, LinePoint | FreePoint] = {}
    for i, point in points.items():
        if isinstance(point, FreePoint):
            mirrored[i] = FreePoint(r=point.r, z=-point.z)
        else:
            mirrored[i] = LinePoint(a=point.a, branch=1 if point.branch < 0 else -1)
    return mirrored


def test_a_form_upside_down_is_its_mirror_image_with_its_tucks() -> None:
    tucked = 0
    for seed, order, phi, points in designs(0):
        form = strip.solve(order, phi, points)
        image = strip.solve(order, 180 - phi, upside_down(points))
        size = float(np.abs(form.flat).max())
        assert np.abs(image.meridian - form.meridian * [1, -1]).max() <= 1e-11 * size
        assert np.abs(image.flat - form.flat).max() <= 1e-11 * size
        for flap in flaps(form, seed):
            if len(flap.blank.points) > 1:  # sides beyond the first corner depend on the winding
                continue
            spatial = flap.blank.spatial * [1, 1, -1]
            blank = replace(flap.blank, spatial=spatial, above=flap.blank.above * [1, 1, -1])
            given = flap.corners.t[0].tolist()
            other = corners.place(blank, np.ones((1, 1)), flap.corners.sides, given)
            assert np.abs(other.spots - flap.corners.spots * [1, 1, -1]).max() <= 1e-11 * size
            tucked += 1
    assert tucked > 50
