"""Relief holes: round, of the right size, at vertices that scores stop short of, nowhere else."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Hole, Role
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import NOWHERE, Asked
from foldmill_fabricate.verify.planned import Planned, at
from foldmill_fabricate.verify.virtual_sheet import modelled_offset
from foldmill_fabricate.verify.waste import is_rim

LEAST = 1.5
"""mm"""


def prove_relief(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    """Compare declared relief holes with their strokes, and with the vertices they belong to."""
    rims = [stroke for stroke in strokes if stroke.role is Role.RELIEF]
    reliefs = asked.plan.reliefs
    offset = modelled_offset(asked.plan.machine)
    owners = [
        [k for k, hole in enumerate(reliefs) if is_rim(stroke, hole, offset)] for stroke in rims
    ]
    found = [
        _error("no-such-relief", f"{stroke} at {at(stroke.points[0])}", "It cuts no declared hole.")
        for stroke, own in zip(rims, owners, strict=True)
        if not own
    ]
    for k, hole in enumerate(reliefs):
        times = sum(k in own for own in owners)
        if times != 1:
            text = f"It is cut by {times} strokes, not by one."
            found.append(_error("relief-strokes", _name(hole), text))
        found += _one_hole(asked, hole)
    return found


def _one_hole(asked: Asked, hole: Hole) -> list[Finding]:
    gaps = np.hypot(*(asked.spots - (hole.x, hole.y)).T)
    vertex = int(np.argmin(gaps))
    if gaps[vertex] > tolerances.PLAN_MM or not asked.stops_at[vertex]:
        text = "Scores do not stop short of a vertex there, so that it takes nothing away."
        return [_error("relief-astray", _name(hole), text)]
    creases = int((asked.laid.edges[asked.score_face != NOWHERE] == vertex).sum())
    material = asked.plan.material
    times = 3.0 if creases > 5 else 2.5
    wanted = max(LEAST, material.relief_diameter, times * material.thickness)
    if abs(hole.diameter - wanted) > tolerances.PLAN_MM:
        text = f"It is {hole.diameter:g} mm wide; {creases} creases meet there and want "
        return [_error("relief-diameter", _name(hole), f"{text}{wanted:g} mm.")]
    return []


def _name(hole: Hole) -> str:
    return f"relief hole at {at((hole.x, hole.y))}"


def _error(code: str, where: str, message: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message)
