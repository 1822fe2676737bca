"""Several copies on one sheet: all there, in their places, apart, and cut one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Role
from foldmill_fabricate.verify import tolerances
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.planned import Planned, at

Floats = NDArray[np.float64]

_WASTE = (Role.HOLE, Role.WITNESS)
_CUTS = (Role.RELIEF, Role.CUT_INNER, Role.CUT_OUTER)


def prove_copies(asked: Asked, strokes: Sequence[Planned]) -> list[Finding]:
    """Check number, distance, place and order of copies; what is drawn of each is proved apart."""
    plan, count = asked.plan, asked.laid.count
    found = []
    if plan.quantity != count:
        text = f"It is to hold {plan.quantity} copies, and has places for {count}."
        found.append(_error("copies-missing", "plan", text, "Plan again."))
    found += _apart(asked)
    named = {0} if count == 1 else set(range(1, count + 1))
    for stroke in strokes:
        allowed = {0} if stroke.role in _WASTE else named
        if stroke.piece not in allowed:
            text = f"It is said to belong to copy {stroke.piece} of {count}."
            found.append(_error("wrong-copy", str(stroke), text))
    if count == 1:
        return found
    moved: set[int] = set()
    for copy in sorted(named):
        told = _one_copy(asked, copy, [s for s in strokes if s.piece == copy])
        moved |= {copy} if told else set()
        found += told
    return found + _strangers(asked, strokes, moved) + prove_turns(strokes)


def _error(code: str, where: str, message: str, remedy: str = "") -> Finding:
    return Finding(code, Severity.ERROR, where, message, remedy)


def _apart(asked: Asked) -> list[Finding]:
    """Check that copies do not overlap and keep the material's clearance from each other."""
    import shapely

    parts, least = np.array(asked.laid.parts), asked.plan.material.part_clearance
    reach = max(least, tolerances.PLAN_MM)
    one, two = shapely.STRtree(parts).query(parts, predicate="dwithin", distance=reach)
    found = []
    for i, j in zip(one[one < two].tolist(), two[one < two].tolist(), strict=True):
        where = f"copies {i + 1} and {j + 1}"
        shared = float(shapely.area(shapely.intersection(parts[i], parts[j])))
        gap = float(shapely.distance(parts[i], parts[j]))
        if shared > tolerances.PLAN_MM:
            found.append(_error("copies-overlap", where, f"They share {shared:.2f} mm² of paper."))
        elif gap < least - tolerances.PLAN_MM:
            text = f"They are {gap:.2f} mm apart; {least:g} mm are asked for."
            found.append(_error("copies-too-near", where, text))
    return found


def _one_copy(asked: Asked, copy: int, own: Sequence[Planned]) -> list[Finding]:
    """Check that a copy, 1, 2, 3 …, is drawn, and that its outline is where it belongs."""
    place = asked.laid.places[copy - 1]
    where = f"copy {copy}, its origin at {at((place.dx, place.dy))}"
    if not own:
        return [_error("copy-missing", where, "Nothing of it is drawn.", "Plan again.")]
    outer = [stroke.points for stroke in own if stroke.role is Role.CUT_OUTER]
    if not outer or not asked.loops:
        return []
    drawn, wanted = np.vstack(outer), asked.spots[asked.loops[copy - 1]]
    low, high = (f(drawn, axis=0) - f(wanted, axis=0) for f in (np.min, np.max))
    if np.abs(high - low).max() > tolerances.PLAN_MM:
        return []  # not all of it, or of another shape: told edge by edge
    dx, dy = ((low + high) / 2).tolist()
    if max(abs(dx), abs(dy)) <= tolerances.PLAN_MM:
        return []
    text = f"It is cut {dx:+.3f}, {dy:+.3f} mm from its place."
    return [_error("copy-moved", where, text, "Plan again.")]


def _strangers(asked: Asked, strokes: Sequence[Planned], moved: set[int]) -> list[Finding]:
    """Check that strokes lie on the copy that they are said to belong to."""
    import shapely

    count = asked.laid.count
    mine = [s for s in strokes if 1 <= s.piece <= count and s.piece not in moved]
    parts = np.array(asked.laid.parts)
    points = shapely.points([stroke.points.mean(axis=0) for stroke in mine])
    ends = shapely.points([stroke.points[0] for stroke in mine])
    owners = parts[[stroke.piece - 1 for stroke in mine]]
    reach = [s.operation.overcut + tolerances.BESIDE_MM for s in mine]
    away = np.minimum(shapely.distance(owners, points), shapely.distance(owners, ends))
    return [
        _error("wrong-copy", f"{stroke} at {at(stroke.points[0])}", _far(stroke, gap))
        for stroke, gap, most in zip(mine, away.tolist(), reach, strict=True)
        if gap > most
    ]


def _far(stroke: Planned, gap: float) -> str:
    return f"It is said to belong to copy {stroke.piece}, and lies {gap:.2f} mm from it."


def prove_turns(strokes: Sequence[Planned]) -> list[Finding]:
    """Check that the cutting of one copy is finished before that of the next begins."""
    found = []
    for rank, own in groupby(strokes, key=lambda stroke: stroke.rank):
        pieces = [stroke.piece for stroke in own if stroke.role in _CUTS]
        runs = [piece for piece, _ in groupby(pieces)]
        again = sorted({piece for k, piece in enumerate(runs) if piece in runs[:k]})
        if again:
            text = f"Copy {again[0]} is cut on after another copy was begun."
            found.append(_error("order", f"operation {rank + 1}", text))
    return found
