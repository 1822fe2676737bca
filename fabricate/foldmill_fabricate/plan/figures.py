"""How much work a plan is: strokes, travel and its lower bound, time."""

from __future__ import annotations

from math import fsum

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Figures, Flip, Pass, SetUp, Sheet
from foldmill_fabricate.sheet import flipped, on_carrier
from foldmill_fabricate.toolpath import motion, order
from foldmill_fabricate.toolpath.bounds import travel_bound
from foldmill_fabricate.toolpath.line import waiting
from foldmill_fabricate.toolpath.ways import stroke_ways, ways

Floats = NDArray[np.float64]


def measure(
    passes: tuple[Pass, ...], machine: Machine, sheet: Sheet, flip: Flip, *, bounded: bool = True
) -> Figures:
    """Return the figures of the whole job, the tool starting in the carrier's corner.

    bounded : whether to look for the travel that no order goes below; it takes longest.
    """
    at = np.zeros(2)
    drawn = travel = bound = seconds = 0.0
    strokes = lifts = 0
    programs: dict[object, list[tuple[list[Floats], Floats]]] = {}
    for one_pass in passes:
        for setup in one_pass.setups:
            paths = _paths(one_pass.face, setup, machine, sheet, flip)
            strokes += sum(len(operation.strokes) for operation in setup.operations)
            lifts += len(paths)
            drawn += sum(float(np.hypot(*(path[1:] - path[:-1]).T).sum()) for path in paths)
            travel += order.travel(paths, at)
            bound += _bound(one_pass.face, setup, at, machine, sheet, flip) if bounded else 0.0
            times = _times(paths, at, setup, machine)
            seconds += float(times.sum()) + (machine.motion.tool_time if setup.tool else 0.0)
            by_hand = machine.tools.change == "operator"
            programs.setdefault(setup.number if by_hand else one_pass.face, []).append(
                (paths, times)
            )
            at = paths[-1][-1] if paths else at
    waits = [_waiting(parts, machine) for parts in programs.values()]
    return Figures(
        strokes=strokes,
        lifts=lifts,
        drawn=round(drawn, 3),
        travel=round(travel, 3),
        travel_bound=round(bound, 3),
        seconds=round(seconds + fsum(waits) + _put_away(passes, machine), 1),
    )


def _bound(
    face: Face, setup: SetUp, at: Floats | None, machine: Machine, sheet: Sheet, flip: Flip
) -> float:
    """Return the travel, mm, that no order of the set-up's strokes goes below."""
    if machine.bed.pull:
        return _pulled_bound(face, setup, at, machine, sheet, flip)
    found = 0.0
    for operation in setup.operations:  # in this order, whatever the order within each
        lines = [_seen(np.array(each.points), face, sheet, flip) for each in operation.strokes]
        returns = [operation.repeats % 2 == 0 and not each.closed for each in operation.strokes]
        found += travel_bound(lines, at, returns)
        at = None
    return found


def _pulled_bound(
    face: Face, setup: SetUp, at: Floats | None, machine: Machine, sheet: Sheet, flip: Flip
) -> float:
    """Return that bound where strokes may only be pulled: within each, travel is as it is."""
    own, lines = 0.0, []
    for operation in setup.operations:
        for stroke in operation.strokes:
            parts = stroke_ways(
                stroke,
                operation,
                machine,
                lambda points: _seen(np.asarray(points), face, sheet, flip),
            )
            own += order.travel(parts, parts[0][0])
            lines.append(np.array([parts[0][0], parts[-1][-1]]))
    return own + travel_bound(lines, at)


def _paths(face: Face, setup: SetUp, machine: Machine, sheet: Sheet, flip: Flip) -> list[Floats]:
    """Return what the machine is told: repeats, overcut, lead-in and swivels included."""
    told = ways(setup, machine, lambda points: _seen(np.asarray(points), face, sheet, flip))
    return [way.points for way in told]


def _seen(points: Floats, face: Face, sheet: Sheet, flip: Flip) -> Floats:
    return on_carrier(flipped(points, flip) if face is Face.REVERSE else points, sheet)


def _times(paths: list[Floats], at: Floats, setup: SetUp, machine: Machine) -> Floats:
    """Return how long the tool takes (n, 2) to each path and along it, up and down included, s."""
    if not paths:
        return np.zeros((0, 2))
    model = machine.motion
    speed = motion.told_speed(setup.speed, machine)
    leaves = np.array([at, *(path[-1] for path in paths[:-1])])
    hops = np.hypot(*(np.array([path[0] for path in paths]) - leaves).T)
    travel = motion.move_seconds(hops, model.travel_speed, model.acceleration)
    drawing = [motion.path_seconds(path, speed, model) for path in paths]
    return np.column_stack([travel, drawing]) + model.lift_time


def _waiting(parts: list[tuple[list[Floats], Floats]], machine: Machine) -> float:
    """Return for how long the machine waits for its line in one program, s."""
    paths = [path for own, _ in parts for path in own]
    return waiting(paths, np.vstack([times for _, times in parts]), machine)


def _put_away(passes: tuple[Pass, ...], machine: Machine) -> float:
    """Return the time in which each program puts its last tool away at its end."""
    by_hand = machine.tools.change == "operator"
    last = [setup for work in passes for setup in (work.setups if by_hand else work.setups[-1:])]
    return machine.motion.tool_time * sum(setup.tool != 0 for setup in last)
