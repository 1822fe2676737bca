"""Proof that a program only moves, its tool up, and stays within what the machine can reach."""

from __future__ import annotations

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.verify.gcode import interpret as gcode
from foldmill_fabricate.verify.interpreter import Trace, interpret
from foldmill_fabricate.verify.virtual_sheet import on_carrier


def prove_pen_up(data: bytes, machine: Machine) -> tuple[Finding, ...]:
    """Return what is wrong with a program that is to move only; nothing is sent where it is not ().

    HP-GL that is sent behind another program has no IN of its own; one is put in front here.
    """
    trace = _traced(data, machine)
    found = list(trace.findings)
    if trace.runs:
        found.append(_error("pen-down", "It lowers the tool."))
    steps, axes = trace.visited, machine.axes
    if len(steps) and (steps.min() < axes.lowest or steps.max() > axes.highest):
        found.append(_error("outside-range", "It leaves the range that the firmware takes."))
    left, lead, right, trail = machine.bed.margins
    high = np.array([machine.bed.width - right, machine.bed.length - trail])
    half = 0.5 / axes.units_per_mm
    carrier = on_carrier(steps, axes)
    beyond = (carrier < np.array([left, lead]) - half) | (carrier > high + half)
    if beyond.any():
        x, y = carrier[int(np.argmax(beyond.any(axis=1)))]
        found.append(_error("outside-bed", f"({x:.2f}, {y:.2f}) mm is beyond its margins."))
    return tuple(found)


def _traced(data: bytes, machine: Machine) -> Trace:
    if machine.language == "gcode":
        return gcode(data, "move", machine)
    begun = data if b"IN;" in data else b"IN;" + data
    return interpret(begun, "move", selects=False)


def _error(code: str, text: str) -> Finding:
    return Finding(code, Severity.ERROR, "move", text, "Nothing is sent.")
