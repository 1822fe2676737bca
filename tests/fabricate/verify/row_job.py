"""Jobs whose creases are rows of cuts or whose outline is snapped, and ways of spoiling them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import hypot

from fabricate.verify.corrupt_plans import replanned
from fabricate.verify.square_job import Job, recorded

from foldmill import CreasePattern, Fold
from foldmill_fabricate import shelf
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import XY, Operation, Plan, Role, SetUp, Stroke
from foldmill_fabricate.plan import make

Change = Callable[[Operation], Operation]

CORNERS = [(0, 0), (120, 0), (120, 120), (0, 120), (60, 55)]
LINES = "01B 12B 23B 30B 04M 14V 24M 34V"


def fold() -> Fold:
    """A square with four creases that end in its corners."""
    edges = [(int(word[0]), int(word[1])) for word in LINES.split()]
    letters = [word[2] for word in LINES.split()]
    angles = [{"M": -90.0, "V": 90.0}.get(letter, 0.0) for letter in letters]
    return Fold(CreasePattern.from_lines(CORNERS, edges, letters, angles))


@cache
def job(machine: str, score: str | None, outline: str | None) -> Job:
    made, used = fold(), shelf.machine(machine)
    strong = used.tools.model_copy(update={"max_force": 600.0})
    plan = make(
        made,
        shelf.material("pp-0.75"),
        used.model_copy(update={"tools": strong}),
        score=score,  # type: ignore[arg-type]
        cut=outline,  # type: ignore[arg-type]
    )
    return recorded(Job(plan, made.pattern, hpgl.write(plan, made)))


def rewritten(good: Job, plan: Plan) -> Job:
    """Change the plan and write its programs anew."""
    if not plan.machine.tools.host_offset:
        return replanned(good, lambda _: plan)
    changed = plan.model_copy(update={"programs": ()})
    return recorded(Job(changed, good.pattern, hpgl.write(changed, fold())))


def _edited(good: Job, role: Role, change: Change) -> Job:
    def edit(setup: SetUp) -> SetUp:
        operations = tuple(change(op) if op.role is role else op for op in setup.operations)
        return setup.model_copy(update={"operations": operations})

    plan = good.plan
    passes = tuple(
        side.model_copy(update={"setups": tuple(edit(setup) for setup in side.setups)})
        for side in plan.passes
    )
    return rewritten(good, plan.model_copy(update={"passes": passes}))


def _with(operation: Operation, strokes: tuple[Stroke, ...]) -> Operation:
    return operation.model_copy(update={"strokes": strokes})


def _spot(good: Job, vertex: int) -> XY:
    """Return where a vertex lies on the sheet; none of these parts is turned by an odd angle."""
    from foldmill_fabricate.sheet import placed

    x, y = placed(good.pattern.vertices, good.plan.placement)[vertex].tolist()
    return x, y


def _dash_at(good: Job, corner: XY) -> Job:
    """Let the cut that is nearest to a corner begin in it."""

    def change(operation: Operation) -> Operation:
        ends = [(k, end) for k in range(len(operation.strokes)) for end in (0, -1)]
        k, end = min(ends, key=lambda each: _gap(operation.strokes[each[0]], each[1], corner))
        other = operation.strokes[k].points[-1 - end]
        points = (corner, other) if end == 0 else (other, corner)
        strokes = list(operation.strokes)
        strokes[k] = Stroke(points=points)
        return _with(operation, tuple(strokes))

    return _edited(good, Role.SCORE, change)


def _gap(stroke: Stroke, end: int, spot: XY) -> float:
    return hypot(stroke.points[end][0] - spot[0], stroke.points[end][1] - spot[1])


def a_dash_is_in_a_corner_of_the_outline(good: Job) -> Job:
    return _dash_at(good, _spot(good, 2))


def a_dash_is_in_the_corner_where_creases_meet(good: Job) -> Job:
    return _dash_at(good, _spot(good, 4))


def a_dash_is_missing(good: Job) -> Job:
    return _edited(good, Role.SCORE, lambda op: _with(op, op.strokes[:3] + op.strokes[4:]))


def two_dashes_are_one(good: Job) -> Job:
    def change(operation: Operation) -> Operation:
        one, two, *more = operation.strokes
        ends = one.points + two.points
        joined = Stroke(points=max(_pairs(ends), key=lambda pair: _length(*pair)))
        return _with(operation, (joined, *more))

    return _edited(good, Role.SCORE, change)


def _pairs(points: tuple[XY, ...]) -> list[tuple[XY, XY]]:
    return [(a, b) for a in points for b in points]


def _length(a: XY, b: XY) -> float:
    return hypot(a[0] - b[0], a[1] - b[1])


def a_dash_is_cut_twice(good: Job) -> Job:
    return _edited(good, Role.SCORE, lambda op: _with(op, (*op.strokes, op.strokes[0])))


def a_dash_is_beside_its_crease(good: Job) -> Job:
    def change(operation: Operation) -> Operation:
        first, *more = operation.strokes
        moved = Stroke(points=tuple((x + 0.3, y) for x, y in first.points))
        return _with(operation, (moved, *more))

    return _edited(good, Role.SCORE, change)


def dashes_are_overcut(good: Job) -> Job:
    return _edited(good, Role.SCORE, lambda op: op.model_copy(update={"overcut": 0.5}))


def dashes_are_repeated_like_scores(good: Job) -> Job:
    return _edited(good, Role.SCORE, lambda op: op.model_copy(update={"repeats": op.repeats + 1}))


ROW_JOBS: dict[Callable[[Job], Job], str] = {
    a_dash_is_in_a_corner_of_the_outline: "dash-in-corner",
    a_dash_is_in_the_corner_where_creases_meet: "dash-in-corner",
    a_dash_is_missing: "missing-score",
    two_dashes_are_one: "perforation-cut",
    a_dash_is_cut_twice: "scored-twice",
    a_dash_is_beside_its_crease: "no-such-line",
    dashes_are_overcut: "overcut-on-score",
    dashes_are_repeated_like_scores: "set-up-values",
}
"""What is done to a job whose creases are perforated, and what must be found."""


def a_snapped_outline_is_cut_through(good: Job) -> Job:
    """Set the blade out through the sheet where it is only to be scored."""

    def deeper(setup: SetUp) -> SetUp:
        cut = setup.process == "cut"
        return setup.model_copy(update={"exposure": 1.0}) if cut else setup

    return rewritten(good, _set_ups(good.plan, deeper))


def _set_ups(plan: Plan, change: Callable[[SetUp], SetUp]) -> Plan:
    passes = tuple(
        side.model_copy(update={"setups": tuple(change(setup) for setup in side.setups)})
        for side in plan.passes
    )
    return plan.model_copy(update={"passes": passes})


def a_snapped_outline_is_left_open(good: Job) -> Job:
    def change(operation: Operation) -> Operation:
        first, *more = operation.strokes
        return _with(operation, (Stroke(points=first.points[:-1]), *more))

    return _edited(good, Role.CUT_OUTER, change)


def a_snapped_outline_hangs_on_ties(good: Job) -> Job:
    from foldmill_fabricate.passes import Tie

    x, y = _spot(good, 0)
    u, v = _spot(good, 1)
    tie = Tie(x=(x + u) / 2, y=(y + v) / 2, width=0.6)
    return rewritten(good, good.plan.model_copy(update={"ties": (tie,)}))


def a_hole_goes_through_a_sheet_that_is_snapped(good: Job) -> Job:
    def change(setup: SetUp) -> SetUp:
        if setup.process != "cut":
            return setup
        ring = tuple((20 + x, 20 + y) for x, y in ((0, 0), (4, 0), (4, 4), (0, 4), (0, 0)))
        hole = Operation(role=Role.HOLE, strokes=(Stroke(points=ring),), repeats=1)
        return setup.model_copy(update={"operations": (hole, *setup.operations)})

    return rewritten(good, _set_ups(good.plan, change))


SNAP_JOBS: dict[Callable[[Job], Job], str] = {
    a_snapped_outline_is_cut_through: "set-up-values",
    a_snapped_outline_is_left_open: "missing-cut",
    a_snapped_outline_hangs_on_ties: "tie-cut",
    a_hole_goes_through_a_sheet_that_is_snapped: "wrong-process",
}
"""The same for a job whose outline is scored and snapped."""
