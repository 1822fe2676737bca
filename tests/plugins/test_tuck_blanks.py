"""Blanks of several points, open ones, flush ones, and several in one form."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from domes import DOME

from foldmill import Fold, ImpossibleGeometry, InvalidParameters
from foldmill.axisymmetric import rosette, strip
from foldmill.axisymmetric.rosette import HalfWedge
from foldmill.check import check
from foldmill.check.intersection import penetrations
from foldmill.exchange.fold import read, write
from foldmill_plugins.tuck import DESIGN

STOOL = DESIGN.preset("stool-n8").model_dump(mode="json")
BASKET = DESIGN.preset("basket-n10").model_dump(mode="json")
FLUSH = DESIGN.preset("flush-n6").model_dump(mode="json")
SHORT = STOOL | {"tucks": [], "points": {k: STOOL["points"][k] for k in "1234"}}
"""The stool cut off at p_4: its blank is open."""
LONG = SHORT | {
    "points": {k: STOOL["points"][k] for k in "12345"} | {"6": {"r": 100.0, "z": -110.0}}
}
"""An open blank with two points off the line."""
ALL = {"basket": BASKET, "automatic": BASKET | {"tucks": []}, "flush": FLUSH, "short": SHORT}
FORMS = pytest.mark.parametrize("name", [*ALL, "long", "dome"])


def form(name: str) -> Fold:
    return DESIGN.run((ALL | {"long": LONG, "dome": DOME})[name])


def space(fold: Fold) -> np.ndarray:
    assert fold.folded is not None
    return fold.folded.vertices


def basket(*tucks: dict[str, Any]) -> dict[str, Any]:
    return BASKET | {"tucks": list(tucks)}


@FORMS
def test_a_filled_sheet_folds_without_stretch_gap_or_penetration(name: str) -> None:
    fold = form(name)
    assert not [str(finding) for finding in check(fold).findings]
    assert "U" not in fold.pattern.letters()
    pattern = fold.pattern
    assert len(pattern.vertices) - len(pattern.edges) + len(pattern.faces) == 1


@FORMS
def test_both_halves_of_every_flap_lie_upon_each_other_in_the_stated_order(name: str) -> None:
    fold = form(name)
    orders = fold.meta["fold"]["folded"]["faceOrders"]
    corners = space(fold)[fold.pattern.faces]
    assert len({face for order in orders for face in order[:2]}) == 2 * len(orders)
    for f, g, s in orders:
        gaps = np.linalg.norm(corners[f][:, None] - corners[g][None], axis=2)
        assert gaps.min(axis=1).max() < 1e-9 * fold.pattern.size
        shared = sorted(set(fold.pattern.faces[f].tolist()) & set(fold.pattern.faces[g].tolist()))
        spine = [
            int(angle)
            for edge, angle in zip(
                np.sort(fold.pattern.edges, axis=1).tolist(), fold.pattern.fold_angles, strict=True
            )
            if edge == shared
        ]
        # Fronts together in a valley: each lies where the other's normal points.
        assert spine in ([], [180 * s])


def test_layer_orders_survive_a_file() -> None:
    fold = form("basket")
    orders = fold.meta["fold"]["folded"]["faceOrders"]
    written = write(fold)
    assert json.loads(written)["file_frames"][0]["faceOrders"] == orders
    assert read(written).meta["fold"]["folded"]["faceOrders"] == orders


@pytest.mark.parametrize(
    ("name", "seams"), [("basket", 30), ("automatic", 30), ("long", 16), ("dome", 28)]
)
def test_creases_at_a_seam_turn_together_by_what_the_surface_turns(name: str, seams: int) -> None:
    fold = form(name)
    pattern, points = fold.pattern, space(fold)
    flap = {f for order in fold.meta["fold"]["folded"]["faceOrders"] for f in order[:2]}
    order = {f: s for f, g, s in fold.meta["fold"]["folded"]["faceOrders"]}
    twin = {f: g for f, g, _ in fold.meta["fold"]["folded"]["faceOrders"]}
    checked = 0
    for f, g in twin.items():
        for here, there in _seams(fold, f, g, flap):
            (edge_f, out_f), (edge_g, out_g) = here, there
            normals = [
                np.cross(*(points[pattern.faces[k]][1:] - points[pattern.faces[k]][0]))
                for k in (out_f, out_g)
            ]
            one, two = (n / np.linalg.norm(n) for n in normals)
            turn = np.degrees(np.arctan2(np.linalg.norm(np.cross(one, two)), one @ two))
            total = pattern.fold_angles[edge_f] + pattern.fold_angles[edge_g] + 180 * order[f]
            assert abs(total) == pytest.approx(turn, abs=1e-6)
            checked += 1
    assert checked == seams


def _seams(fold: Fold, f: int, g: int, flap: set[int]) -> Any:
    """Yield the creases by which both halves of a flap leave the surface, with the face beyond."""
    pattern, points = fold.pattern, space(fold)

    def borders(face: int) -> dict[tuple[float, ...], tuple[int, int]]:
        out = {}
        for edge in np.flatnonzero((pattern.edge_faces == face).any(axis=1)):
            left, right = pattern.edge_faces[edge].tolist()
            beyond = right if left == face else left
            if beyond >= 0 and beyond not in flap:
                middle = points[pattern.edges[edge]].mean(axis=0)
                out[tuple(np.round(middle, 6) + 0.0)] = (int(edge), beyond)
        return out

    mine, other = borders(f), borders(g)
    assert len(mine) == len(other)
    for spot, here in mine.items():
        yield (
            here,
            min(
                other.items(),
                key=lambda item: (
                    np.hypot(*(np.subtract(item[0], spot))[:2]) + abs(item[0][2] - spot[2])
                ),
            )[1],
        )


def test_a_corner_is_as_far_from_the_corner_before_as_in_the_pattern() -> None:
    fold = form("basket")
    size = fold.pattern.size
    ends = space(fold)[fold.pattern.edges]
    change = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - fold.pattern.edge_lengths
    t = np.hypot(*fold.pattern.vertices.T)
    one, two = (np.flatnonzero(np.abs(t - spot) < 1e-9) for spot in (240, 280))
    between = np.isin(fold.pattern.edges, one).any(axis=1)
    between &= np.isin(fold.pattern.edges, two).any(axis=1)
    assert between.sum() == 10
    assert np.abs(change).max() < 1e-12 * size


def test_flush_flaps_lie_exactly_in_the_surface() -> None:
    fold = form("flush")
    assert [tuck["lies"] for tuck in fold.meta["tucks"]] == ["flush", "flush"]
    orders = fold.meta["fold"]["folded"]["faceOrders"]
    flap = {f for order in orders for f in order[:2]}
    others = np.array([k for k in range(len(fold.pattern.faces)) if k not in flap])
    corners = space(fold)[fold.pattern.faces]
    edges = corners[others][:, 1:] - corners[others][:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    for f in flap:
        step = corners[f][:, None] - corners[others][None, :, 0]
        height = np.abs(np.einsum("ijk,jk->ij", step, normals)).max(axis=0)
        upon = others[height < 1e-10 * fold.pattern.size]
        centre = corners[f].mean(axis=0)
        assert any(_holds(corners[k], centre) for k in upon)


def _holds(triangle: np.ndarray, spot: np.ndarray) -> bool:
    """Tell whether a point in a triangle's plane lies inside it."""
    basis = np.column_stack([triangle[1] - triangle[0], triangle[2] - triangle[0]])
    shares = np.linalg.lstsq(basis, spot - triangle[0], rcond=None)[0]
    return bool((shares >= -1e-9).all() and shares.sum() <= 1 + 1e-9)


