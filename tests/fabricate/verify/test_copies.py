"""What can go wrong with several copies on a sheet is found and named."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import pytest
import stools
from fabricate.plan.test_copies import kite
from fabricate.verify.corrupt_programs import locate, read, with_program, written
from fabricate.verify.square_job import Job, emit, recorded
from fabricate.verify.test_corruptions import errors, sentence, verified

from foldmill import CreasePattern, Fold
from foldmill_fabricate.passes import Face, Operation, Pass, Plan, Role, Stroke
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import report

Change = Callable[[Face, Role, Stroke], Stroke | None]


@cache
def job(flip: str = "left-right", slug: str = stools.ONE_TOOL) -> Job:
    fold = kite(120, 100)
    options = {"grid": (2, 2), "flip": flip, "relief": "all"}
    plan = make(fold, stools.material(), stools.machine(slug), **options)  # type: ignore[arg-type]
    return replanned(Job(plan, fold.pattern, {}), lambda same: same)


def replanned(of: Job, change: Callable[[Plan], Plan]) -> Job:
    """Write the programs of a changed plan anew, so that only the second proof can see it."""
    plan = change(of.plan).model_copy(update={"programs": ()})
    return recorded(Job(plan, of.pattern, emit(plan)))


def redrawn(plan: Plan, change: Change) -> Plan:
    """Change or leave out strokes."""

    def operation(face: Face, of: Operation) -> Operation:
        found = [change(face, of.role, stroke) for stroke in of.strokes]
        return of.model_copy(update={"strokes": tuple(s for s in found if s is not None)})

    def work(of: Pass) -> Pass:
        setups = tuple(
            setup.model_copy(
                update={"operations": tuple(operation(of.face, op) for op in setup.operations)}
            )
            for setup in of.setups
        )
        return of.model_copy(update={"setups": setups})

    return plan.model_copy(update={"passes": tuple(work(each) for each in plan.passes)})


def shifted(stroke: Stroke, dx: float, dy: float) -> Stroke:
    return replace(stroke, points=tuple((x + dx, y + dy) for x, y in stroke.points))


def a_copy_is_not_drawn(plan: Plan) -> Plan:
    return redrawn(plan, lambda _face, _role, s: None if s.piece == 3 else s)


def a_copy_and_its_place_are_left_out(plan: Plan) -> Plan:
    fewer = redrawn(plan, lambda _face, _role, s: None if s.piece == 4 else s)
    return fewer.model_copy(update={"copies": plan.copies[:-1]})


def a_copy_has_no_place(plan: Plan) -> Plan:
    return plan.model_copy(update={"copies": plan.copies[:-1], "quantity": 3})


def a_copy_is_drawn_a_twentieth_of_a_millimetre_off(plan: Plan) -> Plan:
    return redrawn(plan, lambda _f, _r, s: shifted(s, 0.05, 0) if s.piece == 2 else s)


def the_place_of_a_copy_is_a_twentieth_of_a_millimetre_off(plan: Plan) -> Plan:
    moved = plan.copies[1].model_copy(update={"dy": plan.copies[1].dy + 0.05})
    return plan.model_copy(update={"copies": (plan.copies[0], moved, plan.copies[2])})


def two_copies_overlap(plan: Plan) -> Plan:
    near = plan.copies[0].model_copy(update={"dx": plan.copies[0].dx - 40})
    drawn = redrawn(plan, lambda _f, _r, s: shifted(s, -40, 0) if s.piece == 2 else s)
    return drawn.model_copy(update={"copies": (near, *plan.copies[1:])})


def two_copies_lie_on_each_other(plan: Plan) -> Plan:
    return plan.model_copy(update={"copies": (plan.placement, *plan.copies[1:])})


def a_copys_valleys_are_scored_on_the_front(plan: Plan) -> Plan:
    def scores(face: Face) -> list[Stroke]:
        of = next(work for work in plan.passes if work.face is face)
        return [s for setup in of.setups for op in setup.operations
                if op.role is Role.SCORE for s in op.strokes if s.piece == 2]  # fmt: skip

    valleys = scores(Face.REVERSE)
    without = redrawn(plan, lambda _f, r, s: None if r is Role.SCORE and s in valleys else s)
    passes = list(without.passes)
    setup = passes[0].setups[-1]
    score = setup.operations[-1]
    assert score.role is Role.SCORE
    more = score.model_copy(update={"strokes": (*score.strokes, *valleys)})
    setup = setup.model_copy(update={"operations": (*setup.operations[:-1], more)})
    passes[0] = passes[0].model_copy(update={"setups": (*passes[0].setups[:-1], setup)})
    return without.model_copy(update={"passes": tuple(passes)})


def strokes_are_said_to_belong_to_another_copy(plan: Plan) -> Plan:
    swap = {1: 2, 2: 1}
    return redrawn(plan, lambda _f, _r, s: replace(s, piece=swap.get(s.piece, s.piece)))


def a_stroke_belongs_to_a_copy_that_is_not_there(plan: Plan) -> Plan:
    return redrawn(plan, lambda _f, _r, s: replace(s, piece=9) if s.piece == 4 else s)


def the_outline_of_a_copy_is_cut_in_two_goes(plan: Plan) -> Plan:
    passes = plan.passes
    setup = passes[-1].setups[-1]
    outer = setup.operations[-1]
    parted = outer.model_copy(update={"strokes": (*outer.strokes[1:], outer.strokes[0])})
    setup = setup.model_copy(update={"operations": (*setup.operations[:-1], parted)})
    last = passes[-1].model_copy(update={"setups": (*passes[-1].setups[:-1], setup)})
    return plan.model_copy(update={"passes": (*passes[:-1], last)})


def the_ties_of_a_copy_hold_another(plan: Plan) -> Plan:
    own = len(plan.ties) // 4
    return plan.model_copy(update={"ties": (*plan.ties[own:], *plan.ties[own : 2 * own])})


SPOILT = {
    a_copy_is_not_drawn: {"copy-missing"},
    a_copy_and_its_place_are_left_out: {"copies-missing"},
    a_copy_has_no_place: {"wrong-copy", "no-such-line"},
    a_copy_is_drawn_a_twentieth_of_a_millimetre_off: {"copy-moved", "no-such-line"},
    the_place_of_a_copy_is_a_twentieth_of_a_millimetre_off: {"copy-moved", "missing-score"},
    two_copies_overlap: {"copies-overlap"},
    two_copies_lie_on_each_other: {"copies-overlap", "copy-moved"},
    a_copys_valleys_are_scored_on_the_front: {"wrong-face"},
    strokes_are_said_to_belong_to_another_copy: {"copy-moved"},
    a_stroke_belongs_to_a_copy_that_is_not_there: {"wrong-copy", "copy-missing"},
    the_outline_of_a_copy_is_cut_in_two_goes: {"order"},
    the_ties_of_a_copy_hold_another: {"too-few-ties", "missing-cut"},
}


@pytest.mark.parametrize("flip", ["left-right", "end-over-end"])
@pytest.mark.parametrize("slug", [stools.ONE_TOOL, stools.PENS])
def test_four_good_copies_pass_without_a_finding(flip: str, slug: str) -> None:
    result = verified(job(flip, slug))
    assert not [f for f in result.findings if f.severity == "error"], result.findings
    assert "Copies                4" in report(result)


@pytest.mark.parametrize("flip", ["left-right", "end-over-end"])
@pytest.mark.parametrize(
    ("spoil", "codes"), SPOILT.items(), ids=[sentence(spoil) for spoil in SPOILT]
)
def test_it_is_found_that(spoil: Callable[[Plan], Plan], codes: set[str], flip: str) -> None:
    assert errors(verified(replanned(job(flip), spoil))) >= codes


def test_what_is_wrong_names_its_copy_and_by_how_much() -> None:
    moved = verified(replanned(job(), a_copy_is_drawn_a_twentieth_of_a_millimetre_off))
    said = [str(finding) for finding in moved.findings]
    assert any("copy 2" in each and "+0.050, +0.000 mm from its place" in each for each in said)
    swapped = verified(replanned(job(), a_copys_valleys_are_scored_on_the_front))
    wrong = [str(f) for f in swapped.findings if f.code == "wrong-face"]
    assert len(wrong) == 2
    assert all(each.startswith("valley edge") and "of copy 2 at" in each for each in wrong)


@pytest.mark.parametrize("count", [2, 3])
def test_copies_with_inner_cuts_and_slits_are_proved_too(count: int) -> None:
    slit = [(0, 0), (90, 0), (90, 90), (0, 90), (30, 45), (60, 45)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (0, 4), (3, 4), (1, 5), (2, 5)]
    fold = Fold(CreasePattern.from_lines(slit, edges, "BBBBCMMVV"))
    plan = make(fold, stools.material(), stools.machine(), copies=count)
    result = verified(recorded(Job(plan, fold.pattern, emit(plan))))
    assert not errors(result), result.findings
    without = redrawn(
        plan, lambda _f, r, s: None if r is Role.CUT_INNER and s.piece == count else s
    )
    result = verified(recorded(Job(without, fold.pattern, emit(without))))
    told = [str(finding) for finding in result.findings if finding.code == "missing-cut"]
    assert told
    assert all(f"of copy {count} at" in each for each in told)


def test_copies_that_a_program_cuts_by_turns_are_found() -> None:
    """All is drawn, but cutting comes back to a copy that was left half cut."""
    good = job()
    name, first = locate(good, Role.CUT_OUTER, Face.REVERSE)
    parts = read(good.programs[name])
    parts[first], parts[-2] = parts[-2], parts[first]
    assert errors(verified(with_program(good, name, written(parts)))) == {"order"}
