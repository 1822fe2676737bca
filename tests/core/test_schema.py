"""Parameters are found by their dotted names, however deep they lie."""

from __future__ import annotations

from typing import Any

import pytest

from foldmill.schema import Bound, inside, leaves, objects, outside, placed
from foldmill_plugins.tuck import DESIGN

SCHEMA = DESIGN.schema()
STOOL: dict[str, Any] = DESIGN.preset("stool-n8").model_dump(mode="json")


def test_every_kind_of_parameter_is_found_without_values() -> None:
    kinds = {leaf.kind for leaf in leaves(SCHEMA)}
    assert {"n", "phi", "points.*.a", "points.*.r", "points.*.gamma", "tucks.*.t"} <= kinds
    assert {name for name, _ in objects(SCHEMA)} == {"", "points", "points.*", "tucks.*"}


def test_with_values_each_parameter_is_found_by_its_name() -> None:
    found = {leaf.name: leaf for leaf in leaves(SCHEMA, STOOL)}
    assert found["points.4.r"].unit == "mm"
    assert found["tucks.0.t"].kind == "tucks.*.t"
    assert "points.4.a" not in found
    assert found["n"].is_integer
    assert not found["points.1.branch"].is_number
    assert [bound.value for bound in found["phi"].bounds] == [0, 180]


@pytest.mark.parametrize(
    ("bound", "is_integer", "beyond"),
    [
        (Bound(3, -1, False), True, 2),
        (Bound(72, 1, False), True, 73),
        (Bound(0, -1, True), True, 0),
        (Bound(0, -1, True), False, 0),
        (Bound(180, 1, False), False, 180.00000000000003),
        (Bound(0, -1, False), False, -5e-324),
    ],
)
def test_one_step_beyond_a_bound(bound: Bound, is_integer: bool, beyond: float) -> None:
    assert outside(bound, is_integer) == beyond


def test_placing_a_value_leaves_the_others_as_they_were() -> None:
    changed = placed(STOOL, ("points", "3", "a"), 999.0)
    assert changed["points"]["3"]["a"] == 999.0
    assert STOOL["points"]["3"]["a"] == 172.48
    assert changed["tucks"] == STOOL["tucks"]


@pytest.mark.parametrize(
    ("bound", "is_integer", "within"),
    [
        (Bound(72, 1, False), True, 72),
        (Bound(0, -1, True), True, 1),
        (Bound(0, -1, True), False, 5e-324),
        (Bound(180, 1, True), False, 179.99999999999997),
    ],
)
def test_the_last_number_within_a_bound(bound: Bound, is_integer: bool, within: float) -> None:
    assert inside(bound, is_integer) == within
