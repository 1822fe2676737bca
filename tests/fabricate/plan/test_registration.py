"""Which marks planning puts into the waste, and what it says where they do not fit."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from fabricate.plan.test_make import square
from stools import machine, material, stool

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.formats import drawing
from foldmill_fabricate.machines import Machine, Marks
from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.plan import make
from foldmill_fabricate.sheet import flipped, seen_by_machine

FLIPS = ["left-right", "end-over-end"]


@cache
def plan(slug: str, kind: str, flip: str = "left-right") -> Plan:
    return make(stool(), material(), machine(slug), flip=flip, register=kind)  # type: ignore[arg-type]


@pytest.mark.parametrize("flip", FLIPS)
def test_optical_marks_face_inward_on_the_reverse_as_the_sensor_looks_for_them(flip: str) -> None:
    made = plan("graphtec-summa-like", "l-marks", flip)
    [master] = [view for view in drawing.drawings(made) if view.name == "front"]
    [group] = [group for group in master.groups if group.layer.name == "REG"]
    rims = [flipped(line, made.flip) for line in group.lines]
    assert len(rims) == 4
    corners = np.array([rim[0] for rim in rims])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    for rim in rims:
        assert np.ptp(rim, axis=0).tolist() == pytest.approx([20, 20])
        (x, y), (u, v) = rim.min(axis=0), rim.max(axis=0)
        outer = max(((x, y), (x, v), (u, y), (u, v)), key=lambda spot: np.hypot(*(spot - middle)))
        assert rim[0] == pytest.approx(outer)  # where its two arms meet


@pytest.mark.parametrize("flip", FLIPS)
def test_pins_take_the_sheet_of_either_face_up_and_not_turned_the_wrong_way(flip: str) -> None:
    made = plan("flatbed-wheel-knife", "pins", flip)
    holes = np.array([(hole.x, hole.y) for hole in made.holes])
    assert np.hypot(*(holes[1] - holes[0])) == pytest.approx(400)
    assert np.sort(flipped(holes, made.flip), axis=0) == pytest.approx(np.sort(holes, axis=0))
    wrong = np.array([made.sheet.width, made.sheet.height]) - holes
    assert np.hypot(*(wrong[:, None] - holes[None]).transpose(2, 0, 1)).min() >= 20
    corner = np.array([made.sheet.dx, made.sheet.dy])
    pins = np.array(made.registration.pins)
    assert np.sort(pins - corner, axis=0) == pytest.approx(np.sort(holes, axis=0))


@pytest.mark.parametrize("error", [-1.0, 0.7])
@pytest.mark.parametrize("flip", FLIPS)
def test_with_edge_stops_a_blank_of_the_wrong_size_does_no_harm(flip: str, error: float) -> None:
    """The blank is pushed against its stops as large as it is; still the reverse fits the front."""
    made = plan("generic-hpgl-600", "edge", flip)
    real = np.array([made.sheet.width, made.sheet.height]) + error
    spot = np.array([123.0, 234.0])  # from the lower left corner, the front up
    k = 0 if flip == "left-right" else 1
    turned = np.where([k == 0, k == 1], real - spot, spot)
    for face, lies in ((Face.FRONT, spot), (Face.REVERSE, turned)):
        corner = np.zeros(2)
        for stop in made.registration.stops:
            if stop.face is face:
                axis = 0 if stop.edge in {"left", "right"} else 1
                far = real[axis] if stop.edge in {"right", "top"} else 0.0
                corner[axis] = (stop.x, stop.y)[axis] - far
        assert corner + lies == pytest.approx(seen_by_machine(made, face, [spot])[0])


def test_every_kind_but_none_leaves_a_witness_mark() -> None:
    kinds = {
        "holes": "generic-hpgl-600",
        "edge": "generic-hpgl-600",
        "none": "generic-hpgl-600",
        "l-marks": "graphtec-summa-like",
        "pins": "flatbed-wheel-knife",
    }
    for kind, slug in kinds.items():
        made = plan(slug, kind)
        roles = {op.role for side in made.passes for s in side.setups for op in s.operations}
        assert (Role.WITNESS in roles) == (kind != "none")
        assert made.registration.kind == kind


@pytest.mark.parametrize(
    ("slug", "kind", "known"),
    [
        ("generic-hpgl-600", "pins", "holes, edge, none"),
        ("generic-hpgl-600", "l-marks", "holes, edge, none"),
        ("flatbed-wheel-knife", "l-marks", "holes, edge, pins, none"),
    ],
)
def test_what_a_machine_cannot_do_is_refused_with_what_it_can(
    slug: str, kind: str, known: str
) -> None:
    with pytest.raises(CannotPlan, match=known):
        plan(slug, kind)


@pytest.mark.parametrize(
    ("slug", "kind", "code"),
    [
        ("generic-hpgl-600", "holes", "no-registration-holes"),
        ("graphtec-summa-like", "l-marks", "no-registration-marks"),
        ("flatbed-wheel-knife", "pins", "no-registration-pins"),
    ],
)
def test_what_does_not_fit_is_told_with_the_shortfall_and_edges_take_its_place(
    slug: str, kind: str, code: str
) -> None:
    made = make(square("MVMV", 190), material(), machine(slug), blank=(210, 210), register=kind)  # type: ignore[arg-type]
    finding = next(each for each in made.findings if each.code == code)
    assert "mm short" in finding.message
    assert "edge stop" in finding.remedy
    assert made.registration.kind == "edge"
    assert len(made.registration.stops) == 6
    assert not made.holes


def test_a_machine_that_names_l_marks_must_say_how_large_they_are() -> None:
    with pytest.raises(ValueError, match="arm and line_width"):
        Marks.model_validate({"kinds": ["holes", "l-marks-4"]})
    with pytest.raises(ValueError, match="square is missing"):
        Marks.model_validate({"kinds": ["l-marks-3"], "arm": 20, "line_width": 0.5})
    with pytest.raises(ValueError, match="pin_spacing"):
        Marks.model_validate({"kinds": ["pins"]})


def test_every_shipped_machine_registers_somehow() -> None:
    from foldmill_fabricate import handbook
    from foldmill_fabricate.plan.registration import offered

    for each in handbook.shipped_machines():
        assert isinstance(each, Machine)
        assert {"holes", "edge", "none"} <= set(offered(each))
