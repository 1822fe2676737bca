"""A plan that goes on with a sheet holds what its origin holds, less what is on the sheet already.

Derived from the origin and the declared strokes alone: each declared stroke is one of the origin's
and named once; every other stroke of the origin is in the plan, once, in the same order, made the
same way, and nothing else is.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan, Remakes, Role
from foldmill_fabricate.verify.planned import Planned, at, planned
from foldmill_fabricate.verify.process import prove_work

Key = tuple[int, Role, int]
"""Number of a set-up in the origin, role, and number of a stroke in its operation."""

_OWN = frozenset(
    {"title", "passes", "figures", "findings", "programs", "drawings", "remakes", "version"}
)
"""In what a plan and its origin differ."""
_WORK = frozenset({"number", "gates", "operations"})
"""In what a set-up and that of the origin differ."""


def prove_rest(plan: Plan, remakes: Remakes) -> list[Finding]:
    """Compare a plan that goes on with a sheet with what is left of its origin."""
    origin = remakes.origin
    found = _origin_findings(remakes) + _setting_findings(plan, origin)
    there = Counter((one.setup, one.role, k) for one in remakes.there for k in one.strokes)
    strokes = planned(origin)
    found += _there_findings(there, {_key(stroke) for stroke in strokes})
    left = [stroke for stroke in strokes if not there[_key(stroke)]]
    return [*found, *_stroke_findings(planned(plan), left), *prove_work(plan)]


def _error(code: str, where: str, message: str) -> Finding:
    return Finding(code, Severity.ERROR, where, message)


def _key(stroke: Planned) -> Key:
    return stroke.setup.number, stroke.role, stroke.number


def _origin_findings(remakes: Remakes) -> list[Finding]:
    digest = hashlib.sha256(remakes.origin.model_dump_json().encode()).hexdigest()
    if digest == remakes.origin_sha256:
        return []
    text = "The plan that the sheet was begun from is not the one of the SHA-256 in plan.json."
    return [_error("remake-origin", "plan", text)]


def _setting_findings(plan: Plan, origin: Plan) -> list[Finding]:
    names = [name for name in type(plan).model_fields if name not in _OWN]
    other = [name for name in names if getattr(plan, name) != getattr(origin, name)]
    return [
        _error("remake-setting", "plan", f"Its {name} is not as the sheet was begun with.")
        for name in other
    ]


def _there_findings(there: Counter[Key], known: set[Key]) -> list[Finding]:
    found = []
    for (setup, role, number), times in sorted(there.items()):
        where = f"{role} stroke {number} of set-up {setup} of the origin"
        if (setup, role, number) not in known:
            found.append(_error("remake-there", where, "It is said to be cut, and there is none."))
        elif times > 1:
            found.append(_error("remake-there", where, f"It is said {times} times to be cut."))
    return found


def _stroke_findings(given: list[Planned], left: list[Planned]) -> list[Finding]:
    """Match both lists, as they stand in order of work."""
    have, wanted = _made(given), _made(left)
    more, less = Counter(have) - Counter(wanted), Counter(wanted) - Counter(have)
    found = [
        *_uneven(given, have, more, "It is on the sheet already, or is not made as it was begun."),
        *_uneven(left, wanted, less, "It is not on the sheet, and is not planned as it was begun."),
    ]
    if not found and have != wanted:
        text = "The strokes do not stand in the order in which the sheet was begun."
        found.append(_error("remake-stroke", "plan", text))
    return found


def _uneven(
    strokes: list[Planned], made: list[str], spare: Counter[str], text: str
) -> Iterator[Finding]:
    for stroke, how in zip(strokes, made, strict=True):
        if spare[how] > 0:
            spare[how] -= 1
            yield _error("remake-stroke", f"{stroke} at {at(stroke.points[0])}", text)


def _made(strokes: list[Planned]) -> list[str]:
    """Return of each stroke all that says where it is and how it is made, as one text."""
    setups = {
        id(stroke.setup): repr(sorted(stroke.setup.model_dump(exclude=set(_WORK)).items()))
        for stroke in {id(each.setup): each for each in strokes}.values()
    }
    return [
        f"{stroke.face} {setups[id(stroke.setup)]} {stroke.role} {stroke.operation.repeats} "
        f"{stroke.operation.overcut} {stroke.piece} {stroke.points.tolist()}"
        for stroke in strokes
    ]