def test_the_angle_at_a_flush_corner_is_a_right_one() -> None:
    params = DESIGN.preset("flush-n6")
    solved = strip.solve(params.n, params.phi, dict(params.points))
    for tuck in params.tucks:
        i = tuck.point
        corner = np.array([tuck.t, 0.0])
        one, two = solved.flat[i - 2] - solved.flat[i], corner - solved.flat[i]
        assert one @ two == pytest.approx(0, abs=1e-9)
        assert np.linalg.norm(two) <= np.linalg.norm(solved.flat[i - 1] - solved.flat[i])


def test_the_rim_of_an_open_blank_lies_in_the_symmetry_plane_and_inside() -> None:
    fold = form("short")
    (tuck,) = fold.meta["tucks"]
    assert tuck["lies"] == "inside"
    tips = np.flatnonzero(np.abs(np.hypot(*fold.pattern.vertices.T) - tuck["t"]) < 1e-5)
    assert len(tips) == 8
    azimuth = np.degrees(np.arctan2(space(fold)[tips, 1], space(fold)[tips, 0]))
    assert np.abs(azimuth / 22.5) % 2 == pytest.approx(1, abs=1e-9)  # the planes of even points


def test_an_open_blank_may_be_folded_outside_too() -> None:
    for side in ("inside", "outside"):
        fold = DESIGN.run(SHORT | {"tucks": [{"point": 4, "lies": side}]})
        assert fold.meta["tucks"][0]["lies"] == side
        assert not check(fold).findings


