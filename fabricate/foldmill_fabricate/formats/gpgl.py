"""GP-GL programs, as desktop cutters of the Silhouette and Graphtec kind read them.

Each command ends with ETX. ``J`` takes a tool, ``!`` a speed and ``FX`` a force in the machine's
own units, ``FC`` tells the offset of a blade that the machine makes up for, ``M`` goes with the
tool up and ``D`` draws; ``H`` lifts and goes home. Handshakes, with ESC EOT, are the session's.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from foldmill import Fold
from foldmill_fabricate.formats import programs
from foldmill_fabricate.formats.programs import half_away, in_units
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Fit, Plan, SetUp

ETX = "\x03"
UNBLADED = frozenset({"pen", "stylus"})
"""Processes whose tools draw right under the holder's axis, where other tools trail it."""


def write(plan: Plan, fold: Fold) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return every program of the plan by file name.

    Raises CannotPlan for a machine that speaks another language, DoesNotFit as ``program`` does.
    """
    return programs.write(plan, "gp-gl", program)


def program(plan: Plan, numbers: Sequence[int], fit: Fit | None = None) -> bytes:
    """Return one program that runs the set-ups of these numbers, in the plan's order.

    fit : how the flipped sheet really lies; moves the reverse only.
    Raises UnknownName for a number that is not in the plan, DoesNotFit (with the missing mm) where
    the machine's coordinates end.
    """
    commands = [
        command
        for face, setup in programs.chosen(plan, numbers)
        for command in _setup(plan, face, setup, fit)
    ]
    return ETX.join([*commands, "H", ""]).encode("ascii")


def _setup(plan: Plan, face: Face, setup: SetUp, fit: Fit | None) -> Iterator[str]:
    tools = plan.machine.tools
    if setup.tool:
        yield f"J{setup.tool}"
    yield f"!{in_units(setup.speed, tools.speed_unit)}"
    heavy = f"FX{in_units(setup.force, tools.force_unit)}"
    yield heavy
    yield f"FC{offset(plan, setup)}"
    ways = programs.ways(plan, face, setup, fit)
    pairs = ways.pairs()
    was_light = False
    for begin, end, light in ways:
        yield f"M{pairs[begin]}"  # with the tool up a new force harms nothing
        if light is not was_light:
            was_light = light
            yield f"FX{in_units(setup.swivel_force, tools.force_unit)}" if light else heavy
        yield from _drawn(pairs[begin + 1 : end], plan.machine)
    if pairs:
        yield f"M{pairs[-1]}"  # lifts: D leaves the tool where it is


def offset(plan: Plan, setup: SetUp) -> int:
    """Return what FC gets, steps: 0 where the program itself makes up for it, or nothing trails."""
    machine = plan.machine
    process = plan.material.score if setup.process == "score" else plan.material.cut
    trails = machine.tools.trails and process.kind not in UNBLADED
    if not (trails and machine.tools.firmware_offset):
        return 0
    return int(half_away(machine.tools.blade_offset * machine.axes.units_per_mm))


def _drawn(pairs: Sequence[str], machine: Machine) -> Iterator[str]:
    """Yield D commands; one that goes on does not lift."""
    whole = f"D{','.join(pairs)}"
    most = machine.dialect.max_instruction - len(ETX)
    if len(whole) <= most:
        yield whole
        return
    line = ""
    for pair in pairs:
        if line and len(line) + len(pair) + 1 > most:
            yield line
            line = ""
        line = f"{line},{pair}" if line else f"D{pair}"
    yield line
