"""What varies in a family nobody told the search about, and what holds together."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import InvalidParameters, UnknownName
from foldmill_fabricate.explore.search import Request, Target
from foldmill_fabricate.explore.search.fit import Room
from foldmill_fabricate.explore.search.frame import Frame, value_of
from foldmill_fabricate.explore.search.measures import measures
from foldmill_fabricate.explore.search.starts import frames
from foldmill_plugins import rotational, six_crease, tuck

SHEET = Room(500, 500, 1)
ASKED = Request((Target.read("height=150"),), SHEET, 4.5)


def asked(**changes: object) -> Request:
    return Request(ASKED.targets, SHEET, 4.5, **changes)  # type: ignore[arg-type]


def stool(**changes: object) -> Frame:
    return frames(tuck.DESIGN, asked(presets=("stool-n8",), **changes))[0]


def names(frame: Frame) -> list[tuple[str, ...]]:
    return [variable.names for variable in frame.variables]


def seat(values: dict[str, object]) -> float:
    return measures(tuck.DESIGN.run({**values, "tucks": []}), SHEET)["seat"]


def test_the_two_lengths_of_a_flat_seat_move_together_and_its_angle_stays() -> None:
    found = names(stool())
    assert ("points.1.a", "points.2.a") in found
    assert ("phi",) not in found
    assert {("points.3.gamma",), ("points.4.r",), ("tucks.0.t",)} < set(found)


def test_the_seat_stays_flat_wherever_its_lengths_go() -> None:
    frame = stool()
    spot = [names(frame).index(("points.1.a", "points.2.a"))]
    for unit in (-0.4, 0.3):
        vector = np.zeros(len(frame.variables))
        vector[spot] = unit
        values = frame.at(vector)
        assert seat(values) == pytest.approx(2 * value_of(values, "points.1.a"))


@pytest.mark.parametrize("order", [6, 7, 9])
def test_the_seat_stays_flat_with_another_number_of_sides(order: int) -> None:
    values = stool(fixed={"n": order}).values
    ratio = value_of(values, "points.1.a") / value_of(values, "points.2.a")
    assert values["n"] == order
    assert ratio == pytest.approx(np.cos(np.pi / order))


def test_what_is_given_is_held_and_what_is_tied_to_it_follows() -> None:
    frame = stool(fixed={"points.1.a": 100})
    assert seat(frame.values) == pytest.approx(200)
    assert not {"points.1.a", "points.2.a"} & {name for each in names(frame) for name in each}


def test_a_form_that_is_twice_as_large_has_twice_the_lengths_and_the_same_angles() -> None:
    frame = stool()
    here = frame.scaled(np.zeros(len(frame.variables)), 1.25)
    one, two = (tuck.DESIGN.run(frame.at(v)) for v in (0 * here, here))
    np.testing.assert_allclose(two.pattern.vertices, 1.25 * one.pattern.vertices, atol=1e-9)


def test_what_stands_at_the_end_of_its_range_or_does_nothing_is_held() -> None:
    lampshade = frames(six_crease.DESIGN, asked(presets=("lampshade",)))[0]
    held = {"L", "tab", "taper", "n"} & {name for each in names(lampshade) for name in each}
    assert not held
    wider = frames(six_crease.DESIGN, asked(presets=("lampshade",), vary=("L", "w")))[0]
    assert names(wider) == [("w",), ("L",)]


def test_only_what_is_named_varies() -> None:
    frame = frames(rotational.DESIGN, asked(vary=("points.*.a",)))[0]
    assert {name for each in names(frame) for name in each} == {
        f"points.{i}.a" for i in range(1, 7)
    }


def test_every_preset_is_a_start_and_the_defaults_once() -> None:
    assert [frame.title for frame in frames(rotational.DESIGN, ASKED)] == [*rotational.PRESETS]
    titles = [frame.title for frame in frames(tuck.DESIGN, ASKED)]
    assert titles == ["defaults", *tuck.DESIGN.presets]


def test_unknown_names_are_refused() -> None:
    with pytest.raises(InvalidParameters, match=r"no parameter 'points\.99\.a' in any start"):
        frames(rotational.DESIGN, asked(fixed={"points.99.a": 3}))
    with pytest.raises(InvalidParameters, match="has parts"):
        frames(rotational.DESIGN, asked(vary=("points",)))
    with pytest.raises(UnknownName, match="no preset"):
        frames(rotational.DESIGN, asked(presets=("bowl",)))
    with pytest.raises(InvalidParameters, match="Nothing is left to vary"):
        frames(tuck.DESIGN, asked(vary=("phi",), presets=("stool-n8",)))
    with pytest.raises(InvalidParameters, match="n must be at least 3, not 2"):
        frames(rotational.DESIGN, asked(fixed={"n": 2}))
