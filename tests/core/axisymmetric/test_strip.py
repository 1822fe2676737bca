"""The strip solver against plain spheres and planes, mirrors, flat sheets and impossible points."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, radians

import numpy as np
import pytest
import strip_oracle
from strip_oracle import random_lines

from foldmill import ImpossibleGeometry, InvalidParameters
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.axisymmetric.strip import Strip

Points = dict[int, LinePoint]
DESIGNS = 1000


def mirrored(points: Mapping[int, LinePoint]) -> Points:
    return {i: LinePoint(a=p.a, branch=1 if p.branch < 0 else -1) for i, p in points.items()}


@pytest.mark.parametrize("block", range(4))
def test_spheres_and_planes_find_the_same_points(block: int) -> None:
    worst = 0.0
    for seed in range(block * DESIGNS // 4, (block + 1) * DESIGNS // 4):
        order, phi, points = random_lines(seed)
        solved = strip.solve(order, phi, points).meridian
        slow = strip_oracle.solve(order, phi, points).meridian()
        error = np.abs(solved - slow).max() / np.abs(solved).max()
        worst = max(worst, float(error))
    assert worst <= 1e-12


@pytest.mark.parametrize("seed", range(40))
def test_the_other_side_of_ninety_degrees_is_the_mirror_image(seed: int) -> None:
    order, phi, points = random_lines(seed)
    plain = strip.solve(order, phi, points)
    mirror = strip.solve(order, 180 - phi, mirrored(points))
    size = np.abs(plain.meridian).max()
    assert np.abs(mirror.meridian - plain.meridian * [1, -1]).max() <= 1e-11 * size
    from_above = rosette.assemble(rosette.HalfWedge.of(plain)).fold_angles
    from_below = rosette.assemble(rosette.HalfWedge.of(mirror)).fold_angles
    assert np.abs(from_above + from_below).max() <= 1e-6


def test_at_ninety_degrees_every_branch_is_the_flat_sheet() -> None:
    for seed in range(DESIGNS):
        order, _, points = random_lines(seed)
        solved = strip.solve(order, 90, points)
        assert solved.meridian[:, 1].tolist() == [0] * len(solved.meridian)
        reach = [0.0, *(point.a for point in points.values())]
        assert np.abs(solved.meridian[:, 0] - reach).max() <= 1e-14 * max(reach)


def test_lengths_in_the_pattern_are_lengths_in_space() -> None:
    for seed in range(DESIGNS):
        solved = strip.solve(*random_lines(seed))
        for k in (1, 2):
            flat = np.linalg.norm(solved.flat[k:] - solved.flat[:-k], axis=1)
            space = np.linalg.norm(solved.spatial[k:] - solved.spatial[:-k], axis=1)
            assert np.abs(flat - space).max() <= 1e-14 * np.abs(solved.flat).max()


@pytest.mark.parametrize("seed", range(40))
def test_the_branch_is_the_mountain_or_valley_of_its_crease(seed: int) -> None:
    order, phi, points = random_lines(seed)
    solved = strip.solve(order, phi, points)
    rose = rosette.assemble(rosette.HalfWedge.of(solved))
    for (a, b), angle in zip(rose.edge_origins.tolist(), rose.fold_angles, strict=True):
        if b - a == 2 and 1e-3 < abs(angle) < 180 - 1e-3:
            assert np.sign(angle) == -points[b].branch * np.sign(solved.meridian[b - 1, 0])


@pytest.mark.parametrize("phi", [0, 180])
def test_a_closed_umbrella_is_legal(phi: float) -> None:
    solved = strip.solve(6, phi, {1: LinePoint(a=40), 2: LinePoint(a=60), 3: LinePoint(a=90)})
    assert solved.meridian[1].tolist() == [0, 40 if phi == 0 else -40]


def test_a_free_point_on_its_line_leaves_no_blank() -> None:
    points = {i: LinePoint(a=a) for i, a in enumerate((40, 62, 92, 118), start=1)}
    by_line = strip.solve(8, 66, points)
    r, z = by_line.meridian[4]
    by_hand = strip.solve(8, 66, {**points, 4: FreePoint(r=r, z=z)})
    assert by_hand.off_line == ()
    assert np.abs(by_hand.flat - by_line.flat).max() < 1e-9


def test_a_free_point_keeps_its_distances_in_the_pattern() -> None:
    solved = strip.solve(8, 90, stool())
    assert solved.off_line == (4,)
    for k in (2, 3):
        flat = np.linalg.norm(solved.flat[4] - solved.flat[k])
        assert flat == pytest.approx(
            np.linalg.norm(solved.spatial[4] - solved.spatial[k]), abs=1e-12
        )


def stool(**changes: LinePoint | FreePoint) -> dict[int, LinePoint | FreePoint]:
    """Return the points of a stool with eight feet; ``p4`` and so on replace one of them."""
    points: dict[int, LinePoint | FreePoint] = {
        1: LinePoint(a=110),
        2: LinePoint(a=110 / cos(radians(22.5))),
        3: LinePoint(a=172.48, gamma=-108.2),
        4: FreePoint(r=97.27, z=-79.29),
        5: LinePoint(a=265.2),
        6: LinePoint(a=238.7, branch=-1),
    }
    return points | {int(name[1:]): point for name, point in changes.items()}


@pytest.mark.parametrize("gamma", [-170.0, -90.0, 0.0, 45.0, 180.0])
def test_where_the_circles_are_one_gamma_is_the_direction(gamma: float) -> None:
    points = stool(p3=LinePoint(a=172.48, gamma=gamma))
    solved: Strip = strip.solve(8, 90, {i: points[i] for i in (1, 2, 3)})
    step = solved.meridian[3] - solved.meridian[1]
    assert np.hypot(*step) == pytest.approx(172.48 - 110, rel=1e-12)
    turn = np.degrees(np.arctan2(step[1], step[0])) - gamma
    assert (turn + 180) % 360 - 180 == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    ("points", "error", "sentence"),
    [
        (
            stool(p1=FreePoint(r=110, z=0)),
            InvalidParameters,
            "Point 1 lies on its line; it is moved by a and φ",
        ),
        (
            stool(p3=LinePoint(a=110, gamma=-108)),
            InvalidParameters,
            "Point 3 must lie farther out than point 1: a = 110 mm, but point 1 is at 110 mm",
        ),
        (
            stool(p6=LinePoint(a=150)),
            InvalidParameters,
            r"Point 6 must lie farther out than point 4: a = 150 mm, but point 4 is at 191\.598 mm",
        ),
        (
            stool(
                p4=FreePoint(r=65.2, z=-125.1),
                p5=LinePoint(a=250.3),
                p6=LinePoint(a=246.5, branch=-1),
            ),
            InvalidParameters,
            "Point 6 turns the triangle 4-5-6 over; give it a larger a",
        ),
        (
            stool(p3=LinePoint(a=172.48)),
            InvalidParameters,
            r"Point 3 can turn freely about point 1 .* give it a direction, points\.3\.gamma",
        ),
        (
            stool(p4=FreePoint(r=135.7, z=-111.2)),
            ImpossibleGeometry,
            r"Point 6 has no place: point 5 is 68\.644 mm .* 44\.1725 mm .* \(24\.5 mm too few\)",
        ),
        (
            stool(p4=FreePoint(r=202.6, z=-28.7)),
            ImpossibleGeometry,
            r"Point 4 crosses its symmetry line by 59\.13 mm in the pattern",
        ),
        (
            stool(p4=FreePoint(r=110 / cos(radians(22.5)), z=0)),
            InvalidParameters,
            "Point 4 lies on point 2; move one of them",
        ),
        (
            stool(p3=LinePoint(a=220, gamma=180), p4=FreePoint(r=50, z=0)),
            ImpossibleGeometry,
            "Point 4 is in one line with points 2 and 3: its triangle has no area",
        ),
    ],
)
def test_what_cannot_be_solved_is_refused_by_point_and_amount(
    points: dict[int, LinePoint | FreePoint], error: type[Exception], sentence: str
) -> None:
    with pytest.raises(error, match=sentence):
        strip.solve(8, 90, points)
