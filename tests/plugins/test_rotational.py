"""Plain rotational forms: their presets, their symmetry, their refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from foldmill import Fold, InvalidParameters
from foldmill.check import assignment
from foldmill.check.intersection import penetrations
from foldmill_plugins.rotational import DESIGN, RotationalParams

PRESETS = pytest.mark.parametrize("name", DESIGN.presets)


def space(fold: Fold) -> np.ndarray:
    assert fold.folded is not None
    return fold.folded.vertices


@PRESETS
def test_a_preset_is_a_form_worth_folding(name: str) -> None:
    fold = DESIGN.run(DESIGN.preset(name))
    width, depth, height = np.ptp(space(fold), axis=0)
    assert height > 0.2 * max(width, depth)
    assert np.ptp(fold.pattern.vertices, axis=0).max() <= 300
    assert fold.pattern.edge_lengths.min() >= 15
    assert len(penetrations(space(fold), fold.pattern.edges, fold.pattern.faces)) == 0
    assert "U" not in fold.pattern.letters()


@PRESETS
def test_folding_stretches_nothing(name: str) -> None:
    fold = DESIGN.run(DESIGN.preset(name))
    ends = space(fold)[fold.pattern.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert np.abs(lengths - fold.pattern.edge_lengths).max() <= 1e-12 * fold.pattern.size


def test_what_comes_without_a_wish_passes_through_nothing() -> None:
    fold = DESIGN.run()
    assert len(penetrations(space(fold), fold.pattern.edges, fold.pattern.faces)) == 0


def test_turning_phi_towards_ninety_unfolds_the_sheet() -> None:
    values = DESIGN.preset("bowl-n8").model_dump()
    heights = [
        float(np.ptp(space(DESIGN.run(values | {"phi": phi}))[:, 2])) for phi in (80, 85, 90)
    ]
    assert heights[0] > heights[1] > heights[2] == 0


@PRESETS
@pytest.mark.parametrize(("shut", "ajar"), [(0, 0.02), (1e-5, 0.02), (180, 179.98)])
def test_a_crease_that_phi_closes_keeps_the_sign_it_had_before(
    name: str, shut: float, ajar: float
) -> None:
    values = DESIGN.preset(name).model_dump()
    closed, before = (DESIGN.run(values | {"phi": phi}) for phi in (shut, ajar))
    assert np.abs(closed.pattern.fold_angles).max() == 180
    assert closed.pattern.letters() == before.pattern.letters()
    assert "U" not in closed.pattern.letters()
    assert not assignment(closed).findings


def test_every_point_adds_a_ring_of_triangles() -> None:
    assert isinstance(DESIGN.preset("bowl-n8"), RotationalParams)
    faces = [
        len(
            DESIGN.run(
                {"n": 5, "points": {i: {"a": 20.0 * i} for i in range(1, last + 1)}}
            ).pattern.faces
        )
        for last in (2, 3, 4)
    ]
    assert faces == [10, 20, 30]


FOUR: dict[int, dict[str, Any]] = {1: {"a": 40}, 2: {"a": 62}, 3: {"a": 92}, 4: {"a": 118}}


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"n": 73}, "n must be at most 72"),
        ({"n": True}, "n must be a whole number"),
        ({"points": FOUR | {9: {"a": 5}}}, r"numbered 1, 2, 3 …, not \[1, 2, 3, 4, 9\]\.$"),
        ({"points": [40, 62]}, r"points must be a table of names and values, not \[40, 62\]"),
        ({"points": {}}, "points: a facet needs points 1 and 2 beside the centre"),
        ({"points": {1: {"a": 40}, 3: {"a": 60}}}, "points: the points must be numbered 1, 2, 3"),
        ({"points": FOUR | {2: {"r": 62, "z": 3}}}, r"points\.2\.a is missing"),
        ({"points": FOUR | {4: {"a": 1e200}}}, r"points\.4\.a must be less than 100000"),
        (
            {"points": FOUR | {1: {"a": 1e-9}}},
            r"Point 1 lies on the centre: 1e-09 mm are less than",
        ),
        (
            {"points": FOUR | {3: {"a": float(np.nextafter(40, 41))}}},
            r"Point 3 lies on point 1: 7.1e-15 mm are less than",
        ),
        (
            {"n": 72, "points": FOUR | {1: {"a": 1.1e-6}, 2: {"a": 1.2e-6}}},
            "Point 2 lies on point 1: 1.1e-07 mm are less than",
        ),
        (
            {"points": {i: {"a": 10.0 * i} for i in range(1, 202)}},
            "points: a half wedge takes 200 points at most, not 201; leave out some",
        ),
    ],
)
def test_wrong_parameters_are_refused_by_name(values: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InvalidParameters, match=sentence):
        DESIGN.run(values)


def test_a_direction_stated_of_the_innermost_point_waits_unused() -> None:
    values = DESIGN.preset("bowl-n8").model_dump()
    plain = DESIGN.run(values)
    values["points"][1]["gamma"] = 20.0
    turned = DESIGN.run(values)
    assert np.array_equal(space(turned), space(plain))
    assert [handle.name for handle in turned.handles] == [handle.name for handle in plain.handles]


def test_a_point_on_the_axis_but_for_rounding_is_on_no_side_of_it() -> None:
    points = {1: {"a": 42.18949729860357}, 2: {"a": 27.92598854454132}}
    points[3] = {"a": 64.52105600234265, "branch": -1}
    told = DESIGN.report("free-phi", DESIGN.validate({"n": 6, "phi": 180, "points": points}))
    assert told["free_at_phi"]
    assert told["free_deg"][-1][1] == 180
