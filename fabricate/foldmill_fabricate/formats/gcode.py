"""G-code for GRBL: a knife that is lowered by Z, or a beam that is switched on.

Lines end with a line feed; places are absolute, mm, and fall on the machine's own steps. A tool is
up (``G0`` to the clear height) or the beam off (``M5``) before every travel, so that a program that
is broken off leaves no line behind it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import ceil, log10

import numpy as np

from foldmill import Fold
from foldmill_fabricate.formats import programs
from foldmill_fabricate.machines import Gcode, Machine
from foldmill_fabricate.passes import Face, Fit, Plan, SetUp


def write(plan: Plan, fold: Fold) -> Mapping[str, bytes]:  # noqa: ARG001 - every format is given both
    """Return every program of the plan by file name.

    Raises CannotPlan for a machine that speaks another language, DoesNotFit as ``program`` does.
    """
    return programs.write(plan, "gcode", program)


def program(plan: Plan, numbers: Sequence[int], fit: Fit | None = None) -> bytes:
    """Return one program that runs the set-ups of these numbers, in the plan's order.

    fit : how the flipped sheet really lies; moves the reverse only.
    Raises UnknownName for a number that is not in the plan, DoesNotFit (with the missing mm) where
    the machine's coordinates end.
    """
    lines = ["G21G90G94", _off(plan.machine.gcode)]
    for face, setup in programs.chosen(plan, numbers):
        lines += _setup(plan, face, setup, fit)
    return "\n".join([*lines, "M2", ""]).encode("ascii")


def travel(step: tuple[int, int], machine: Machine) -> bytes:
    """Return the lines that go to a place, machine steps, with the tool up or the beam off."""
    (place,) = _places(np.array([step]), machine.axes.units_per_mm)
    return "\n".join(["G21G90G94", _off(machine.gcode), f"G0{place}", ""]).encode("ascii")


def feed(speed: float) -> str:
    """Return mm/s as an F word: whole mm/min, at least 1."""
    return f"F{programs.in_units(speed, 1 / 60)}"


def number(value: float, decimals: int) -> str:
    """Return a coordinate without trailing zeros and without a negative zero."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}".rstrip("0").rstrip(".")


def _setup(plan: Plan, face: Face, setup: SetUp, fit: Fit | None) -> Iterator[str]:
    if setup.tool:
        yield f"T{setup.tool}"
    ways = programs.ways(plan, face, setup, fit)
    places = _places(ways.steps, plan.machine.axes.units_per_mm)
    on, off, speed = _on(plan, setup), _off(plan.machine.gcode), feed(setup.speed)
    for begin, end, _ in ways:
        yield f"G0{places[begin]}"
        yield on
        yield f"G1{places[begin + 1]}{speed}"
        for place in places[begin + 2 : end]:
            yield f"G1{place}"
        yield off


def _places(steps: programs.Steps, units_per_mm: float) -> list[str]:
    """Return the X and Y words of steps (n, 2), with digits enough to hit each of them."""
    decimals = max(3, ceil(log10(units_per_mm)) + 2)
    words = {step: number(step / units_per_mm, decimals) for step in set(steps.ravel().tolist())}
    x, y = steps.T.tolist()  # by columns: a list for each point would be garbage to collect
    return [f"X{words[a]}Y{words[b]}" for a, b in zip(x, y, strict=True)]


def _on(plan: Plan, setup: SetUp) -> str:
    """Return the line that brings the tool into the sheet."""
    gcode = plan.machine.gcode
    if gcode.lowers == "z":
        depth = programs.sinks(plan.machine, setup)
        return f"G1Z{number(-depth, 4)}{feed(gcode.plunge_speed)}"
    if setup.process == "score":
        return f"M4S{gcode.score_power}"
    return f"M3S{gcode.cut_power}"


def _off(gcode: Gcode) -> str:
    return f"G0Z{number(gcode.clear, 4)}" if gcode.lowers == "z" else "M5"
