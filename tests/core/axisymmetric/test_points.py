"""Points are stated by a along a line, or by r and z in space, and are numbered without gaps."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from foldmill.axisymmetric.points import FreePoint, LinePoint, LinePoints, Points

ANY, LINES = TypeAdapter(Points), TypeAdapter(LinePoints)


def test_a_point_is_free_where_it_has_r_or_z() -> None:
    points = ANY.validate_python({"2": {"r": 50, "z": -3}, "1": {"a": 40}})
    assert points == {1: LinePoint(a=40), 2: FreePoint(r=50, z=-3)}
    assert list(points) == [1, 2]


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        ({1: {"a": 40}}, "needs points 1 and 2"),
        ({1: {"a": 40}, 3: {"a": 60}}, "must be numbered 1, 2, 3"),
        ({0: {"a": 40}, 1: {"a": 60}}, "must be numbered 1, 2, 3"),
        ({1: {"a": 40}, 2: {"a": 0}}, "greater than 0"),
        ({1: {"a": 40}, 2: {"a": -3}}, "greater than 0"),
        ({1: {"a": 40}, 2: {"a": float("inf")}}, "finite number"),
        ({1: {"a": 40}, 2: {"a": float("nan")}}, "finite number"),
        ({1: {"a": 40}, 2: {"a": 60, "branch": 0}}, "-1 or 1"),
        ({1: {"a": 40}, 2: {"a": 60, "branch": 2}}, "-1 or 1"),
        ({1: {"a": 40}, 2: {"a": 60, "gamma": float("nan")}}, "finite number"),
        ({1: {"a": 40}, 2: {"r": 60}}, "z\n +Field required"),
        ({1: {"a": 40}, 2: {"r": 60, "z": 3, "a": 60}}, "Extra inputs are not permitted"),
        ({1: {"a": 40}, 2: {"r": float("inf"), "z": 3}}, "finite number"),
    ],
)
def test_a_point_that_cannot_be_is_refused(points: dict[int, Any], sentence: str) -> None:
    with pytest.raises(ValidationError, match=sentence):
        ANY.validate_python(points)


def test_a_plain_rotational_form_has_no_free_points() -> None:
    with pytest.raises(ValidationError, match="Field required"):
        LINES.validate_python({1: {"a": 40}, 2: {"r": 60, "z": 3}})
