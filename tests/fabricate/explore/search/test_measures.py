"""What a form measures, held against shapes whose measures are known, and against the planner."""

from __future__ import annotations

from math import cos, radians

import numpy as np
import pytest

from foldmill_fabricate.errors import DoesNotFit
from foldmill_fabricate.explore.search.fit import Room, require_place, room
from foldmill_fabricate.explore.search.measures import measures
from foldmill_plugins import rotational, tuck

SHEET = Room(500, 500, 1)


@pytest.mark.parametrize(("n", "half"), [(8, 110.0), (6, 98.85), (4, 77.1)])
def test_the_seat_of_a_stool_is_its_width_across_flats(n: int, half: float) -> None:
    found = measures(tuck.DESIGN.run(tuck.DESIGN.preset(f"stool-n{n}")), SHEET)
    assert found["seat"] == pytest.approx(2 * half, abs=1e-9)
    assert found["height"] == pytest.approx(150, abs=0.1)


def test_the_feet_of_a_stool_stand_on_a_circle() -> None:
    fold = tuck.DESIGN.run(tuck.DESIGN.preset("stool-n8"))
    assert fold.folded is not None
    feet = fold.folded.vertices[np.argsort(fold.folded.vertices[:, 2])[:8]]
    gap = np.linalg.norm(feet[:, None] - feet[None], axis=2).max()
    assert measures(fold, SHEET)["footprint"] == pytest.approx(gap)


def test_a_dished_form_has_no_seat() -> None:
    assert measures(rotational.DESIGN.run(), SHEET)["seat"] == 0


def test_a_square_on_its_corner_is_turned_onto_its_side() -> None:
    corners = np.array([[100, 0], [0, 100], [-100, 0], [0, -100.0]])
    taken = room(corners, Room(150, 150, 3))
    assert taken.width == pytest.approx(100 * 2**0.5 + 6, abs=1e-6)
    assert taken.over == 0
    assert room(corners, Room(140, 150, 3)).over == pytest.approx(100 * 2**0.5 - 134, abs=1e-6)


@pytest.mark.parametrize("preset", ["stool-n8", "stool-n6", "basket-n10"])
def test_the_planner_finds_room_where_the_search_says_and_not_on_less(preset: str) -> None:
    spots = tuck.DESIGN.run(tuck.DESIGN.preset(preset)).pattern.vertices
    taken = room(spots, Room(100, 100, 1))
    side = max(taken.width, taken.height)
    require_place(spots, Room(side + 0.01, side + 0.01, 1))
    with pytest.raises(DoesNotFit):
        require_place(spots, Room(side - 0.05, side - 0.05, 1))


def test_half_the_angle_between_flats_is_what_a_seat_loses_at_its_corners() -> None:
    found = measures(tuck.DESIGN.run(tuck.DESIGN.preset("flush-n6")), SHEET)
    assert found["seat"] == pytest.approx(120, abs=1e-9)
    assert found["seat"] < 120 / cos(radians(30))
