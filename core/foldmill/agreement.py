"""Does the batch of a design say of each configuration what generate and check say of it?"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

import numpy as np

from foldmill.batch import Column, Outcome, Outcomes
from foldmill.configurations import one_by_one, outcomes
from foldmill.design import Design, Params
from foldmill.errors import BrokenBatch, InvalidParameters
from foldmill.schema import Leaf, inside, leaves, outside
from foldmill.tolerances import FIGURE

ROUNDS = 4
"""How many sets of columns are tried for each base, each of one to three parameters."""
ROWS = 4
"""Rows in a set; each is generated and checked, which takes about 10 ms. One is at a bound of one
of the parameters, or just beyond it."""


def require(design: Design[Any], base: Params, seed: str) -> None:
    """Raise AssertionError with the first two of ``faults``, where there are any."""
    said = list(islice(faults(design, base, seed), 2))
    if said:
        raise AssertionError(" ".join(said))


def faults(design: Design[Any], base: Params, seed: str) -> Iterator[str]:
    """Yield a sentence for each row of a seeded sample where batch and generate differ.

    The same design, base and seed give the same sample. Nothing where the design has no batch.
    """
    if design.batch is None:
        return
    for columns in _samples(design, base, random.Random(seed)):
        true = one_by_one(design, base, columns)
        try:
            found = outcomes(design, base, columns)
        except BrokenBatch as error:
            yield str(error)
            return
        for row in range(len(true)):
            said = _row_fault(found, true, row)
            if said:
                where = ", ".join(f"{name} = {column[row]:g}" for name, column in columns.items())
                yield f"With {where} {said}."
    try:
        design.batch(base, {"no-such-parameter": np.zeros(1)})
    except InvalidParameters:
        return
    yield "It takes a column of a parameter that does not exist; it must raise InvalidParameters."


def _row_fault(found: Outcomes, true: Outcomes, row: int) -> str:
    codes = [Outcome(each.codes[row]).name for each in (found, true)]
    points = [int(each.at[row]) for each in (found, true)]
    if codes[0] != codes[1]:
        return f"the batch says {codes[0]}, generate and check say {codes[1]}"
    if points[0] != points[1]:
        return f"the batch names point {points[0]}, generate names point {points[1]}"
    for name in sorted({*found.figures, *true.figures}):
        one, two = (_figure(each.figures, name, row) for each in (found, true))
        if not np.isclose(one, two, rtol=FIGURE, atol=FIGURE, equal_nan=True):
            return f"the batch says {name} = {one:.12g}, generate says {two:.12g}"
    return ""


def _figure(figures: Mapping[str, Column], name: str, row: int) -> float:
    return float(figures[name][row]) if name in figures else float("nan")


def _samples(
    design: Design[Any], base: Params, chance: random.Random
) -> Iterator[dict[str, Column]]:
    values = base.model_dump(mode="json")
    numbers = {leaf.name: leaf for leaf in leaves(design.schema(), values) if _is_varied(leaf)}
    for _ in range(ROUNDS if numbers else 0):
        names = chance.sample(sorted(numbers), min(len(numbers), chance.randint(1, 3)))
        columns = {
            name: np.array(
                [_near(numbers[name], _value(values, name), chance) for _ in range(ROWS)]
            )
            for name in names
        }
        bounded = [name for name in names if numbers[name].bounds]
        if bounded:
            name = chance.choice(bounded)
            columns[name][0] = _at_end(numbers[name], chance)
        yield columns


def _is_varied(leaf: Leaf) -> bool:
    return leaf.is_number or (leaf.schema.get("type") == "integer" and "enum" in leaf.schema)


def _value(values: Any, name: str) -> float:
    for part in name.split("."):
        values = values[int(part) if isinstance(values, list) else _key(values, part)]
    return float(values or 0)


def _key(values: Mapping[Any, Any], part: str) -> Any:
    return next(key for key in values if str(key) == part)


def _near(leaf: Leaf, value: float, chance: random.Random) -> float:
    """Return a number near the base's own, or one of a few choices."""
    if "enum" in leaf.schema:
        return float(chance.choice(leaf.schema["enum"]))
    reach = max(abs(value) * 0.3, 5.0)
    near = value + chance.uniform(-reach, reach)
    return float(round(near)) if leaf.is_integer else near


def _at_end(leaf: Leaf, chance: random.Random) -> float:
    """Return the number nearest to a bound that is allowed, or that is not."""
    end = chance.choice(leaf.bounds)
    return float(chance.choice((inside, outside))(end, leaf.is_integer))
