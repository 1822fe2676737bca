"""What writers of programs share: which file holds which set-up, and the tool's ways in steps.

Millimetres become steps in ``steps``, rounded once; what follows only spells whole numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill import UnknownName
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.machines import Axes, Machine
from foldmill_fabricate.passes import Face, Fit, Plan, SetUp
from foldmill_fabricate.sheet import in_steps, seen_by_machine
from foldmill_fabricate.toolpath.ways import joined

Steps = NDArray[np.int64]

SUFFIXES: Mapping[str, str] = {"hpgl": ".hpgl", "gp-gl": ".gpgl", "gcode": ".nc"}
"""What the names of programs end with, by language."""


class Part(NamedTuple):
    """One program file: its name, the face it works on, and the numbers of its set-ups."""

    name: str
    face: Face
    setups: tuple[int, ...]


class Ways(NamedTuple):
    """The tool's ways in one set-up, one behind the other."""

    steps: Steps
    """(n, 2); no point of a way is the one before it."""
    ends: list[int]
    """(k + 1) where each way begins and the last one ends; each has at least two points."""
    light: list[bool]
    """(k) whether the blade only rests on the sheet, to be turned."""
    strokes: list[int]
    """(k) which stroke of the set-up each is part of, counted over its operations; -1 for none."""

    def pairs(self) -> list[str]:
        """Return every point as two numbers with a comma between them."""
        # by columns: a list for each point would keep the garbage collector busy
        x, y = self.steps.T.tolist()
        return [f"{a},{b}" for a, b in zip(x, y, strict=True)]

    def __iter__(self) -> Iterator[tuple[int, int, bool]]:  # type: ignore[override]
        """Yield of each way where it begins, where it ends and whether it is light."""
        return zip(self.ends[:-1], self.ends[1:], self.light, strict=True)


def layout(plan: Plan) -> list[Part]:
    """Return the program files of a plan, in order of work; none in a language nobody here writes.

    Where an operator changes the tool each set-up is a file of its own, such as
    ``1-front-holes.hpgl``; where the program selects tools there is one file per face.
    """
    suffix = SUFFIXES.get(plan.machine.language)
    if suffix is None:
        return []
    if plan.machine.tools.change == "operator":
        return [
            Part(f"{setup.number}-{setup.name}{suffix}", work.face, (setup.number,))
            for work in plan.passes
            for setup in work.setups
        ]
    return [
        Part(f"{work.face}{suffix}", work.face, tuple(setup.number for setup in work.setups))
        for work in plan.passes
    ]


def write(
    plan: Plan, language: str, program: Callable[[Plan, Sequence[int]], bytes]
) -> dict[str, bytes]:
    """Return every program of the plan by file name.

    Raises CannotPlan for a machine that speaks another language.
    """
    if plan.machine.language != language:
        raise CannotPlan(
            f"{plan.machine.slug} speaks {plan.machine.language}, so a program in {language} is "
            f"nothing to it. Plan with --to svg,dxf,{plan.machine.language}."
        )
    return {part.name: program(plan, part.setups) for part in layout(plan)}


def chosen(plan: Plan, numbers: Sequence[int]) -> list[tuple[Face, SetUp]]:
    """Return the set-ups of these numbers with their faces, in the plan's order.

    Raises UnknownName for a number that is not in the plan.
    """
    known = {setup.number: (work.face, setup) for work in plan.passes for setup in work.setups}
    for number in numbers:
        if number not in known:
            raise UnknownName.of("set-up", str(number), known)
    return [found for number, found in known.items() if number in numbers]


def ways(plan: Plan, face: Face, setup: SetUp, fit: Fit | None) -> Ways:
    """Return the ways of a set-up in steps; what is shorter than a step has nothing to draw.

    Raises DoesNotFit as ``steps`` does.
    """
    points, counts, light, strokes = joined(
        setup, plan.machine, lambda places: seen_by_machine(plan, face, places, fit)
    )
    if not len(points):
        return Ways(np.zeros((0, 2), np.int64), [0], [], [])
    found = steps(points, plan.machine.axes, f'Set-up {setup.number} "{setup.name}"')
    way = np.repeat(np.arange(len(counts)), counts)
    moved = np.ones(len(found), bool)
    moved[1:] = (found[1:] != found[:-1]).any(axis=1) | (way[1:] != way[:-1])
    kept = np.bincount(way[moved], minlength=len(counts))
    real = kept > 1
    ends = np.concatenate([[0], np.cumsum(kept[real])])
    return Ways(
        found[moved & real[way]], ends.tolist(), light[real].tolist(), strokes[real].tolist()
    )


def steps(points: ArrayLike, axes: Axes, where: str) -> Steps:
    """Turn carrier coordinates (n, 2) mm into machine steps (n, 2), calibrated for the machine.

    Raises DoesNotFit, naming ``where`` and the missing mm, outside the range the firmware takes.
    """
    found = half_away(in_steps(points, axes))
    short = max(int(axes.lowest - found.min()), int(found.max() - axes.highest))
    if short > 0:
        low, high = axes.lowest / axes.units_per_mm, axes.highest / axes.units_per_mm
        raise DoesNotFit(
            f"{where} runs {short / axes.units_per_mm:.3f} mm out of the range that the machine "
            f"accepts, {low:g} to {high:g} mm. Move the blank on its carrier, or use a smaller one."
        )
    return found


def half_away(values: ArrayLike) -> Steps:
    """Round to whole numbers, halves away from zero, as every plotter's manual counts."""
    given = np.asarray(values, float)
    whole = np.floor(np.abs(given))
    rounded = whole + (np.abs(given) - whole >= 0.5)
    signed: Steps = (np.sign(given) * rounded).astype(np.int64)
    return signed


def in_units(value: float, unit: float) -> int:
    """Return a setting in a machine's own units: whole, at least 1."""
    return max(1, int(half_away(value / unit)))


def sinks(machine: Machine, setup: SetUp) -> float:
    """Return how deep a machine without force lowers its tool into the sheet, mm."""
    return setup.exposure or machine.gcode.press
