"""A half wedge, mirrored and turned N times, is one sheet with N-fold symmetry."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import Assignment, Fold
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.points import LinePoint
from foldmill.axisymmetric.rosette import HalfWedge, Rosette


def bowl(order: int = 8, phi: float = 75) -> Rosette:
    reach = {1: 40.0, 2: 56.0, 3: 76.0, 4: 100.0, 5: 117.0, 6: 121.0}
    points = {i: LinePoint(a=a, branch=-1 if i in {4, 6} else 1) for i, a in reach.items()}
    return rosette.assemble(HalfWedge.of(strip.solve(order, phi, points)))


def folded(order: int = 8, phi: float = 75) -> Fold:
    return rosette.fold(bowl(order, phi), wedge_decides=True)


def turned(points: np.ndarray, order: int) -> np.ndarray:
    angle = 2 * np.pi / order
    out = points.copy()
    out[:, 0] = np.cos(angle) * points[:, 0] - np.sin(angle) * points[:, 1]
    out[:, 1] = np.sin(angle) * points[:, 0] + np.cos(angle) * points[:, 1]
    return out


def farthest_from(points: np.ndarray, others: np.ndarray) -> float:
    gaps = np.linalg.norm(points[:, None] - others[None], axis=2)
    return float(gaps.min(axis=1).max())


@pytest.mark.parametrize("order", [3, 4, 6, 8, 13])
def test_the_sheet_is_welded_without_gaps(order: int) -> None:
    rose, last = bowl(order), 6
    corners = 1 + last * order
    assert len(rose.flat) == corners
    assert len(rose.faces) == 2 * order * (last - 1)
    assert corners - len(rose.edges) + len(rose.faces) == 1  # a disc
    assert (rose.edge_faces < 0).any(axis=1).sum() == 2 * order


@pytest.mark.parametrize("order", [3, 6, 8])
def test_the_form_maps_to_itself_when_turned_by_one_wedge_or_mirrored(order: int) -> None:
    fold = folded(order)
    assert fold.folded is not None
    for points in (fold.pattern.vertices, fold.folded.vertices):
        flip = np.ones(points.shape[1])
        flip[1] = -1
        assert farthest_from(turned(points, order), points) < 1e-11
        assert farthest_from(points * flip, points) < 1e-11


def test_creases_fold_alike_in_every_wedge() -> None:
    pattern = folded(8).pattern
    middles = pattern.vertices[pattern.edges].mean(axis=1)
    gaps = np.linalg.norm(turned(middles, 8)[:, None] - middles[None], axis=2)
    partner = gaps.argmin(axis=1)
    assert sorted(partner) == list(range(len(middles)))
    assert pattern.assignments[partner].tolist() == pattern.assignments.tolist()
    assert np.abs(pattern.fold_angles[partner] - pattern.fold_angles).max() < 1e-9


def outward(fold: Fold) -> float:
    """Return how far the facets' front normals point away from the inside of a dished form."""
    assert fold.folded is not None
    points, faces = fold.folded.vertices, fold.pattern.faces
    corner = points[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    rim = points[np.unique(fold.pattern.edges[fold.pattern.assignments == Assignment.B])]
    return float(np.einsum("ij,ij->i", normal, corner.mean(axis=1) - rim.mean(axis=0)).sum())


@pytest.mark.parametrize("phi", [75, 105])
def test_the_front_is_the_outside_of_a_dish_whichever_way_it_opens(phi: float) -> None:
    assert outward(folded(8, phi)) > 0


def test_a_dish_and_its_mirror_image_are_folded_alike() -> None:
    up = folded(8, 75).pattern
    points = {
        i: LinePoint(a=a, branch=1 if i in {4, 6} else -1)
        for i, a in enumerate((40, 56, 76, 100, 117, 121), start=1)
    }
    down = rosette.fold(
        rosette.assemble(HalfWedge.of(strip.solve(8, 105, points))), wedge_decides=True
    ).pattern
    assert down.letters() == up.letters()
    assert np.abs(down.fold_angles - up.fold_angles).max() < 1e-9


def test_a_flat_sheet_is_not_turned_over() -> None:
    rose = bowl(8, 90)
    assert not rosette.is_inside_out(rose)
    assert rosette.fold(rose, wedge_decides=True).pattern.letters().strip("BF") == ""


def test_the_half_wedge_is_named_for_the_intersection_check() -> None:
    fold = folded(8)
    assert fold.symmetry is not None
    assert fold.symmetry.order == 8
    assert fold.symmetry.one_sided
    azimuth = np.degrees(
        np.arctan2(
            *fold.pattern.vertices[fold.pattern.faces[fold.symmetry.wedge]].mean(axis=1).T[::-1]
        )
    )
    assert len(azimuth) == 5
    assert np.ptp(azimuth) < 22.5
