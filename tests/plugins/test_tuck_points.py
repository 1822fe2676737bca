"""What is said of each point, and how each can be dragged."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import Fold, InvalidParameters
from foldmill.axisymmetric.points import FreePoint, LinePoint
from foldmill.handle import Handle, Plane, Space
from foldmill.tolerances import HANDLE_GAP_MM
from foldmill_plugins.tuck import DESIGN
from foldmill_plugins.tuck.classify import Kind, State, states
from foldmill_plugins.tuck.params import TuckParams

STOOL = DESIGN.preset("stool-n8")
PRESETS = pytest.mark.parametrize("name", DESIGN.presets)


def moved(r: float, z: float) -> TuckParams:
    return STOOL.model_copy(update={"points": {**STOOL.points, 4: FreePoint(r=r, z=z)}})


def classified(params: TuckParams) -> tuple[dict[int, State], str]:
    found, reason = states(params.n, params.phi, dict(params.points))
    return {state.point: state for state in found}, reason


def test_a_free_point_inside_its_line_is_beside_a_blank() -> None:
    found, reason = classified(STOOL)
    assert reason == ""
    assert {i: state.kind for i, state in found.items() if state.kind is not Kind.ON_LINE} == {
        4: Kind.BLANK
    }
    assert found[4].beside_mm > 1
    assert [i for i, state in found.items() if state.is_rim] == [5, 6]


def test_the_sum_at_p2_falls_short_by_the_angle_of_the_blank() -> None:
    found, _ = classified(STOOL)
    pattern = DESIGN.run(STOOL).pattern
    names = np.hypot(*pattern.vertices.T)
    (p2, p4), turn = (np.flatnonzero(np.abs(names - d) < 0.01)[0] for d in (119.063, 0)), 0.0
    assert p4 == np.argmin(names)
    azimuth = np.arctan2(*pattern.vertices[p2][::-1])
    along = np.array([np.cos(azimuth), np.sin(azimuth)])
    sides = [v for edge in pattern.edges for v in edge if p2 in edge and v != p2]
    for v in sides:
        step = pattern.vertices[v] - pattern.vertices[p2]
        is_copy = abs(np.hypot(*step) - np.hypot(*(found_distance()))) < 1e-6
        turn += np.degrees(np.arccos(step @ along / np.hypot(*step))) if is_copy else 0.0
    assert turn > 1
    assert found[2].pattern_deg == pytest.approx(360 - turn, abs=1e-6)
    assert found[2].folded_deg == pytest.approx(found[2].pattern_deg, abs=1e-9)


def found_distance() -> tuple[float, float]:
    """Return the step P_2 P_4 of the stool in its plane."""
    return 97.27 - 110 / np.cos(np.pi / 8), -79.29


def test_the_copies_of_p4_fall_short_while_the_point_in_space_has_too_much() -> None:
    found, _ = classified(STOOL)
    assert found[4].pattern_deg < 360 < found[4].folded_deg
    assert found[4].folded_deg == pytest.approx(2 * found[4].pattern_deg)


def test_a_point_beyond_its_line_is_invalid_and_exceeds_360_degrees_before_it() -> None:
    found, _ = classified(moved(202.6, -28.7))
    assert found[4].kind is Kind.INVALID
    assert found[4].beside_mm == pytest.approx(-59.13, abs=0.01)
    assert found[2].pattern_deg > 360


def test_a_plain_rotational_form_has_360_degrees_everywhere_inside() -> None:
    points: dict[int, LinePoint | FreePoint] = {
        i: LinePoint(a=a) for i, a in enumerate((40, 62, 92, 118), start=1)
    }
    found, _ = classified(TuckParams(n=8, phi=80, points=points))
    inner = [state for state in found.values() if not state.is_rim]
    assert [state.pattern_deg for state in inner] == pytest.approx([360, 360])
    assert all(state.kind is Kind.ON_LINE for state in inner)


def test_points_that_cannot_be_solved_are_left_out_and_the_reason_given() -> None:
    found, reason = classified(moved(135.7, -111.2))
    assert sorted(found) == [1, 2, 3, 4, 5]
    assert "Point 6 has no place" in reason


def test_what_is_said_of_points_is_told_with_the_fold() -> None:
    told = DESIGN.run(STOOL).meta["points"]
    assert [entry["point"] for entry in told] == [1, 2, 3, 4, 5, 6]
    assert [entry["kind"] for entry in told].count("blank") == 1


def named(fold: Fold) -> dict[str, Handle]:
    return {handle.name: handle for handle in fold.handles}


@PRESETS
def test_every_handle_lies_on_a_vertex(name: str) -> None:
    fold = DESIGN.run(DESIGN.preset(name))
    assert fold.folded is not None
    for handle in fold.handles:
        flat = handle.space is Space.PATTERN
        vertices = fold.pattern.vertices if flat else fold.folded.vertices
        gap = np.linalg.norm(vertices - handle.position, axis=1).min()
        assert gap < 1e-9, handle.name
        assert handle.locus.nearest(handle.position) == pytest.approx(handle.position, abs=1e-9)


@PRESETS
def test_dragging_a_handle_nowhere_changes_nothing(name: str) -> None:
    params = DESIGN.preset(name)
    fold = DESIGN.run(params)
    for handle in fold.handles:
        again = DESIGN.run(handle.drag(params, handle.position))
        gap = np.abs(again.pattern.vertices - fold.pattern.vertices).max()
        assert gap < 1e-6 * fold.pattern.size, handle.name


def test_every_point_and_corner_has_its_handle() -> None:
    names = list(named(DESIGN.run(STOOL)))
    on_lines = ["points.1.a", "points.2.a", "points.3.a", "points.5.a", "points.6.a"]
    in_planes = [f"points.{i}" for i in range(2, 7)]
    assert names == [*on_lines, *in_planes, "tucks.0.t"]


@pytest.mark.parametrize(
    ("name", "by"), [("points.4", (-1.0, 2.0)), ("points.5.a", (4.0, 0)), ("tucks.0.t", (9.0, 0))]
)
def test_a_dragged_point_goes_where_it_is_dragged(name: str, by: tuple[float, float]) -> None:
    handle = named(DESIGN.run(STOOL))[name]
    if isinstance(handle.locus, Plane):
        target = handle.position + by[0] * handle.locus.u + by[1] * handle.locus.v
    else:
        target = handle.position + by[0] * handle.locus.along  # type: ignore[union-attr]
    before = STOOL.model_dump()
    params = handle.drag(STOOL, target)
    assert STOOL.model_dump() == before
    assert DESIGN.validate(params.model_dump()) == params
    there = named(DESIGN.run(params))[name].position
    assert there == pytest.approx(target, abs=1e-9)


def test_points_after_a_dragged_one_keep_their_place_in_the_pattern() -> None:
    handle = named(DESIGN.run(STOOL))["points.4"]
    fold = DESIGN.run(handle.drag(STOOL, handle.position + np.array([0, 0, 3.0])))
    assert np.abs(np.hypot(*fold.pattern.vertices.T) - 265.2).min() < 1e-9


def test_a_point_on_its_line_becomes_free_when_dragged_in_its_plane() -> None:
    handle = named(DESIGN.run(STOOL))["points.6"]
    assert isinstance(STOOL.points[6], LinePoint)
    assert isinstance(handle.drag(STOOL, handle.position).points[6], FreePoint)


def test_a_handle_stops_at_what_limits_it() -> None:
    handles = named(DESIGN.run(STOOL))
    inner, outer = (handles["points.3.a"].drag(STOOL, np.array([x, 0.0])) for x in (0, 900))
    assert inner.points[3].a == 110 + HANDLE_GAP_MM
    assert outer.points[3].a == 265.2 - HANDLE_GAP_MM
    foot = handles["points.6.a"].drag(STOOL, np.zeros(2)).points[6]
    assert foot.a == pytest.approx(191.598 + HANDLE_GAP_MM, abs=1e-3)
    for far in (0.0, 500.0):
        (tuck,) = handles["tucks.0.t"].drag(STOOL, far * handles["tucks.0.t"].locus.along).tucks  # type: ignore[union-attr]
        assert tuck.t is not None
        assert 122 < tuck.t < 237


def test_dragging_an_automatic_corner_states_it() -> None:
    params = STOOL.model_copy(update={"tucks": ()})
    handle = named(DESIGN.run(params))["tucks.0.t"]
    (tuck,) = handle.drag(params, handle.position).tucks
    assert tuck.point == 4
    assert tuck.t == pytest.approx(float(np.hypot(*handle.position)))


def test_a_point_placed_by_hand_is_not_dragged_along_its_line() -> None:
    handle = named(DESIGN.run(STOOL))["points.3.a"]
    free = STOOL.model_copy(update={"points": {**STOOL.points, 3: FreePoint(r=90, z=-60)}})
    with pytest.raises(InvalidParameters, match="Point 3 is placed by hand"):
        handle.drag(free, handle.position)