def test_the_rim_of_a_longer_open_blank_continues_the_facet_before_it() -> None:
    fold = form("long")
    first, rim = (tuck["t"] for tuck in fold.meta["tucks"])
    t = np.hypot(*fold.pattern.vertices.T)
    ends = [
        {
            "first" if abs(t[v] - first) < 1e-5 else "rim" if abs(t[v] - rim) < 1e-5 else ""
            for v in e
        }
        for e in fold.pattern.edges
    ]
    crease = fold.pattern.edge_faces.min(axis=1) >= 0
    flat = np.abs(fold.pattern.fold_angles) < 1e-9
    # From the first corner to p_6 and its mirror image the flap does not fold.
    count = sum(
        1 for k, names in enumerate(ends) if names == {"first", ""} and crease[k] and flat[k]
    )
    assert count == 2 * 8


def test_two_blanks_are_both_free_of_each_other_wherever_the_first_is_stated() -> None:
    chosen = DESIGN.run(DOME).meta["tucks"]
    assert [tuck["point"] for tuck in chosen] == [4, 5]
    again = DESIGN.run(DOME | {"tucks": [{"point": 5, "t": chosen[1]["t"]}]})
    assert [tuck["point"] for tuck in again.meta["tucks"]] == [4, 5]
    faces = again.pattern.faces
    assert not len(penetrations(space(again), again.pattern.edges, faces))


def test_one_corner_may_be_stated_and_the_other_found() -> None:
    fold = DESIGN.run(basket({"point": 5, "t": 238.0}))
    assert fold.meta["tucks"][0]["t"] == 238.0
    assert not check(fold).findings


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (
            basket({"point": 5, "t": 400}, {"point": 7, "t": 280}),
            r"corner beside point 5 has t = 400 mm, off its segment: .* 121\.3 and 346\.7 mm",
        ),
        (
            basket({"point": 5, "t": 130}, {"point": 7, "t": 280}),
            r"tuck beside point 5 has no place in space at t = 130 mm: give it a value between",
        ),
        (
            basket({"point": 5, "lies": "outside"}),
            "beside points 5 and 7 cannot lie outside: the shape allows it inside",
        ),
        (
            STOOL | {"tucks": [{"point": 4, "lies": "outside"}]},
            r"point 4 cannot lie outside: the shape allows it inside \(between 131\.5\d* and",
        ),
        (
            STOOL | {"tucks": [{"point": 4, "t": 189.2, "lies": "outside"}]},
            "point 4 cannot lie outside: the shape allows it inside",
        ),
        (SHORT | {"tucks": [{"point": 4, "t": 50}]}, "off its line: give it more than 119"),
        (
            LONG | {"points": LONG["points"] | {"6": {"r": 50.0, "z": -100.0}}},
            "points 4 and 6 penetrates the form wherever its corners lie",
        ),
    ],
)
def test_corners_that_fold_to_nothing_are_refused(values: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ImpossibleGeometry, match=sentence):
        DESIGN.run(values)


def test_one_flap_cannot_be_asked_to_lie_on_both_sides() -> None:
    tucks = ({"point": 5, "lies": "inside"}, {"point": 7, "lies": "outside"})
    with pytest.raises(InvalidParameters, match="cannot lie inside and outside"):
        DESIGN.run(basket(*tucks))


def test_a_surface_without_its_flaps_is_what_the_points_say() -> None:
    params = DESIGN.preset("basket-n10")
    solved = strip.solve(params.n, params.phi, dict(params.points))
    bare = rosette.assemble(HalfWedge.of(solved)).spatial
    filled = space(form("basket"))
    gaps = np.linalg.norm(bare[:, None] - filled[None], axis=2)
    assert gaps.min(axis=1).max() < 1e-9


@FORMS
def test_a_flap_found_is_the_same_when_all_of_it_is_stated(name: str) -> None:
    fold = form(name)
    values = (ALL | {"long": LONG, "dome": DOME})[name]
    sides = [side for flap in fold.meta["flaps"] for side in flap["sides"]]
    tucks = [
        {"point": tuck["point"], "t": tuck["t"], "side": side}
        | ({} if tuck["lies"] == "flush" else {"lies": tuck["lies"]})
        for tuck, side in zip(fold.meta["tucks"], sides, strict=True)
    ]
    again = DESIGN.run(values | {"tucks": tucks})
    assert np.abs(space(again) - space(fold)).max() < 1e-3  # t is told to 1e-6 mm
    assert again.pattern.letters() == fold.pattern.letters()
