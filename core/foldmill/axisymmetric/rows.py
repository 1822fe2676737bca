"""The parameters of many configurations: columns where they vary, the base where they do not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foldmill.batch import Column
from foldmill.design import Params
from foldmill.schema import Leaf, leaves

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
KEY_DIGITS = 12
"""Decimal digits in which two lengths are one. Rounding leaves more of them alike."""


@dataclass(frozen=True, eq=False)
class Rows:
    """n configurations of one design."""

    base: Params
    columns: Mapping[str, Column]
    """(n,) each, by dotted name; every name is a number of the base."""

    def of(self, name: str) -> Column:
        """Return a parameter by its dotted name: (n,) where it varies, (1,) where it does not."""
        if name in self.columns:
            return self.columns[name]
        return np.array([self._stated(name)], np.float64)

    def within(self, name: str) -> list[object]:
        """Return the keys of a parameter that holds others by name or number."""
        holder = self._stated(name)
        return list(holder) if isinstance(holder, Mapping) else []

    def _stated(self, name: str) -> object:
        value: object = self.base
        for part in name.split("."):
            value = value[int(part)] if isinstance(value, Mapping) else getattr(value, part)
        return value

    def table(self, names: Sequence[str]) -> Floats:
        """Return several parameters beside each other: (n, k), or (1, k) where none varies."""
        return np.stack(np.broadcast_arrays(*(self.of(name) for name in names)), axis=1)

    def varies(self, *names: str) -> bool:
        """Tell whether any of the parameters varies."""
        return any(name in self.columns for name in names)


def in_bounds(base: Params, columns: Mapping[str, Column]) -> Flags | None:
    """Tell which rows (n,) keep the bounds that the model states for each single parameter.

    None where a column is no number of the base, or belongs to a parameter that holds others.
    """
    known = _numbers(base)
    if not columns or not set(columns) <= set(known):
        return None
    kept = [_keeps(known[name], column) for name, column in columns.items()]
    flags: Flags = np.logical_and.reduce(kept)
    return flags


def _numbers(base: Params) -> dict[str, Leaf]:
    stated = leaves(type(base).model_json_schema(), base.model_dump(mode="json"))
    return {
        leaf.name: leaf
        for leaf in stated
        if leaf.schema.get("type") in {"integer", "number"} and "const" not in leaf.schema
    }


def _keeps(leaf: Leaf, column: Column) -> Flags:
    keeps: Flags = np.isfinite(column)
    for bound in leaf.bounds:
        low, high = (bound.value, column) if bound.side < 0 else (column, bound.value)
        keeps &= (low < high) if bound.is_exclusive else (low <= high)
    if leaf.is_integer:
        keeps &= column == np.round(column)
    if "enum" in leaf.schema:
        keeps &= np.isin(column, leaf.schema["enum"])
    return keeps


def alike(keys: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return one row (u,) of each kind among keys (n, k), and the kind (n,) of every row.

    Two rows are of one kind where all their numbers agree to KEY_DIGITS digits, or nearly so.
    """
    order = np.lexsort(_rounded(keys).T)
    ordered = _rounded(keys)[order]
    starts = np.ones(len(keys), bool)
    starts[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    kind = np.zeros(len(keys), np.intp)
    kind[order] = np.cumsum(starts) - 1
    return order[starts], kind


def _rounded(keys: Floats) -> Floats:
    share, exponent = np.frexp(keys)
    grid = 10.0**KEY_DIGITS
    rounded: Floats = np.ldexp(np.round(share * grid) / grid, exponent)
    return rounded + 0.0
