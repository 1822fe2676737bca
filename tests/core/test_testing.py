"""The contract suite finds what a careless plugin gets wrong, and says where."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import count
from typing import Annotated, Any

import numpy as np
import pytest
from pydantic import BaseModel, Field

from foldmill import CreasePattern, Design, Fold, FoldedForm, Length, Params, Symmetry
from foldmill.pattern import codes_of
from foldmill.testing import design_checks


class SquareParams(Params):
    """A square sheet."""

    side: Length = Field(default=100.0, le=500)
    """Side of the sheet."""


def square(params: Any) -> Fold:
    """Return a square with one valley diagonal."""
    s = float(getattr(params, "side", 100.0))
    corners: list[list[float]] = [[0, 0], [s, 0], [s, s], [0, s]]
    lines = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]]
    return Fold(CreasePattern.from_lines(corners, lines, "BBBBV"))


GOOD = Design(
    slug="square", title="Square", params=SquareParams, generate=square,
    presets={"small": SquareParams(side=20)},
)  # fmt: skip


def failures(design: Design[Any]) -> dict[str, str]:
    said = {}
    for check in design_checks(design):
        try:
            check()
        except AssertionError as error:
            said[check.name] = str(error)
    return said


def test_a_careful_design_passes_every_check() -> None:
    assert not failures(GOOD)
    names = [str(check) for check in design_checks(GOOD)]
    assert len(names) == len(set(names))
    assert "fold-round-trip[small]" in names


class Undocumented(Params):
    side: Length = 10.0


class Required(Params):
    side: Length
    """Side."""


class Unitless(Params):
    side: float = Field(default=10.0, allow_inf_nan=False)
    """Side."""
    share: float = Field(default=0.5, ge=0, le=1)
    """Share of the side: a ratio needs no unit."""


class Open(BaseModel):
    """Parameters that do not derive from Params, and so take anything."""

    side: Length = Field(default=10.0, description="Side.")


class Overruled(Params):
    side: Annotated[float, Field(ge=0, json_schema_extra={"x-unit": "mm"})] = Field(10.0, ge=5)
    """Side; its ge=5 does not hold."""


class Corner(Params):
    """A corner of the sheet."""

    x: float = Field(default=1.0, json_schema_extra={"x-unit": "mm"})


class Nested(Params):
    corners: dict[int, Corner] = Field(default_factory=lambda: {1: Corner()})
    """Corners by number."""


def shaky() -> Callable[[Any], Fold]:
    """Return a design that gives another sheet each time."""
    sides = count(10)
    return lambda _: square(SquareParams(side=next(sides)))


def stretched(params: Any) -> Fold:
    """Return the square with a folded form twice its size."""
    pattern = square(params).pattern
    solid = np.column_stack([2 * pattern.vertices, np.zeros(4)])
    return Fold(pattern, FoldedForm(solid))


class Forgetful(Params):
    sizes: dict[int, Length] = Field(default_factory=lambda: {1: 10.0})
    """Sizes, which generate forgets."""


def emptied(params: Any) -> Fold:
    params.sizes.clear()
    return square(params)


def failing_at_the_end(params: Any) -> Fold:
    """Return a square, which nobody may ask to be as large as it can be."""
    return square(SquareParams(side=100 / (500 - params.side)))


def torn_at_the_end(params: Any) -> Fold:
    return stretched(params) if params.side == 500 else square(params)


def undecided(params: Any) -> Fold:
    sheet = square(params).pattern
    letters = sheet.letters().replace("V", "U")
    return Fold(CreasePattern.from_lines(sheet.vertices, sheet.edges, letters))


def claiming(order: int, wedge: list[int]) -> Callable[[Any], Fold]:
    """Return a design whose flat square is said to be symmetric."""

    def claimed(params: Any) -> Fold:
        pattern = square(params).pattern
        flat = np.zeros(len(pattern.edges))
        sheet = replace(pattern, assignments=codes_of("BBBBF"), fold_angles=flat)
        solid = np.column_stack([pattern.vertices, np.zeros(4)])
        return Fold(sheet, FoldedForm(solid), Symmetry(order, np.array(wedge), True))

    return claimed


@pytest.mark.parametrize(
    ("changes", "check", "said"),
    [
        ({"slug": "Square Sheet"}, "slug", "'Square Sheet'"),
        ({"presets": {"No_1": SquareParams()}}, "slug", "'No_1'"),
        ({"params": Undocumented}, "documented", "side: document it"),
        ({"params": Nested}, "documented", "corners.*.x: document it"),
        ({"params": Required}, "defaults", "side: give it a default"),
        ({"params": Unitless}, "units", "side: use Length"),
        ({"params": Open}, "closed", "derive it from Params"),
        ({"params": Open}, "unknown-refused", "is accepted"),
        ({"params": Overruled}, "bounds-hold", "ge=[5, 0] contradict"),
        ({"params": Nested}, "nan-refused", "corners.1.x = NaN is accepted"),
        ({"presets": {"odd": Undocumented()}}, "presets", "odd: a preset is"),
        ({"generate": lambda p: square(p).pattern}, "returns-a-fold[small]", "CreasePattern"),
        ({"generate": shaky()}, "deterministic[small]", "two different patterns"),
        ({"generate": stretched}, "without-errors[small]", "Folding changes the length"),
        (
            {"params": Forgetful, "generate": emptied},
            "params-untouched[defaults]",
            "generate changes the parameters",
        ),
        ({"generate": failing_at_the_end}, "corners-answered", "At side = 500"),
        ({"generate": torn_at_the_end}, "corners-answered", "At side = 500"),
        ({"generate": undecided}, "assigned[small]", "1 creases are neither mountain"),
        ({"generate": claiming(3, [0])}, "symmetric[small]", "turned 3 times, is not the whole"),
        ({"generate": claiming(1, [0])}, "symmetric[small]", "half wedge crosses the axis"),
    ],
)
def test_a_careless_design_is_told(changes: dict[str, Any], check: str, said: str) -> None:
    presets: dict[str, Any] = {} if "params" in changes else {"presets": GOOD.presets}
    design = replace(GOOD, **{"presets": {}, **presets, **changes})
    chosen = next(each for each in design_checks(design) if each.name == check)
    with pytest.raises(AssertionError) as failure:
        chosen()
    assert said in str(failure.value)


def test_a_design_that_returns_nothing_is_told_so_by_every_check_of_a_case() -> None:
    empty = replace(GOOD, generate=lambda _: None)  # type: ignore[arg-type,return-value]
    said = failures(empty)
    assert {name for name in said if "[" in name} == {
        check.name for check in design_checks(GOOD) if "[" in check.name
    }
    assert all("NoneType, not a Fold" in sentence for sentence in said.values())
    assert "corners-answered" in said


def test_creases_may_stay_unassigned_where_that_is_said() -> None:
    expected = {f"assigned[{case}]": "for the reader" for case in ("defaults", "small")}
    for check in design_checks(replace(GOOD, generate=undecided), expected):
        check()


def test_what_is_expected_to_fail_passes_while_it_fails() -> None:
    design = replace(GOOD, generate=stretched)
    names = ("without-errors[defaults]", "without-errors[small]", "corners-answered")
    for check in design_checks(design, dict.fromkeys(names, "a joke")):
        check()


def test_what_is_expected_to_fail_fails_once_it_passes() -> None:
    (check,) = (c for c in design_checks(GOOD, {"slug": "no idea"}) if c.name == "slug")
    with pytest.raises(AssertionError, match="slug passes, though it is said to fail: no idea"):
        check()


def test_expecting_a_check_that_is_not_there_is_an_error() -> None:
    with pytest.raises(ValueError, match="There is no check 'slugg'"):
        design_checks(GOOD, {"slugg": "typo"})
