"""Which parameters must not move alone: those whose smallest step makes the form jump.

A flat seat, two circles that are one, a flap flush with a wall: such forms exist only where some of
their parameters are in exact proportion. One after another is moved by a hair. Where the form jumps
or ceases to be, lengths are tied together, and the others are held. What changes nothing is held
as well.
"""

from __future__ import annotations

from copy import deepcopy
from math import cos, isclose, pi
from typing import Any

from foldmill import Design, Fold, InvalidInput
from foldmill.schema import Leaf
from foldmill_fabricate.explore.search.frame import Values, Variable, put, value_of, variable
from foldmill_fabricate.explore.search.shape import Shape

HAIR = 1e-6
"""The step, as a share of the value."""
JUMP = 1e-2
"""Share of the sheet that a point moves in a jump: ten times what a step could do where it is felt
as its square root."""
IDLE = 1e-12
"""Share of the sheet below which nothing moved."""
POWERS = (-2, -1, 1, 2)
"""Tied lengths in the ratio of these powers of cos(180°/N) keep that law with another N."""

LEAST_ORDER = 3


def variables(design: Design[Any], values: Values, among: list[Leaf]) -> tuple[Variable, ...]:
    """Return the variables of a start; raises InvalidInput where the start itself does not fold."""
    fold = design.run(values)
    size = fold.pattern.size
    here, loose, tied = Shape.of(fold), [], []
    for leaf in among:
        moved = _moved(design, values, [leaf], here)
        if moved > JUMP and leaf.unit == "mm":
            tied.append(leaf)
        elif IDLE < moved <= JUMP:
            loose.append(leaf)
    groups = [[leaf] for leaf in loose]
    if tied and _moved(design, values, tied, here) <= JUMP:
        groups.append(tied)
    return tuple(variable(group, values, size) for group in groups)


def with_order(values: Values, tied: tuple[str, ...], name: str, order: int) -> Values:
    """Return parameters for another number N of wedges; tied lengths keep their law.

    Of fewer than three wedges there is no law: then the number alone is to be refused.
    """
    new, before = deepcopy(values), int(value_of(values, name))
    put(new, name, order)
    if not tied or order < LEAST_ORDER:
        return new
    first = float(value_of(values, tied[0]))
    for other in tied[1:]:
        ratio = float(value_of(values, other)) / first
        for power in POWERS:
            if isclose(ratio, cos(pi / before) ** power, rel_tol=1e-9):
                put(new, other, first * cos(pi / order) ** power)
    return new


def _moved(design: Design[Any], values: Values, leaves: list[Leaf], here: Shape) -> float:
    """Return how far the form moves when the leaves grow by a hair, or else shrink by one."""
    for step in (HAIR, -HAIR):
        near = deepcopy(values)
        for leaf in leaves:
            value = float(value_of(values, leaf.name))
            put(near, leaf.name, value * (1 + step) if value else step)
        try:
            fold: Fold = design.run(near)
        except InvalidInput:
            continue
        return Shape.of(fold).farthest(here)
    return float("inf")
