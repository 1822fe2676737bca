"""Ways in which good plans go wrong. Their programs are written anew: only the plan tells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot

from fabricate.verify.square_job import Job, emit, recorded

from foldmill_fabricate.passes import XY, Face, Gate, Operation, Plan, Role, SetUp, Stroke


@dataclass(frozen=True)
class _Edit:
    """Change the operations of a plan, one by one."""

    change: Callable[[Face, Operation], Operation]

    def __call__(self, plan: Plan) -> Plan:
        passes = tuple(
            side.model_copy(
                update={"setups": tuple(self._setup(side.face, setup) for setup in side.setups)}
            )
            for side in plan.passes
        )
        return plan.model_copy(update={"passes": passes})

    def _setup(self, face: Face, setup: SetUp) -> SetUp:
        operations = tuple(self.change(face, operation) for operation in setup.operations)
        return setup.model_copy(update={"operations": operations})


def _edited(role: Role, change: Callable[[Operation], Operation]) -> _Edit:
    return _Edit(lambda _, operation: change(operation) if operation.role is role else operation)


def _with_strokes(operation: Operation, strokes: tuple[Stroke, ...]) -> Operation:
    return operation.model_copy(update={"strokes": strokes})


def mountains_and_valleys_are_swapped(plan: Plan) -> Plan:
    scores = {
        side.face: operation
        for side in plan.passes
        for setup in side.setups
        for operation in setup.operations
        if operation.role is Role.SCORE
    }
    other = {Face.FRONT: Face.REVERSE, Face.REVERSE: Face.FRONT}
    return _Edit(lambda face, op: scores[other[face]] if op.role is Role.SCORE else op)(plan)


def a_crease_is_forgotten(plan: Plan) -> Plan:
    return _edited(Role.SCORE, lambda op: _with_strokes(op, op.strokes[1:]))(plan)


def a_crease_is_planned_twice(plan: Plan) -> Plan:
    return _edited(Role.SCORE, lambda op: _with_strokes(op, (*op.strokes, op.strokes[0])))(plan)


def a_line_is_invented(plan: Plan) -> Plan:
    stray = Stroke(points=((31.0, 123.0), (35.0, 125.0)))
    return _edited(Role.SCORE, lambda op: _with_strokes(op, (*op.strokes, stray)))(plan)


def a_stroke_leaves_the_blank(plan: Plan) -> Plan:
    stray = Stroke(points=((-1.0, 100.0), (4.0, 100.0)))
    return _edited(Role.WITNESS, lambda op: _with_strokes(op, (stray,)))(plan)


def a_score_runs_into_a_vertex(plan: Plan) -> Plan:
    """Lengthen a score by 0.5 mm at both ends; one of them at least stops short of a vertex."""

    def longer(operation: Operation) -> Operation:
        (x, y), (u, v) = operation.strokes[0].points[0], operation.strokes[0].points[-1]
        share = 0.5 / ((u - x) ** 2 + (v - y) ** 2) ** 0.5
        dx, dy = share * (u - x), share * (v - y)
        stroke = Stroke(points=((x - dx, y - dy), (u + dx, v + dy)))
        return _with_strokes(operation, (stroke, *operation.strokes[1:]))

    return _edited(Role.SCORE, longer)(plan)


def a_tie_is_not_declared(plan: Plan) -> Plan:
    return plan.model_copy(update={"ties": plan.ties[1:]})


def a_tie_is_not_left(plan: Plan) -> Plan:
    def joined(operation: Operation) -> Operation:
        one, two, *more = operation.strokes
        return _with_strokes(operation, (Stroke(points=one.points + two.points), *more))

    return _edited(Role.CUT_OUTER, joined)(plan)


def a_tie_is_in_a_corner(plan: Plan) -> Plan:
    """Shift the first tie along its edge until it ends 1 mm before the next corner."""
    tie = plan.ties[0]
    corner, away = _first_edge(plan)

    def shifted(operation: Operation) -> Operation:
        first, *more, last = operation.strokes
        end = _before(corner, away, 1.0 + tie.width)
        first = Stroke(points=(_before(corner, away, 1.0), *first.points[1:]))
        last = Stroke(points=(*last.points[:-1], end))
        return _with_strokes(operation, (first, *more, last))

    x, y = _before(corner, away, 1.0 + tie.width / 2)
    moved = tie.model_copy(update={"x": x, "y": y})
    plan = plan.model_copy(update={"ties": (moved, *plan.ties[1:])})
    return _edited(Role.CUT_OUTER, shifted)(plan)


def _first_edge(plan: Plan) -> tuple[XY, XY]:
    """Return the first corner of the outline and where its first stroke comes from."""
    for setup in plan.passes[-1].setups:
        for operation in setup.operations:
            if operation.role is Role.CUT_OUTER:
                points = operation.strokes[0].points
                return points[1], points[0]
    raise LookupError("no outline")


def _before(corner: XY, away: XY, gap: float) -> XY:
    (x, y), (u, v) = corner, away
    share = gap / hypot(u - x, v - y)
    return x + share * (u - x), y + share * (v - y)


def a_part_hangs_on_two_ties(plan: Plan) -> Plan:
    return plan.model_copy(update={"ties": plan.ties[:2]})


def a_hole_is_too_near_the_edge(plan: Plan) -> Plan:
    near = plan.holes[0].model_copy(update={"x": 6.0})
    return plan.model_copy(update={"holes": (near, *plan.holes[1:])})


def a_hole_is_not_cut(plan: Plan) -> Plan:
    return _edited(Role.HOLE, lambda op: _with_strokes(op, op.strokes[1:]))(plan)


def the_witness_mark_is_on_the_part(plan: Plan) -> Plan:
    x, y = plan.sheet.width / 2, plan.sheet.height / 2
    mark = Stroke(points=((x, y), (x + 8, y)))
    return _edited(Role.WITNESS, lambda op: _with_strokes(op, (mark,)))(plan)


def the_set_ups_of_the_reverse_change_places(plan: Plan) -> Plan:
    front, reverse = plan.passes
    score, cut = reverse.setups
    changed = (
        cut.model_copy(update={"number": score.number}),
        score.model_copy(update={"number": cut.number}),
    )
    return plan.model_copy(
        update={"passes": (front, reverse.model_copy(update={"setups": changed}))}
    )


def scores_are_repeated_three_times(plan: Plan) -> Plan:
    return _edited(Role.SCORE, lambda op: op.model_copy(update={"repeats": 3}))(plan)


def the_part_lies_elsewhere(plan: Plan) -> Plan:
    shifted = plan.placement.model_copy(update={"dx": plan.placement.dx + 0.1})
    return plan.model_copy(update={"placement": shifted})


def the_sheet_is_turned_about_its_edge(plan: Plan) -> Plan:
    return plan.model_copy(update={"flip": plan.flip.model_copy(update={"axis": 0.0})})


def nobody_is_told_to_turn_the_sheet(plan: Plan) -> Plan:
    front, reverse = plan.passes
    first = reverse.setups[0].model_copy(update={"gates": ()})
    changed = reverse.model_copy(update={"setups": (first, *reverse.setups[1:])})
    return plan.model_copy(update={"passes": (front, changed)})


def another_sheet_is_loaded_half_way(plan: Plan) -> Plan:
    return _asked_too(plan, Gate.LOAD, -1)


def the_sheet_is_turned_over_and_back(plan: Plan) -> Plan:
    return _asked_too(plan, Gate.FLIP, 0)


def the_sheet_is_taken_off_before_its_outline_is_cut(plan: Plan) -> Plan:
    return _asked_too(plan, Gate.REMOVE, -1)


def _asked_too(plan: Plan, gate: Gate, place: int) -> Plan:
    """Put a gate before one of the set-ups of the reverse."""
    front, reverse = plan.passes
    setups = list(reverse.setups)
    gates = (gate, *setups[place].gates)
    setups[place] = setups[place].model_copy(update={"gates": gates})
    changed = reverse.model_copy(update={"setups": tuple(setups)})
    return plan.model_copy(update={"passes": (front, changed)})


def the_witness_mark_is_a_bar(plan: Plan) -> Plan:
    return _edited(Role.WITNESS, lambda op: _with_strokes(op, op.strokes[:1]))(plan)


def scores_cut_through(plan: Plan) -> Plan:
    """Set the blade out by 0.7 mm, in the material and in every set-up that scores."""
    score = plan.material.score.model_copy(update={"exposure": 0.7})
    passes = tuple(
        side.model_copy(
            update={
                "setups": tuple(
                    setup.model_copy(update={"exposure": 0.7})
                    if setup.process == "score"
                    else setup
                    for setup in side.setups
                )
            }
        )
        for side in plan.passes
    )
    material = plan.material.model_copy(update={"score": score})
    return plan.model_copy(update={"material": material, "passes": passes})


def the_witness_mark_is_left_out(plan: Plan) -> Plan:
    return _without(plan, Role.WITNESS)


def the_holes_are_left_out(plan: Plan) -> Plan:
    return _without(plan, Role.HOLE).model_copy(update={"holes": ()})


def _without(plan: Plan, role: Role) -> Plan:
    """Take out a role with all that it needed, and number the set-ups anew."""
    number, passes = 0, []
    for side in plan.passes:
        setups = []
        for setup in side.setups:
            left = tuple(op for op in setup.operations if op.role is not role)
            if left:
                number += 1
                gates = setup.gates if number > 1 else (Gate.LOAD, *setup.gates)
                changes = {
                    "operations": left,
                    "number": number,
                    "gates": tuple(dict.fromkeys(gates)),
                }
                setups.append(setup.model_copy(update=changes))
        passes.append(side.model_copy(update={"setups": tuple(setups)}))
    return plan.model_copy(update={"passes": tuple(passes)})


def a_cut_is_made_in_what_a_hole_leaves(plan: Plan) -> Plan:
    x, y = plan.holes[0].x, plan.holes[0].y
    slot = Stroke(points=((x - 0.5, y), (x + 0.5, y)))
    return _edited(Role.HOLE, lambda op: _with_strokes(op, (*op.strokes, slot)))(plan)


PLANS: dict[Callable[[Plan], Plan], str] = {
    mountains_and_valleys_are_swapped: "swapped-faces",
    a_crease_is_forgotten: "missing-score",
    a_crease_is_planned_twice: "scored-twice",
    a_line_is_invented: "no-such-line",
    a_stroke_leaves_the_blank: "outside-blank",
    a_score_runs_into_a_vertex: "setback",
    a_tie_is_not_declared: "missing-cut",
    a_tie_is_not_left: "tie-cut",
    a_tie_is_in_a_corner: "tie-corner",
    a_part_hangs_on_two_ties: "too-few-ties",
    a_hole_is_too_near_the_edge: "hole-clearance",
    a_hole_is_not_cut: "hole-strokes",
    the_witness_mark_is_on_the_part: "witness-on-part",
    the_set_ups_of_the_reverse_change_places: "order",
    scores_are_repeated_three_times: "set-up-values",
    the_part_lies_elsewhere: "missing-score",
    the_sheet_is_turned_about_its_edge: "flip-axis",
    nobody_is_told_to_turn_the_sheet: "missing-gate",
    another_sheet_is_loaded_half_way: "wrong-gate",
    the_sheet_is_turned_over_and_back: "wrong-gate",
    the_sheet_is_taken_off_before_its_outline_is_cut: "wrong-gate",
    the_witness_mark_is_a_bar: "witness-symmetric",
    scores_cut_through: "score-depth",
    the_witness_mark_is_left_out: "witness-missing",
    the_holes_are_left_out: "holes-missing",
    a_cut_is_made_in_what_a_hole_leaves: "cut-in-loose-piece",
}
"""What is done to the plan, its programs written from it afterwards, and what must be found."""


def replanned(job: Job, change: Callable[[Plan], Plan]) -> Job:
    """Change the plan and write its programs anew, so that only proof two can see it."""
    plan = change(job.plan).model_copy(update={"programs": ()})
    return recorded(Job(plan, job.pattern, emit(plan)))
