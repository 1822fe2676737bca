"""How much work a plan is: strokes, travel and its lower bound, time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Figures, Flip, Pass, SetUp, Sheet
from foldmill_fabricate.sheet import flipped, on_carrier
from foldmill_fabricate.toolpath import motion, order
from foldmill_fabricate.toolpath.bounds import travel_bound
from foldmill_fabricate.toolpath.ways import ways

Floats = NDArray[np.float64]


def measure(passes: tuple[Pass, ...], machine: Machine, sheet: Sheet, flip: Flip) -> Figures:
    """Return the figures of the whole job, the tool starting in the carrier's corner."""
    at = np.zeros(2)
    drawn = travel = bound = seconds = 0.0
    strokes = lifts = 0
    for one_pass in passes:
        for setup in one_pass.setups:
            paths = _paths(one_pass.face, setup, machine, sheet, flip)
            strokes += sum(len(operation.strokes) for operation in setup.operations)
            lifts += len(paths)
            drawn += sum(float(np.hypot(*(path[1:] - path[:-1]).T).sum()) for path in paths)
            travel += order.travel(paths, at)
            bound += _bound(one_pass.face, setup, at, sheet, flip)
            seconds += _seconds(paths, at, setup, machine)
            at = paths[-1][-1] if paths else at
    return Figures(
        strokes=strokes,
        lifts=lifts,
        drawn=round(drawn, 3),
        travel=round(travel, 3),
        travel_bound=round(bound, 3),
        seconds=round(seconds + _put_away(passes, machine), 1),
    )


def _bound(face: Face, setup: SetUp, at: Floats, sheet: Sheet, flip: Flip) -> float:
    """Return the travel, mm, that no order of the set-up's strokes goes below."""
    strokes = [(s, operation) for operation in setup.operations for s in operation.strokes]
    lines = [_seen(np.array(stroke.points), face, sheet, flip) for stroke, _ in strokes]
    returns = [operation.repeats % 2 == 0 and not stroke.closed for stroke, operation in strokes]
    return travel_bound(lines, at, returns)


def _paths(face: Face, setup: SetUp, machine: Machine, sheet: Sheet, flip: Flip) -> list[Floats]:
    """Return what the machine is told: repeats, overcut, lead-in and swivels included."""
    told = ways(setup, machine, lambda points: _seen(np.asarray(points), face, sheet, flip))
    return [way.points for way in told]


def _seen(points: Floats, face: Face, sheet: Sheet, flip: Flip) -> Floats:
    return on_carrier(flipped(points, flip) if face is Face.REVERSE else points, sheet)


def _seconds(paths: list[Floats], at: Floats, setup: SetUp, machine: Machine) -> float:
    model = machine.motion
    speed = motion.told_speed(setup.speed, machine)
    total = model.tool_time if setup.tool else 0.0
    if not paths:
        return total
    begins, leaves = np.array([path[0] for path in paths]), [at, *(path[-1] for path in paths[:-1])]
    hops = np.hypot(*(begins - np.array(leaves)).T)
    total += float(motion.move_seconds(hops, model.travel_speed, model.acceleration).sum())
    total += 2 * model.lift_time * len(paths)
    return total + sum(motion.path_seconds(path, speed, model) for path in paths)


def _put_away(passes: tuple[Pass, ...], machine: Machine) -> float:
    """Return the time in which each program puts its last tool away at its end."""
    by_hand = machine.tools.change == "operator"
    last = [setup for work in passes for setup in (work.setups if by_hand else work.setups[-1:])]
    return machine.motion.tool_time * sum(setup.tool != 0 for setup in last)
