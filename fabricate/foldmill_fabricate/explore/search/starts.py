"""Where a search starts: the presets and the defaults, what is given put into them, and variants
of them with other discrete choices."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import replace
from fnmatch import fnmatchcase
from typing import Any

import numpy as np

from foldmill import Design, InvalidInput, InvalidParameters
from foldmill.schema import Leaf
from foldmill_fabricate.explore.search import frame as framing
from foldmill_fabricate.explore.search import ties
from foldmill_fabricate.explore.search.frame import Frame, Values, Variable, put, value_of
from foldmill_fabricate.explore.search.request import Request

FLIP, RENUMBER = 0.15, 0.3
"""How likely a variant takes another of a few values, and another whole number."""
FARTHEST = 2
"""By how much a variant's whole number may differ."""
_MISSING = (KeyError, ValueError, IndexError, TypeError)


def frames(design: Design[Any], request: Request) -> list[Frame]:
    """Return a frame for every start that has all parameters that are given or shall vary.

    Raises UnknownName for another preset, InvalidParameters where no start takes what is given.
    """
    found: list[Frame] = []
    refusal: InvalidInput | None = None
    for title, values in _starts(design, request):
        try:
            found.append(_frame(design, request, title, values))
        except InvalidInput as error:
            refusal = refusal or error
    if not found:
        raise refusal or InvalidParameters(f"The family {design.slug} has nothing to start from.")
    return found


def _starts(design: Design[Any], request: Request) -> Iterator[tuple[str, Values]]:
    if request.presets:
        for name in request.presets:
            yield name, design.preset(name).model_dump(mode="json")
        return
    try:
        usual = design.params().model_dump(mode="json")
    except ValueError:  # a family whose parameters have no defaults starts from its presets
        usual = None
    presets = {name: each.model_dump(mode="json") for name, each in design.presets.items()}
    if usual is not None and usual not in presets.values():
        yield "defaults", usual
    yield from presets.items()


def _frame(design: Design[Any], request: Request, title: str, values: Values) -> Frame:
    for name in (*request.fixed, *(name for name in request.vary if "*" not in name)):
        _require(design, values, name)
    everything = framing.free(design, values, {}, ())
    wanted = framing.free(design, values, request.fixed, request.vary)
    among = [*everything, *(leaf for leaf in wanted if leaf not in everything)]
    whole = ties.variables(design, values, among)
    given = _given(values, whole, request.fixed)
    design.validate(given)
    free = {leaf.name for leaf in wanted}
    kept = tuple(variable for variable in whole if free.issuperset(variable.names))
    if not kept and not any(_varies(request, leaf.name) for leaf in _discrete(design, given)):
        raise InvalidParameters(
            "Nothing is left to vary: what is named is given, does nothing, or cannot move alone. "
            "Name other parameters, or all that are tied together."
        )
    return Frame(title, given, kept).afresh()


def _require(design: Design[Any], values: Values, name: str) -> None:
    try:
        is_there = value_of(values, name)
    except _MISSING:
        raise InvalidParameters(
            f"There is no parameter {name!r} in any start; foldmill design {design.slug} --help "
            f"lists those there are."
        ) from None
    if isinstance(is_there, dict | list):
        raise InvalidParameters(f"{name!r} has parts; name one of them, such as {name}.1.")


def _given(values: Values, whole: tuple[Variable, ...], fixed: Mapping[str, float]) -> Values:
    """Put given values in; what is tied to them follows."""
    new = deepcopy(values)
    for name, value in fixed.items():
        group = next((v.names for v in whole if name in v.names), ())
        if type(value_of(values, name)) is int and float(value).is_integer():
            new = ties.with_order(new, tied_names(whole), name, int(value))
            continue
        before = value_of(new, name)
        put(new, name, float(value))
        for other in group:
            if other not in fixed and other != name:
                put(new, other, float(value_of(new, other)) * float(value) / float(before))
    return new


def tied_names(variables: tuple[Variable, ...]) -> tuple[str, ...]:
    """Return the names of the lengths that are tied together."""
    return tuple(name for each in variables if len(each.names) > 1 for name in each.names)


def variant(design: Design[Any], request: Request, frame: Frame, rng: np.random.Generator) -> Frame:
    """Return a frame with some discrete choices changed at random; not all of them fold."""
    values = frame.values
    for leaf in framing.choices(design, values):
        others = [each for each in leaf.schema["enum"] if each != value_of(values, leaf.name)]
        if _varies(request, leaf.name) and others and rng.random() < FLIP:
            values = deepcopy(values)
            put(values, leaf.name, others[int(rng.integers(len(others)))])
    for leaf in framing.numbers(design, values):
        if leaf.is_integer and _varies(request, leaf.name) and rng.random() < RENUMBER:
            step = int(rng.integers(1, FARTHEST + 1)) * (1 if rng.random() < 0.5 else -1)
            order = int(value_of(values, leaf.name)) + step
            if order > 2:
                values = ties.with_order(values, tied_names(frame.variables), leaf.name, order)
    return replace(frame, values=values).afresh()


def _discrete(design: Design[Any], values: Values) -> Iterator[Leaf]:
    yield from framing.choices(design, values)
    yield from (leaf for leaf in framing.numbers(design, values) if leaf.is_integer)


def _varies(request: Request, name: str) -> bool:
    named = any(fnmatchcase(name, each) for each in request.vary)
    return name not in request.fixed and (named or not request.vary)
