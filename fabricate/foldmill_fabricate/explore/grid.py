"""The grid of all combinations: its rows, and the values of each.

Terminology: the parameter named first is the slowest; *row* r is the same configuration whatever
computes it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import Design, InvalidParameters, Params
from foldmill.batch import Column
from foldmill.schema import Leaf, leaves
from foldmill_fabricate.errors import CannotExplore
from foldmill_fabricate.explore.ranges import Range

AT_MOST = 1_000_000
"""Rows of a sweep, unless more are asked for: a slip of the step shall not fill a day."""


@dataclass(frozen=True, eq=False)
class Axis:
    """One varied parameter."""

    name: str
    """Dotted."""
    values: NDArray[np.float64]
    """(k,) in the unit of its field, strictly rising or falling."""
    unit: str
    """"mm", "deg" or nothing."""
    is_whole: bool
    """A count or a choice: nothing lies between two of its values."""

    @property
    def label(self) -> str:
        """Its name with its unit, for people."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    def shown(self, value: float) -> str:
        """Return one of its values in words: "beta = 36 deg"."""
        return f"{self.name} = {value:.10g} {self.unit}".rstrip()


@dataclass(frozen=True, eq=False)
class Grid:
    """All combinations of the values of some parameters."""

    axes: tuple[Axis, ...]
    """The slowest first."""

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """How many values each parameter takes."""
        return tuple(len(axis.values) for axis in self.axes)

    def __len__(self) -> int:
        return prod(self.shape)

    def columns(self, rows: NDArray[np.intp]) -> dict[str, Column]:
        """Return the values (n,) of every varied parameter in these rows, by dotted name."""
        places = np.unravel_index(rows, self.shape)
        return {
            axis.name: axis.values[place] for axis, place in zip(self.axes, places, strict=True)
        }

    def values(self, row: int) -> dict[str, float]:
        """Return what a row varies, by dotted name; raises CannotExplore where there is none."""
        if not 0 <= row < len(self):
            raise CannotExplore(f"There is no row {row}: the rows are 0 to {len(self) - 1}.")
        columns = self.columns(np.array([row]))
        return {name: float(column[0]) for name, column in columns.items()}

    def told(self, row: int) -> str:
        """Return what a row varies, in words: "phi = 21 deg, beta = 36 deg"."""
        values = self.values(row)
        return ", ".join(axis.shown(values[axis.name]) for axis in self.axes)


def grid(
    design: Design[Any], base: Params, ranges: Sequence[Range], at_most: int = AT_MOST
) -> Grid:
    """Return the grid of these ranges over a family's parameters.

    Raises CannotExplore for no range, a parameter varied twice, one that is no number, and more
    than ``at_most`` rows; InvalidParameters for a name that is no parameter.
    """
    if not ranges:
        raise CannotExplore("Nothing is varied: name at least one parameter and its range.")
    names = [each.name for each in ranges]
    for name in names:
        if names.count(name) > 1:
            raise CannotExplore(f"{name} is varied twice; give it one range.")
    rows = prod(len(each.values) for each in ranges)
    if rows > at_most:
        counts = " × ".join(f"{len(each.values):,}" for each in ranges)
        counts = f"{counts} = {rows:,}" if len(ranges) > 1 else counts
        raise CannotExplore(
            f"The sweep would have {counts} rows, more than {at_most:,}. Take larger "
            f"steps, or allow it with --at-most {rows}."
        )
    known = [*leaves(base.model_json_schema(), base.model_dump(mode="json"))]
    return Grid(tuple(_axis(design, known, each) for each in ranges))


def _axis(design: Design[Any], known: Sequence[Leaf], varied: Range) -> Axis:
    leaf = _leaf(design, known, varied.name)
    is_whole = leaf.is_integer or _choices(leaf) != []
    for value in varied.values:
        if is_whole and not value.is_integer():
            raise CannotExplore(f"{varied.name} is a whole number, and {value:g} is none.")
        if _choices(leaf) and value not in _choices(leaf):
            listed = ", ".join(f"{choice:g}" for choice in _choices(leaf))
            raise CannotExplore(f"{varied.name} is one of {listed}, never {value:g}.")
    return Axis(varied.name, np.array(varied.values), leaf.unit, is_whole)


def _leaf(design: Design[Any], known: Sequence[Leaf], name: str) -> Leaf:
    named = [leaf for leaf in known if leaf.name == name]
    for leaf in named:
        if leaf.is_number or _choices(leaf):
            return leaf
    if named:
        raise CannotExplore(f"{name} is no number, so it has no range. State it: --{name} VALUE.")
    if any(leaf.name.startswith(f"{name}.") for leaf in known):
        parts = _varied([leaf for leaf in known if leaf.name.startswith(f"{name}.")])
        raise CannotExplore(f"{name} holds others and has no range itself; vary one of {parts}.")
    raise InvalidParameters(
        f"The family {design.slug!r} has no parameter {name!r} here. There are: {_varied(known)}."
    )


def _varied(among: Sequence[Leaf]) -> str:
    """Return the names of those that can be varied."""
    return ", ".join(dict.fromkeys(leaf.name for leaf in among if leaf.is_number or _choices(leaf)))


def _choices(leaf: Leaf) -> list[float]:
    """Return what a parameter is chosen from, where it is a choice among numbers."""
    offered = leaf.schema.get("enum", [])
    is_numeric = all(isinstance(c, int | float) and not isinstance(c, bool) for c in offered)
    return [float(choice) for choice in offered] if is_numeric else []
