"""What varies: a start's parameters as a vector, and a vector as parameters.

A *frame* is one start with its discrete choices settled: numbers of wedges, branches, sides. Its
variables are single numbers, or several lengths that are tied: they grow and shrink together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import Design
from foldmill.schema import Leaf, inside, leaves

Floats = NDArray[np.float64]
Values = dict[str, Any]

STEPS = {"deg": 10.0}
"""One unit of a vector, where it is no length: degrees."""
PART = 0.1
"""One unit of a vector for a length, as a share of the start's size; for a bare number likewise."""


@dataclass(frozen=True)
class Variable:
    """One number of the vector."""

    names: tuple[str, ...]
    """The parameters it sets, by dotted name; several lengths keep their ratios."""
    start: tuple[float, ...]
    """Their values at the start."""
    step: float
    """By how much the first of them changes with one unit of the vector."""
    low: float
    high: float
    """Between which values the first of them stays."""
    is_length: bool


@dataclass(frozen=True, eq=False)
class Frame:
    """A start and its variables."""

    title: str
    """The preset it comes from."""
    values: Values
    variables: tuple[Variable, ...]

    def at(self, vector: Floats) -> Values:
        """Return the parameters at a vector (d,); the start itself is at 0."""
        values = deepcopy(self.values)
        for variable, unit in zip(self.variables, vector, strict=True):
            first = variable.start[0]
            now = min(max(first + variable.step * float(unit), variable.low), variable.high)
            for name, value in zip(variable.names, variable.start, strict=True):
                put(values, name, now if len(variable.names) == 1 else value * now / first)
        return values

    def scaled(self, vector: Floats, factor: float) -> Floats:
        """Return the vector at which every length that varies is ``factor`` times as long."""
        start = np.array([variable.start[0] for variable in self.variables])
        step = np.array([variable.step for variable in self.variables])
        is_length = np.array([variable.is_length for variable in self.variables], bool)
        grown: Floats = np.where(is_length, factor * (start + step * vector) - start, 0.0) / step
        return np.where(is_length, grown, vector)

    def afresh(self) -> Frame:
        """Return the frame whose variables start at its values, after those were changed."""
        return replace(self, variables=tuple(_from(v, self.values) for v in self.variables))


def numbers(design: Design[Any], values: Values) -> Iterator[Leaf]:
    """Yield the parameters that have a number now and may have another."""
    for leaf in leaves(design.schema(), values):
        if leaf.is_number and type(value_of(values, leaf.name)) in (int, float):
            yield leaf


def choices(design: Design[Any], values: Values) -> Iterator[Leaf]:
    """Yield the parameters that have one of a few values now."""
    for leaf in leaves(design.schema(), values):
        if "enum" in leaf.schema and value_of(values, leaf.name) in leaf.schema["enum"]:
            yield leaf


def free(
    design: Design[Any], values: Values, fixed: Mapping[str, float], vary: tuple[str, ...]
) -> list[Leaf]:
    """Return the parameters that may vary continuously.

    What stands at an end of its range (no tab, no radius) stays there unless it is named.
    """
    found = []
    for leaf in numbers(design, values):
        value = value_of(values, leaf.name)
        named = any(fnmatchcase(leaf.name, name) for name in vary)
        at_end = any(value == bound.value for bound in leaf.bounds)
        if leaf.is_integer or (not named and (vary or at_end or leaf.name in fixed)):
            continue
        found.append(leaf)
    return found


def variable(group: list[Leaf], values: Values, size: float) -> Variable:
    """Return one variable for parameters of a start whose sheet is ``size`` mm large."""
    first, start = group[0], tuple(float(value_of(values, leaf.name)) for leaf in group)
    low = max((inside(b, False) for b in first.bounds if b.side < 0), default=-np.inf)
    high = min((inside(b, False) for b in first.bounds if b.side > 0), default=np.inf)
    is_length = first.unit == "mm"
    step = PART * size / 2 if is_length else STEPS.get(first.unit, PART)
    if is_length and len(group) > 1:
        low = high * 0 + 0.01 * start[0] if start[0] > 0 else -np.inf
    return Variable(tuple(leaf.name for leaf in group), start, step, low, high, is_length)


def value_of(values: Any, name: str) -> Any:
    """Return what stands at a dotted name among plain values."""
    for part in name.split("."):
        values = values[int(part)] if isinstance(values, list) else _entry(values, part)
    return values


def put(values: Any, name: str, new: Any) -> None:
    """Set what stands at a dotted name among plain values; a whole number stays one."""
    *path, last = name.split(".")
    for part in path:
        values = values[int(part)] if isinstance(values, list) else _entry(values, part)
    key: Any = int(last) if isinstance(values, list) else _key(values, last)
    values[key] = new


def _entry(values: Any, part: str) -> Any:
    return values[_key(values, part)]


def _key(values: Any, part: str) -> Any:
    return part if part in values else int(part)


def _from(old: Variable, values: Values) -> Variable:
    return replace(old, start=tuple(float(value_of(values, name)) for name in old.names))
