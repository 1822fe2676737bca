"""A design's parameters are declared once and refused in sentences."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from pydantic import Field, ValidationError

from foldmill import (
    Coordinate,
    CreasePattern,
    Design,
    Fold,
    ImpossibleGeometry,
    InvalidParameters,
    Length,
    Params,
    PluginFault,
    UnknownName,
)


class StripParams(Params):
    side: Length = Field(default=100.0, le=2000)
    """Side of the square."""
    shift: Coordinate = Field(default=0.0, ge=-50)
    """Where the square begins."""
    folds: bool = True
    """Whether the diagonal folds."""


def diagonal(params: StripParams) -> Fold:
    s = params.side
    lines = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]]
    corners: list[list[float]] = [[0, 0], [s, 0], [s, s], [0, s]]
    letters = "BBBBV" if params.folds else "BBBBF"
    return Fold(CreasePattern.from_lines(corners, lines, letters), meta={"note": "hand-made"})


DIAGONAL = Design(
    slug="diagonal",
    title="One diagonal fold",
    params=StripParams,
    generate=diagonal,
    presets={"a4": StripParams(side=210)},
)


def test_a_run_records_which_design_and_parameters_it_was() -> None:
    fold = DIAGONAL.run({"side": 50})
    assert fold.pattern.size == 50
    assert fold.meta["title"] == "One diagonal fold"
    assert fold.meta["note"] == "hand-made"
    assert fold.meta["design"] == {
        "slug": "diagonal",
        "version": "1",
        "params": {"side": 50.0, "shift": 0.0, "folds": True},
    }


def test_what_was_recorded_runs_again_to_the_same_pattern() -> None:
    first = DIAGONAL.run(DIAGONAL.preset("a4"))
    again = DIAGONAL.run(first.meta["design"]["params"])
    assert np.array_equal(first.pattern.vertices, again.pattern.vertices)


def test_the_schema_states_unit_bounds_and_meaning() -> None:
    side = DIAGONAL.schema()["properties"]["side"]
    assert side["x-unit"] == "mm"
    assert side["maximum"] == 2000
    assert side["exclusiveMinimum"] == 0
    assert side["description"] == "Side of the square."


class Plain(Params):
    side: Length = 10.0
    """A length with no bounds of its own."""
    shift: Coordinate = 0.0
    """A coordinate with no bounds of its own."""


@pytest.mark.parametrize(
    "values", [{"side": 1e5}, {"side": 1e200}, {"shift": 1e5}, {"shift": -1e5}, {"side": 0}]
)
def test_no_length_and_no_coordinate_reaches_a_hundred_metres(values: dict[str, float]) -> None:
    with pytest.raises(ValidationError):
        Plain.model_validate(values)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"side": 0}, r"side must be more than 0 mm, not 0\."),
        ({"side": 3000}, r"side must be at most 2000 mm, not 3000\."),
        ({"shift": -51}, r"shift must be at least -50 mm, not -51\."),
        ({"shift": 1e200}, r"shift must be less than 100000 mm, not 1e\+200\."),
        ({"side": float("nan")}, "side must be a finite number"),
        ({"side": "long"}, r"side must be a number, not 'long'\."),
        ({"width": 3}, r"There is no width to set; there are side, shift, folds\."),
    ],
)
def test_a_value_out_of_bounds_is_named_with_what_was_given(
    values: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InvalidParameters, match=sentence):
        DIAGONAL.run(values)


def test_every_fault_gets_its_sentence() -> None:
    with pytest.raises(InvalidParameters, match=r"side must be .*\. There is no width .*\."):
        DIAGONAL.run({"side": -1, "width": 2})


def test_an_unknown_preset_is_answered_with_the_known_ones() -> None:
    with pytest.raises(UnknownName, match=r"no preset of diagonal 'a5'. There are: a4\."):
        DIAGONAL.preset("a5")


def nothing(params: StripParams) -> Any:
    return None


def divided(params: StripParams) -> Fold:
    raise ZeroDivisionError("by\nnothing")


def leaving(params: StripParams) -> Fold:
    raise SystemExit(3)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"generate": nothing}, "its generate returns NoneType, not a Fold"),
        ({"generate": divided}, "fails with ZeroDivisionError: by nothing. Other parameters may"),
        ({"generate": leaving}, "fails with SystemExit: 3"),
        ({"generate": None}, "its generate is None, which is no function"),
        ({"params": dict}, "its params are <class 'dict'>, which is no kind of Params"),
        ({"title": None}, "its title is None, which is no text"),
        ({"presets": None}, "its presets are no mapping"),
    ],
)
def test_a_family_that_breaks_is_named(changes: dict[str, Any], sentence: str) -> None:
    broken: Design[Any] = replace(DIAGONAL, **changes)
    with pytest.raises(PluginFault, match=f"The family 'diagonal' is broken: .*{sentence}"):
        broken.run()


def test_what_a_family_refuses_stays_its_own_sentence() -> None:
    def refusing(params: StripParams) -> Fold:
        raise ImpossibleGeometry("Point 3 has no place.")

    with pytest.raises(ImpossibleGeometry, match=r"^Point 3 has no place\.$"):
        replace(DIAGONAL, generate=refusing).run()


def test_parameters_cannot_be_changed() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        StripParams().side = 3
