"""HP-GL programs, one per set-up or per face, in the dialect of the plan's machine.

Millimetres become steps in the last function before the bytes (``steps``), rounded once. No LT and
no LB: dashes are real strokes and words stay on the job sheet. Where the machine does not make up
for a blade's offset, the program leads the holder so that the tip goes where the plan says.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill import Fold, UnknownName
from foldmill_fabricate.errors import CannotPlan, DoesNotFit
from foldmill_fabricate.machines import Axes, Dialect
from foldmill_fabricate.passes import Face, Fit, Plan, SetUp
from foldmill_fabricate.sheet import in_steps, seen_by_machine
from foldmill_fabricate.toolpath.ways import ways

Steps = NDArray[np.int64]


class Part(NamedTuple):
    """One program file: its name, the face it works on, and the numbers of its set-ups."""

    name: str
    face: Face
    setups: tuple[int, ...]


def layout(plan: Plan) -> list[Part]:
    """Return the program files of a plan, in order of work.

    Where an operator changes the tool each set-up is a file of its own, such as
    ``1-front-holes.hpgl``; where SP selects tools there is one file per face.
    """
    if plan.machine.tools.change == "operator":
        return [
            Part(f"{setup.number}-{setup.name}.hpgl", work.face, (setup.number,))
            for work in plan.passes
            for setup in work.setups
        ]
    return [
        Part(f"{work.face}.hpgl", work.face, tuple(setup.number for setup in work.setups))
        for work in plan.passes
    ]


def write(plan: Plan, fold: Fold) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return every program of the plan by file name.

    Raises CannotPlan for a machine that speaks another language, DoesNotFit as ``program`` does.
    """
    if plan.machine.language != "hpgl":
        raise CannotPlan(
            f"{plan.machine.slug} speaks {plan.machine.language}, and programs in that language "
            f"cannot be written yet. Plan with --to svg,dxf and open a drawing in its own software."
        )
    return {part.name: program(plan, part.setups) for part in layout(plan)}


def program(plan: Plan, numbers: Sequence[int], fit: Fit | None = None) -> bytes:
    """Return one program that runs the set-ups of these numbers, in the plan's order.

    fit : how the flipped sheet really lies; moves the reverse only.
    Raises UnknownName for a number that is not in the plan, DoesNotFit (with the missing mm) where
    the machine's coordinates end.
    """
    known = {setup.number: (work.face, setup) for work in plan.passes for setup in work.setups}
    for number in numbers:
        if number not in known:
            raise UnknownName.of("set-up", str(number), known)
    body = [
        instruction
        for number, (face, setup) in known.items()
        if number in numbers
        for instruction in _setup(plan, face, setup, fit)
    ]
    dialect = plan.machine.dialect
    lines = [dialect.preamble, *body, dialect.trailer]
    return "".join(line + dialect.line_end for line in lines).encode("ascii")


def half_away(values: ArrayLike) -> Steps:
    """Round to whole numbers, halves away from zero, as every plotter's manual counts."""
    given = np.asarray(values, float)
    whole = np.floor(np.abs(given))
    rounded = whole + (np.abs(given) - whole >= 0.5)
    signed: Steps = (np.sign(given) * rounded).astype(np.int64)
    return signed


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


def speed(setup: SetUp) -> int:
    """Return what VS gets: whole cm/s, at least 1."""
    return max(1, int(half_away(setup.speed / 10)))


def force(setup: SetUp) -> int:
    """Return what FS gets: whole gf, at least 1."""
    return whole_grams(setup.force)


def whole_grams(force: float) -> int:
    """Round gf for FS: whole, at least 1."""
    return max(1, int(half_away(force)))


def _setup(plan: Plan, face: Face, setup: SetUp, fit: Fit | None) -> Iterator[str]:
    yield "PU;"  # before SP: else machines dot the start of the next path
    if setup.tool:
        yield f"SP{setup.tool};"
    yield from _speed_and_force(setup, plan.machine.dialect)
    where = f'Set-up {setup.number} "{setup.name}"'
    light = False
    for way in ways(setup, plan.machine, lambda points: seen_by_machine(plan, face, points, fit)):
        if way.light is not light:
            light = way.light
            yield "PU;"
            yield f"FS{whole_grams(setup.swivel_force) if light else force(setup)};"
        yield from _stroke(steps(way.points, plan.machine.axes, where), plan.machine.dialect)


def _speed_and_force(setup: SetUp, dialect: Dialect) -> Iterator[str]:
    if dialect.speed:
        yield f"VS{speed(setup)};"
    if dialect.force:
        yield f"FS{force(setup)};"


def _stroke(way: Steps, dialect: Dialect) -> Iterator[str]:
    """Yield one stroke; one that is shorter than a step has nothing to draw."""
    moved = np.ones(len(way), bool)
    moved[1:] = (way[1:] != way[:-1]).any(axis=1)
    start, *onward = (f"{x},{y}" for x, y in way[moved])
    if onward:
        yield f"PU{start};"
        yield from _pen_down(onward, dialect.max_instruction - len(dialect.line_end))


def _pen_down(pairs: Iterable[str], limit: int) -> Iterator[str]:
    """Yield PD instructions of at most ``limit`` bytes; one that goes on does not lift."""
    line = ""
    for pair in pairs:
        if line and len(line) + len(pair) + 2 > limit:
            yield f"{line};"
            line = ""
        line = f"{line},{pair}" if line else f"PD{pair}"
    yield f"{line};"
