"""The stools: their published numbers, measured here anew from vertices and faces."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from foldmill import Fold
from foldmill.check.intersection import penetrations
from foldmill_plugins.tuck import DESIGN

FEET = {"stool-n4": 4, "stool-n6": 6, "stool-n8": 8}
ALL = pytest.mark.parametrize("name", FEET)


@cache
def stool(name: str) -> Fold:
    return DESIGN.run(DESIGN.preset(name))


def space(fold: Fold) -> np.ndarray:
    assert fold.folded is not None
    return fold.folded.vertices


def corner_angles(fold: Fold) -> np.ndarray:
    """Return the angle (F, 3) of every face at each of its corners, rad, by the law of cosines."""
    corners = fold.pattern.vertices[fold.pattern.faces]
    a, b, c = (
        np.linalg.norm(corners[:, (k + 2) % 3] - corners[:, (k + 1) % 3], axis=1) for k in range(3)
    )
    cosines = [(y**2 + z**2 - x**2) / (2 * y * z) for x, y, z in ((a, b, c), (b, c, a), (c, a, b))]
    angles: np.ndarray = np.arccos(np.column_stack(cosines))
    return angles


def turned_side(fold: Fold) -> float:
    """Return the smallest larger side of the pattern's bounding box over all rotations."""
    angles = np.radians(np.arange(0, 90, 0.25))
    points = fold.pattern.vertices
    return min(
        float(
            np.ptp(
                points @ np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]]), axis=0
            ).max()
        )
        for t in angles
    )


@ALL
def test_it_is_fifteen_centimetres_high_and_about_twenty_two_wide(name: str) -> None:
    width, depth, height = np.ptp(space(stool(name)), axis=0)
    assert height == pytest.approx(150, abs=0.1)
    assert 200 <= width <= 235
    assert 200 <= depth <= 235


@ALL
def test_it_stands_on_its_feet_and_its_seat_is_flat_on_top(name: str) -> None:
    fold, feet = stool(name), FEET[name]
    z = np.sort(space(fold)[:, 2])
    assert np.ptp(z[:feet]) < 1e-6
    assert z[feet] > z[0] + 10
    seat = np.abs(space(fold)[:, 2]) < 1e-9
    assert seat.sum() == 2 * feet + 1
    assert z.max() < 1e-9
    footprint = np.hypot(*space(fold)[np.argsort(space(fold)[:, 2])[:feet], :2].T)
    assert np.ptp(footprint) < 1e-9
    assert footprint.min() > 100


@ALL
def test_its_sheet_fits_on_half_a_metre_square_when_turned(name: str) -> None:
    assert turned_side(stool(name)) <= 491


@ALL
def test_the_sheet_is_flat_at_every_inner_vertex(name: str) -> None:
    fold = stool(name)
    sums = np.zeros(len(fold.pattern.vertices))
    np.add.at(sums, fold.pattern.faces, corner_angles(fold))
    assert np.abs(sums[fold.pattern.interior_vertices] - 2 * np.pi).max() <= 1e-11


@ALL
def test_folding_stretches_nothing(name: str) -> None:
    fold = stool(name)
    ends = space(fold)[fold.pattern.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert np.abs(lengths - fold.pattern.edge_lengths).max() <= 1e-12 * fold.pattern.size


@ALL
def test_no_facet_passes_through_another_and_tucks_lie_inside(name: str) -> None:
    fold = stool(name)
    assert len(penetrations(space(fold), fold.pattern.edges, fold.pattern.faces)) == 0
    assert [tuck["lies"] for tuck in fold.meta["tucks"]] == ["inside"]


@ALL
def test_its_facets_can_be_folded_by_hand(name: str) -> None:
    fold = stool(name)
    assert fold.pattern.edge_lengths.min() >= 33
    inner = np.isin(fold.pattern.faces, fold.pattern.interior_vertices)
    assert np.degrees(corner_angles(fold)[inner].min()) >= 22


@ALL
def test_the_tuck_may_lie_anywhere_in_a_wide_range(name: str) -> None:
    stated = DESIGN.preset(name).model_dump(mode="json")
    t = stated["tucks"][0]["t"]
    for other in (t - 30, t, t + 30):
        fold = DESIGN.run(stated | {"tucks": [{"point": 4, "t": other}]})
        assert fold.meta["tucks"] == [{"point": 4, "t": other, "lies": "inside"}]


def test_the_published_stool_is_220_by_220_by_150() -> None:
    fold = stool("stool-n8")
    assert np.abs(np.ptp(space(fold), axis=0) - [220, 220, 150]).max() <= 0.1
    assert (len(fold.pattern.vertices), len(fold.pattern.faces)) == (65, 112)
    letters = fold.pattern.letters()
    assert [letters.count(letter) for letter in "MVFBUC"] == [80, 56, 24, 16, 0, 0]
    assert turned_side(fold) <= 490.1
    assert np.ptp(fold.pattern.vertices, axis=0).max() == pytest.approx(530.4, abs=0.05)


def test_the_published_stool_has_the_published_creases() -> None:
    pattern = stool("stool-n8").pattern
    border = np.array([letter == "B" for letter in pattern.letters()])
    assert pattern.edge_lengths[~border].sum() == pytest.approx(10_900, abs=50)
    assert pattern.edge_lengths[border].sum() == pytest.approx(1_630, abs=5)
    assert pattern.edge_lengths.min() == pytest.approx(38.8, abs=0.05)


# Crease by its two points (t is the tuck's corner): angle and how many of them.
PUBLISHED = {
    "p0p1": {0.0: 8},
    "p0p2": {0.0: 8},
    "p1p3": {0.0: 8},
    "p1p2": {-108.2: 16},
    "p2p3": {7.765: 16},
    "p2p4": {-134.747: 8, -101.395: 8},
    "p2t": {180.0: 8},
    "p3p4": {29.099: 16},
    "p3p5": {-14.718: 8},
    "p4p5": {-106.516: 16},
    "p4p6": {-48.283: 8, -13.182: 8},
    "p4t": {19.436: 8, -19.436: 8},
    "p6t": {180.0: 8},
}


def named_points(fold: Fold) -> list[str]:
    """Name every vertex of the pattern by its distance from the centre."""
    distance = np.hypot(*fold.pattern.vertices.T)
    known = {0.0: "p0", 110.0: "p1", 172.48: "p3", 265.2: "p5", 238.7: "p6", 189.2: "t"}
    known[110 / np.cos(np.pi / 8)] = "p2"
    names = []
    for d in distance:
        near = [name for value, name in known.items() if abs(value - d) < 1e-6]
        names.append(near[0] if near else "p4")
    return names


def test_the_published_stool_has_the_published_fold_angles() -> None:
    fold = stool("stool-n8")
    names = named_points(fold)
    found: dict[str, list[float]] = {}
    for (a, b), angle, letter in zip(
        fold.pattern.edges, fold.pattern.fold_angles, fold.pattern.letters(), strict=True
    ):
        if letter != "B":
            found.setdefault("".join(sorted((names[a], names[b]))), []).append(float(angle))
    assert sorted(found) == sorted(PUBLISHED)
    for crease, expected in PUBLISHED.items():
        wanted = sorted(angle for angle, count in expected.items() for _ in range(count))
        assert np.abs(np.array(sorted(found[crease])) - wanted).max() <= 0.001, crease
