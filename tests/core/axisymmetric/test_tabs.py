"""Glue tabs along a seam: they belong to the facets that hold them."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill import ImpossibleGeometry
from foldmill.axisymmetric import tabs, tube
from foldmill.axisymmetric.tube import Sheet, Tube


def prism() -> Tube:
    flat = np.array([(0, 0), (10, 3), (0, 14), (10, 17), (0, 30)], float)
    places = np.column_stack([np.full(5, 20.0), flat[:, 1]])
    return tube.assemble(tube.half_wedge(6, flat, places))


def test_tabs_move_rigidly_with_the_facets_that_hold_them() -> None:
    whole = prism()
    made = tabs.add(Sheet.of(whole), 2.0, 30.0)
    assert np.abs(made.carry(whole.spatial) - made.sheet.spatial).max() < 1e-13
    angle = 0.7
    turn = np.array(
        [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    )
    moved = made.carry(whole.spatial @ turn.T + [3, 4, 5])
    assert np.abs(moved - (made.sheet.spatial @ turn.T + [3, 4, 5])).max() < 1e-13


def test_a_tab_wider_than_its_room_is_refused_with_the_room_there_is() -> None:
    whole = Sheet.of(prism())
    tabs.add(whole, 4.04, 60)  # both ends of the 14 mm lean by √3 mm for each mm of width
    with pytest.raises(ImpossibleGeometry, match=r"14 mm long: with a taper of 60° .* 4\.041 mm\."):
        tabs.add(whole, 4.05, 60)
