"""The corners of a design's parameters: each number at its bounds, alone and with the others.

Where a careless design breaks, it breaks there.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

from foldmill.design import Design
from foldmill.schema import Leaf, inside, leaves, placed

JOINT = 12
"""How many corners are tried where several numbers are at their bounds at once."""
SEED = 20


def numbers(design: Design[Any]) -> Iterator[tuple[dict[str, Any], Leaf]]:
    """Yield every kind of number among the parameters once, with values that hold one of it."""
    seen: set[str] = set()
    for params in [design.params(), *design.presets.values()]:
        whole = params.model_dump(mode="json")
        for leaf in leaves(design.schema(), whole):
            if leaf.is_number and leaf.kind not in seen:
                seen.add(leaf.kind)
                yield whole, leaf


def corners(design: Design[Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield what is set ("n = 72, phi = 0") and the values, of single and of joint corners.

    The same design gives the same corners.
    """
    for whole, leaf in numbers(design):
        for value in _ends(leaf):
            yield f"{leaf.name} = {value!r}", placed(whole, leaf.path, value)
    chance = random.Random(SEED)
    values = design.params().model_dump(mode="json")
    bounded = [leaf for leaf in leaves(design.schema(), values) if _ends(leaf)]
    for _ in range(JOINT if len(bounded) > 1 else 0):
        yield _joint(values, bounded, chance)


def _joint(
    values: dict[str, Any], bounded: list[Leaf], chance: random.Random
) -> tuple[str, dict[str, Any]]:
    chosen = chance.sample(bounded, min(len(bounded), chance.randint(2, 4)))
    said = []
    for leaf in chosen:
        value = chance.choice(_ends(leaf))
        values = placed(values, leaf.path, value)
        said.append(f"{leaf.name} = {value!r}")
    return ", ".join(said), values


def _ends(leaf: Leaf) -> list[float]:
    return [inside(bound, leaf.is_integer) for bound in leaf.bounds] if leaf.is_number else []
