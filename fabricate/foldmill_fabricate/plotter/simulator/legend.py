"""What each stroke of a simulated machine is, by the plan it comes from, and in which colour.

One name and one colour for each kind of work, the same on both faces and in every picture.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.plotter.simulator.drawing import Drawn
from foldmill_fabricate.sheet import seen_by_machine

Floats = NDArray[np.float64]

LEAD_IN, TURNED, UNPLANNED = "lead-ins", "blade turned, hardly touching", "not in the plan"
COLOURS = {
    Role.SCORE: "#0050d0",
    Role.CUT_OUTER: "#d01010",
    Role.CUT_INNER: "#a09000",
    Role.HOLE: "#109030",
    Role.RELIEF: "#00a0a0",
    Role.WITNESS: "#8000a0",
    LEAD_IN: "#c000c0",
    TURNED: "#9098a0",
    UNPLANNED: "#000000",
}
OTHERS = ("#0057b8", "#c8102e", "#1b7f3b", "#8a3ffc", "#b8590a", "#5b616b")
"""Colours of what has none of its own, in order of first use on either face."""
_NEAR = 2.0
"""mm. A stroke this far from its place is still known for what it is; its holder's way farther."""


def by_plan(strokes: Sequence[Drawn], face: Face, plan: Plan, machine: Machine) -> list[str]:
    """Return the name of each stroke by the nearest line of the plan: "scores, half-cut"."""
    import shapely

    kinds, lines = _planned(plan, face)
    if not lines or not strokes:
        return [UNPLANNED] * len(strokes)
    tree = shapely.STRtree([shapely.LineString(line) for line in lines])
    middles = shapely.points([_middle(stroke.millimetres(machine.axes)) for stroke in strokes])
    reach = _NEAR + plan.machine.tools.host_offset
    drawn, nearest = tree.query_nearest(middles, max_distance=reach, all_matches=False)
    names = [UNPLANNED] * len(strokes)
    light = {setup.swivel_force for work in plan.passes for setup in work.setups} - {0.0}
    for k, line in zip(drawn.tolist(), nearest.tolist(), strict=True):
        names[k] = TURNED if strokes[k].force in light else kinds[line]
    return names


def colours(names: Sequence[str], plan: Plan | None) -> dict[str, str]:
    """Return a colour for each name, in order of first use."""
    own = {} if plan is None else {_name(role, plan): COLOURS.get(role) for role in Role}
    known = {name: colour for name, colour in own.items() if colour is not None}
    known |= {name: COLOURS[name] for name in (LEAD_IN, TURNED, UNPLANNED)}
    found: dict[str, str] = {}
    for name in names:
        spare = OTHERS[len([one for one in found if one not in known]) % len(OTHERS)]
        found.setdefault(name, known.get(name, spare))
    return found


def _planned(plan: Plan, face: Face) -> tuple[list[str], list[Floats]]:
    """Return the lines of one face as the machine sees them, and what each is."""
    kinds, lines = [], []
    for setup in (s for work in plan.passes if work.face is face for s in work.setups):
        if setup.lead_in:
            kinds.append(LEAD_IN)
            lines.append(seen_by_machine(plan, face, setup.lead_in))
        for operation in setup.operations:
            kinds += [_name(operation.role, plan)] * len(operation.strokes)
            lines += [seen_by_machine(plan, face, s.points) for s in operation.strokes]
    return kinds, lines


def _name(role: Role, plan: Plan) -> str:
    words = {
        Role.SCORE: f"scores, {plan.material.score.title}",
        Role.CUT_OUTER: f"outline, {plan.material.cut.title}",
        Role.CUT_INNER: "inner cuts",
        Role.HOLE: "registration holes",
        Role.RELIEF: "relief holes",
        Role.WITNESS: "witness mark",
    }
    return words.get(role, str(role))


def _middle(way: Floats) -> Floats:
    """Return the middle of the longest piece of a way (n, 2)."""
    lengths = np.hypot(*np.diff(way, axis=0).T)
    k = int(np.argmax(lengths)) if len(lengths) else 0
    middle: Floats = way[k : k + 2].mean(axis=0)
    return middle
