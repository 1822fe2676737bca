"""Each set-up that needs a lead-in has one that turns any blade, in the waste, touching nothing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan, Role, SetUp
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.blade import STARTS, dragged
from foldmill_fabricate.verify.virtual_sheet import modelled_offset

Floats = NDArray[np.float64]


def prove_lead_ins(asked: Asked) -> list[Finding]:
    """Check the lead-in of every set-up, and that there is none where none is needed."""
    plan = asked.plan
    offset = modelled_offset(plan.machine)
    things = _things(asked) if offset else []
    found: list[Finding] = []
    for setup in (setup for side in plan.passes for setup in side.setups):
        where = f"set-up {setup.number} ({setup.name})"
        if not setup.lead_in:
            found += _missing(where, offset)
        elif not offset:
            text = "It has a lead-in, and the machine makes up for its blade's offset itself."
            found.append(_error("lead-in-superfluous", where, text))
        else:
            found += _settling(setup, offset, where)
            found += _place(plan, setup, offset, where, things)
    return found + (_apart(plan, offset) if offset else [])


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def prove_turned(plan: Plan) -> list[Finding]:
    """Check that every set-up's lead-in is there where one is needed, and turns any blade."""
    offset = modelled_offset(plan.machine)
    found: list[Finding] = []
    for setup in (setup for side in plan.passes for setup in side.setups):
        where = f"set-up {setup.number} ({setup.name})"
        found += _settling(setup, offset, where) if setup.lead_in else _missing(where, offset)
    return found


def _missing(where: str, offset: float) -> list[Finding]:
    if not offset:
        return []
    text = "It has no lead-in, and nobody knows how the blade points before it."
    return [_error("lead-in-missing", where, text, "Plan again.")]


def _settling(setup: SetUp, offset: float, where: str) -> list[Finding]:
    """Drag blades that point all round along it; they must end up together."""
    ((_, headings),) = dragged([np.asarray(setup.lead_in, float)], offset, STARTS)
    arms = np.column_stack([np.cos(headings[:, -1]), np.sin(headings[:, -1])])
    apart = offset * float(np.ptp(arms, axis=0).max())
    if apart <= tolerances.SETTLED_MM:
        return []
    text = f"After its lead-in the tip may be anywhere within {apart:.3f} mm, by how it pointed; "
    return [_error("lead-in-short", where, f"{text}{tolerances.SETTLED_MM:g} mm are allowed.")]


def _things(asked: Asked) -> list[tuple[str, str, Any]]:
    """Return what a lead-in must keep clear of: finding's code, name, area or line."""
    import shapely

    plan = asked.plan
    found = [("lead-in-on-part", "part", part) for part in asked.laid.parts]
    found += [
        ("lead-in-place", f"hole {k}", shapely.Point(hole.x, hole.y).buffer(hole.diameter / 2))
        for k, hole in enumerate(plan.holes, 1)
    ]
    found += [("lead-in-place", "registration mark", line) for line in _lines(plan, Role.MARK)]
    return found + [("lead-in-place", "witness mark", line) for line in _lines(plan, Role.WITNESS)]


def _lines(plan: Plan, role: Role) -> Iterator[Any]:
    import shapely

    for side in plan.passes:
        for setup in side.setups:
            for operation in setup.operations:
                if operation.role is role:
                    yield from (shapely.LineString(s.points) for s in operation.strokes)


def _place(
    plan: Plan, setup: SetUp, offset: float, where: str, things: list[tuple[str, str, Any]]
) -> list[Finding]:
    import shapely

    way = shapely.LineString(setup.lead_in)
    room = plan.material.part_clearance + offset
    x0, y0, x1, y1 = way.bounds
    to_edge = min(x0, y0, plan.sheet.width - x1, plan.sheet.height - y1)
    gaps = [(code, what, float(shapely.distance(way, thing))) for code, what, thing in things]
    return [
        _error(
            code,
            where,
            f"Its lead-in is {gap:.2f} mm from the {what}; {room:g} mm are asked for.",
        )
        for code, what, gap in [*gaps, ("lead-in-place", "blank's edge", to_edge)]
        if gap < room - tolerances.PLAN_MM
    ]


def _apart(plan: Plan, offset: float) -> list[Finding]:
    """Check that no lead-in runs into the groove of another, which would catch the blade."""
    import shapely

    setups = [setup for side in plan.passes for setup in side.setups if setup.lead_in]
    found = []
    for k, setup in enumerate(setups):
        for before in setups[:k]:
            ways = shapely.LineString(setup.lead_in), shapely.LineString(before.lead_in)
            if shapely.distance(*ways) < 2 * offset:
                text = f"Its lead-in runs into that of set-up {before.number}."
                found.append(_error("lead-in-place", f"set-up {setup.number}", text))
    return found
