"""HP-GL programs, one per set-up or per face, in the dialect of the plan's machine.

Millimetres become steps in the last function before the bytes (``steps``), rounded once. No LT and
no LB: dashes are real strokes and words stay on the job sheet. Where the machine does not make up
for a blade's offset, the program leads the holder so that the tip goes where the plan says.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from foldmill import Fold
from foldmill_fabricate.formats import programs
from foldmill_fabricate.formats.programs import half_away, in_units, layout, steps
from foldmill_fabricate.machines import Dialect
from foldmill_fabricate.passes import Face, Fit, Plan, SetUp

__all__ = ["force", "half_away", "layout", "program", "speed", "steps", "whole_grams", "write"]


def write(plan: Plan, fold: Fold) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return every program of the plan by file name.

    Raises CannotPlan for a machine that speaks another language, DoesNotFit as ``program`` does.
    """
    return programs.write(plan, "hpgl", program)


def program(plan: Plan, numbers: Sequence[int], fit: Fit | None = None) -> bytes:
    """Return one program that runs the set-ups of these numbers, in the plan's order.

    fit : how the flipped sheet really lies; moves the reverse only.
    Raises UnknownName for a number that is not in the plan, DoesNotFit (with the missing mm) where
    the machine's coordinates end.
    """
    body = [
        instruction
        for face, setup in programs.chosen(plan, numbers)
        for instruction in _setup(plan, face, setup, fit)
    ]
    dialect = plan.machine.dialect
    lines = [dialect.preamble, *body, dialect.trailer, ""]
    return dialect.line_end.join(lines).encode("ascii")


def speed(setup: SetUp) -> int:
    """Return what VS gets: whole cm/s, at least 1."""
    return in_units(setup.speed, 10)


def force(setup: SetUp) -> int:
    """Return what FS gets: whole gf, at least 1."""
    return whole_grams(setup.force)


def whole_grams(force: float) -> int:
    """Round gf for FS: whole, at least 1."""
    return in_units(force, 1)


def _setup(plan: Plan, face: Face, setup: SetUp, fit: Fit | None) -> Iterator[str]:
    dialect = plan.machine.dialect
    yield "PU;"  # before SP: else machines dot the start of the next path
    if setup.tool:
        yield f"SP{setup.tool};"
    yield from _speed_and_force(setup, dialect)
    ways = programs.ways(plan, face, setup, fit)
    pairs = ways.pairs()
    up = "PU;" + dialect.line_end + "PA%s;" if dialect.lifts_apart else "PU%s;"
    limit = dialect.max_instruction - len(dialect.line_end)
    was_light = False
    for begin, end, light in ways:
        if light is not was_light:
            was_light = light
            yield "PU;"
            yield f"FS{whole_grams(setup.swivel_force) if light else force(setup)};"
        yield up % pairs[begin]
        yield from _pen_down(pairs[begin + 1 : end], limit)


def _speed_and_force(setup: SetUp, dialect: Dialect) -> Iterator[str]:
    if dialect.speed:
        yield f"VS{speed(setup)};"
    if dialect.force:
        yield f"FS{force(setup)};"


def _pen_down(pairs: Sequence[str], limit: int) -> Iterator[str]:
    """Yield PD instructions of at most ``limit`` bytes; one that goes on does not lift."""
    whole = f"PD{','.join(pairs)};"
    if len(whole) <= limit:
        yield whole
        return
    line = ""
    for pair in pairs:
        if line and len(line) + len(pair) + 2 > limit:
            yield f"{line};"
            line = ""
        line = f"{line},{pair}" if line else f"PD{pair}"
    yield f"{line};"
