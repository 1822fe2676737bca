"""A test cut: a short straight line in the waste, made as a set-up makes its lines.

It is a plan of its own for the same sheet, with one stroke: so it is written and proved as every
other plan, and a blade that programs steer gets its lead-in.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.slits import sewn
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Face, Operation, Pass, Plan, Role, SetUp, Stroke
from foldmill_fabricate.plan import lead_ins
from foldmill_fabricate.plan.registration import Registration, parts
from foldmill_fabricate.sheet import placed

Floats = NDArray[np.float64]

LENGTH = 20.0
"""mm"""
_BESIDE = 3.0
"""mm between test cuts, and from them to what else is cut in the waste: the sheet holds there."""
_GRID = 2.0
"""mm between the places tried."""
_WAYS = np.array([[[0.0, 0.0], [LENGTH, 0.0]], [[0.0, 0.0], [0.0, LENGTH]]])


def trial(plan: Plan, pattern: CreasePattern, face: Face, setup: SetUp, attempt: int = 0) -> Plan:
    """Return the plan of a test cut for a set-up on a face.

    attempt : 0, 1, 2 …; each lies beside those before it, and beside those of the plan's other
    set-ups. Raises CannotPlan where the waste has no room.
    """
    rims = _rims(plan, pattern)
    numbers = [one.number for work in plan.passes for one in work.setups]
    wanted = attempt * len(numbers) + numbers.index(setup.number)
    line = next(islice(_places(plan, rims), wanted, None), None)
    if line is None:
        raise CannotPlan(
            f"There is no room in the waste for a test cut of {LENGTH:g} mm for {setup.name}. Cut "
            "one in a piece of its own, with the coupon of this material."
        )
    return _planned(plan, rims, face, setup, line)


def _rims(plan: Plan, pattern: CreasePattern) -> list[Floats]:
    """Return the outlines (n, 2) of all copies on the sheet, mm."""
    whole = sewn(pattern).pattern
    rim = whole.outline()[0]
    return [placed(whole.vertices, each)[rim] for each in plan.placements]


def _places(plan: Plan, rims: Sequence[Floats]) -> Iterator[Floats]:
    """Yield lines (2, 2) in the waste that keep clear of each other, from the lower left."""
    import shapely

    room = plan.material.part_clearance + _BESIDE
    free = shapely.box(room, room, plan.sheet.width - room, plan.sheet.height - room)
    free = free.difference(shapely.union_all([parts(rims).buffer(room), *_taken(plan, room)]))
    x = np.arange(room, plan.sheet.width, _GRID)
    y = np.arange(room, plan.sheet.height, _GRID)
    spots = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 1, 1, 2)
    ways = (spots + _WAYS).reshape(-1, 2, 2)
    lines = shapely.linestrings(ways)
    shapely.prepare(free)
    open_ways = shapely.contains_properly(free, lines)
    while open_ways.any():
        k = int(np.argmax(open_ways))
        yield ways[k]
        open_ways &= shapely.distance(lines, lines[k]) >= _BESIDE


def _taken(plan: Plan, room: float) -> list[Any]:
    """Return the areas of what else is cut in the waste."""
    import shapely

    setups = [setup for work in plan.passes for setup in work.setups]
    lines = [stroke.points for stroke in _strokes(setups, Role.WITNESS, Role.MARK)]
    lines += [setup.lead_in for setup in setups if setup.lead_in]
    holes = [shapely.Point(h.x, h.y).buffer(h.diameter / 2 + room) for h in plan.holes]
    return [*holes, *(shapely.LineString(line).buffer(room) for line in lines)]


def _strokes(setups: Sequence[SetUp], *roles: Role) -> list[Stroke]:
    return [
        stroke
        for setup in setups
        for operation in setup.operations
        if operation.role in roles
        for stroke in operation.strokes
    ]


def _planned(plan: Plan, rims: list[Floats], face: Face, setup: SetUp, line: Floats) -> Plan:
    first = setup.operations[0]
    (x, y), (u, v) = line.tolist()
    stroke = Stroke(points=((x, y), (u, v)))
    role = Role.CUT_INNER if setup.process == "cut" else Role.SCORE
    operation = Operation(role=role, repeats=first.repeats, strokes=(stroke,))
    changed = {"operations": (operation,), "lead_in": (), "gates": (), "name": f"test-{setup.name}"}
    passes: tuple[Pass, ...] = (Pass(face=face, setups=(setup.model_copy(update=changed),)),)
    setups = [one for work in plan.passes for one in work.setups]
    before = [Stroke(points=one.lead_in) for one in setups if one.lead_in]
    marks = Registration(
        plan.holes,
        (*_strokes(setups, Role.WITNESS), *before, stroke),
        made=plan.registration,
    )
    passes = lead_ins.added(passes, rims, marks, plan.sheet, plan.material, plan.machine)
    return plan.model_copy(update={"passes": passes, "programs": (), "drawings": ()})
