"""What goes on with a sheet is its origin less what is declared to be there, or is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from fabricate.bench import small_plan
from fabricate.half_made import PENS, job_of
from fabricate.verify import knife_job

from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.passes import Gate, Operation, Pass, Plan, Remakes, SetUp, Stroke
from foldmill_fabricate.plotter.ledger import Entry, Program, Record, SheetRecord, State
from foldmill_fabricate.remaking import read_spoken, remake
from foldmill_fabricate.remaking.strokes import owners
from foldmill_fabricate.sending import Job
from foldmill_fabricate.verify import verify
from foldmill_fabricate.verify.rule import prove_rule


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Job:
    return job_of(tmp_path_factory.mktemp("job"), small_plan(PENS))


@pytest.fixture(scope="module")
def rest(job: Job) -> Plan:
    """The front was stopped after seven strokes, two of them in doubt and missing."""
    records = tuple(
        Record(
            "ABCD",
            number,
            Program(part.name, part.face, part.sha256, len(owners(job.plan, part))),
            State.READY if number else State.INTERRUPTED,
            *(0, 0, 0.0, ""),
            () if number else (Entry(1, 0, 0, 7, 5),),
        )
        for number, part in enumerate(job.plan.programs)
    )
    sheet = SheetRecord("ABCD", job.id, "", "", "", "", records)
    return remake(job.plan, sheet, [read_spoken("missing")])


def with_setups(plan: Plan, change: Callable[[SetUp], SetUp]) -> Plan:
    passes = tuple(
        Pass(face=work.face, setups=tuple(change(setup) for setup in work.setups))
        for work in plan.passes
    )
    return plan.model_copy(update={"passes": passes})


def with_strokes(
    plan: Plan, change: Callable[[tuple[Stroke, ...]], tuple[Stroke, ...]], number: int = 2
) -> Plan:
    def changed(setup: SetUp) -> SetUp:
        if setup.number != number:
            return setup
        first: Operation = setup.operations[0]
        own = first.model_copy(update={"strokes": change(first.strokes)})
        return setup.model_copy(update={"operations": (own, *setup.operations[1:])})

    return with_setups(plan, changed)


def remakes_of(plan: Plan) -> Remakes:
    assert plan.remakes is not None
    return plan.remakes


def with_there(plan: Plan, change: Callable[[tuple[int, ...]], tuple[int, ...]]) -> Plan:
    remakes = remakes_of(plan)
    first = remakes.there[0]
    own = first.model_copy(update={"strokes": change(first.strokes)})
    there = (own, *remakes.there[1:])
    return plan.model_copy(update={"remakes": remakes.model_copy(update={"there": there})})


def a_stroke_that_is_there_is_planned_again(plan: Plan) -> Plan:
    origin = remakes_of(plan).origin
    hole = origin.passes[0].setups[0].operations[0].strokes[0]
    return with_strokes(plan, lambda own: (hole, *own))


def a_stroke_is_planned_twice(plan: Plan) -> Plan:
    return with_strokes(plan, lambda own: (own[0], *own))


def a_missing_stroke_is_left_out(plan: Plan) -> Plan:
    return with_strokes(plan, lambda own: own[1:])


def two_strokes_change_places(plan: Plan) -> Plan:
    return with_strokes(plan, lambda own: own[::-1])


def a_stroke_is_moved(plan: Plan) -> Plan:
    def moved(own: tuple[Stroke, ...]) -> tuple[Stroke, ...]:
        points = tuple((x + 0.5, y) for x, y in own[0].points)
        return (Stroke(points=points), *own[1:])

    return with_strokes(plan, moved)


def a_set_up_presses_harder(plan: Plan) -> Plan:
    return with_setups(plan, lambda own: own.model_copy(update={"force": own.force + 20}))


def a_stroke_is_repeated_once_more(plan: Plan) -> Plan:
    def changed(setup: SetUp) -> SetUp:
        own = [op.model_copy(update={"repeats": op.repeats + 1}) for op in setup.operations]
        return setup.model_copy(update={"operations": tuple(own)})

    return with_setups(plan, changed)


def more_is_said_to_be_there(plan: Plan) -> Plan:
    return with_there(plan, lambda own: (*own, 40))


def one_is_said_twice_to_be_there(plan: Plan) -> Plan:
    return with_there(plan, lambda own: (*own, own[0]))


def less_is_said_to_be_there(plan: Plan) -> Plan:
    return with_there(plan, lambda own: own[:-1])


def the_sheet_lies_elsewhere(plan: Plan) -> Plan:
    placed = plan.placement.model_copy(update={"dx": plan.placement.dx + 1})
    return plan.model_copy(update={"placement": placed})


def a_new_sheet_is_loaded(plan: Plan) -> Plan:
    def changed(setup: SetUp) -> SetUp:
        gates = tuple(Gate.LOAD if gate is Gate.RE_REGISTER else gate for gate in setup.gates)
        return setup.model_copy(update={"gates": gates})

    return with_setups(plan, changed)


def the_origin_is_another(plan: Plan) -> Plan:
    remakes = remakes_of(plan)
    other = remakes.origin.model_copy(update={"title": "Another"})
    return plan.model_copy(update={"remakes": remakes.model_copy(update={"origin": other})})


def the_origin_lacks_a_crease_of_the_pattern(plan: Plan) -> Plan:
    """Origin, its SHA-256 and the rest agree with each other, and not with the pattern."""
    remakes = remakes_of(plan)
    last = remakes.origin.passes[-1].setups[0].number
    origin = with_strokes(remakes.origin, lambda own: own[1:], last)
    new = {"origin": origin, "origin_sha256": origin.digest}
    own = with_strokes(plan, lambda own: own[1:], plan.passes[-1].setups[0].number)
    return own.model_copy(update={"remakes": remakes.model_copy(update=new)})


SPOILED: dict[Callable[[Plan], Plan], str] = {
    a_stroke_that_is_there_is_planned_again: "remake-stroke",
    a_stroke_is_planned_twice: "remake-stroke",
    a_missing_stroke_is_left_out: "remake-stroke",
    two_strokes_change_places: "remake-stroke",
    a_stroke_is_moved: "remake-stroke",
    a_set_up_presses_harder: "remake-stroke",
    a_stroke_is_repeated_once_more: "remake-stroke",
    more_is_said_to_be_there: "remake-there",
    one_is_said_twice_to_be_there: "remake-there",
    less_is_said_to_be_there: "remake-stroke",
    the_sheet_lies_elsewhere: "remake-setting",
    a_new_sheet_is_loaded: "wrong-gate",
    the_origin_is_another: "remake-origin",
    the_origin_lacks_a_crease_of_the_pattern: "missing-score",
}


def test_a_rest_that_was_not_touched_is_proved(rest: Plan) -> None:
    pattern = knife_job.fold().pattern
    assert prove_rule(rest, pattern) == []


@pytest.mark.parametrize("spoil", SPOILED, ids=lambda spoil: spoil.__name__)
def test_a_rest_that_was_spoiled_is_found_out(spoil: Callable[[Plan], Plan], rest: Plan) -> None:
    found = prove_rule(spoil(rest), knife_job.fold().pattern)
    assert SPOILED[spoil] in {finding.code for finding in found}


def test_programs_of_a_rest_are_proved_against_it_and_its_report_says_what_it_is(
    rest: Plan, job: Job, tmp_path: Path
) -> None:
    from foldmill_fabricate.remaking import write_remake

    written = write_remake(rest, job.path, tmp_path, ["hpgl"])
    programs = {part.name: (tmp_path / part.name).read_bytes() for part in written.programs}
    proof = verify(written, job.pattern, programs)
    assert proof.ok
    assert [f.code for f in proof.findings] == ["remakes"]
    whole = {part.name: hpgl.program(job.plan, part.setups) for part in job.plan.programs}
    found = verify(written.model_copy(update={"programs": ()}), job.pattern, whole)
    assert {"extra-line"} <= {finding.code for finding in found.findings}
