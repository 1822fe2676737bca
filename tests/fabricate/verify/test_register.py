"""Optical marks, pins and stops: a good plan passes, and every way of spoiling it is named."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import hand_made
import pytest
from fabricate.verify import square_job

from foldmill.finding import Severity
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Plan, Role, Stroke
from foldmill_fabricate.plan import make
from foldmill_fabricate.verify import verify

Spoil = Callable[[Plan], Plan]
FLIPS = ["left-right", "end-over-end"]


def three_marks() -> Machine:
    """A strong HP-GL cutter that looks for a square and two L marks."""
    machine = hand_made.machine("graphtec-summa-like")
    marks = machine.marks.model_copy(
        update={"kinds": ("holes", "edge", "l-marks-3"), "square": 5.0, "line_width": 0.3}
    )
    return machine.model_copy(update={"slug": "three-marks", "marks": marks})


def led() -> Machine:
    """A cutter whose programs make up for the blade's offset, and which has a sensor."""
    machine = hand_made.machine("generic-hpgl-drag-knife")
    marks = hand_made.machine("graphtec-summa-like").marks
    return machine.model_copy(update={"slug": "led", "marks": marks})


MACHINES: dict[str, Callable[[], Machine]] = {
    "holes": hand_made.machine,
    "edge": hand_made.machine,
    "none": hand_made.machine,
    "l-marks": lambda: hand_made.machine("graphtec-summa-like"),
    "three": three_marks,
    "led": led,
    "pins": lambda: pinned(160.0),
}


def pinned(spacing: float) -> Machine:
    machine = hand_made.machine("flatbed-wheel-knife")
    marks = machine.marks.model_copy(update={"pin_spacing": spacing})
    return machine.model_copy(update={"marks": marks})


@cache
def made(what: str, flip: str = "left-right") -> Plan:
    kind = "l-marks" if what in {"three", "led"} else what
    return make(
        hand_made.fold(),
        hand_made.material(),
        MACHINES[what](),
        blank=(220.0, 200.0),
        flip=flip,  # type: ignore[arg-type]
        register=kind,  # type: ignore[arg-type]
    )


def errors(plan: Plan) -> set[str]:
    """What verification says of a plan whose programs are written for it as it is."""
    programs = hpgl.write(plan, hand_made.fold())
    recorded = square_job.recorded(square_job.Job(plan, hand_made.fold().pattern, programs))
    found = verify(recorded.plan, recorded.pattern, recorded.programs)
    return {each.code for each in found.findings if each.severity is Severity.ERROR}


@pytest.mark.parametrize("flip", FLIPS)
@pytest.mark.parametrize("what", MACHINES)
def test_a_plan_registered_in_this_way_passes(what: str, flip: str) -> None:
    plan = made(what, flip)
    assert plan.registration.kind == ("l-marks" if what in {"three", "led"} else what)
    assert errors(plan) == set()


def register(plan: Plan, **changes: object) -> Plan:
    return plan.model_copy(update={"registration": plan.registration.model_copy(update=changes)})


def windows(plan: Plan, change: Callable[[tuple[Stroke, ...]], tuple[Stroke, ...]]) -> Plan:
    """Change the strokes that cut marks."""
    passes = []
    for work in plan.passes:
        setups = []
        for setup in work.setups:
            operations = tuple(
                op.model_copy(update={"strokes": change(op.strokes)})
                if op.role is Role.MARK
                else op
                for op in setup.operations
            )
            setups.append(setup.model_copy(update={"operations": operations}))
        passes.append(work.model_copy(update={"setups": tuple(setups)}))
    return plan.model_copy(update={"passes": tuple(passes)})


def both(plan: Plan, number: int, **changes: object) -> Plan:
    """Change a declared mark, and cut it so."""
    from foldmill_fabricate.plan.optical import window

    marks = list(plan.registration.marks)
    before = window(marks[number])
    marks[number] = marks[number].model_copy(update=changes)
    after = window(marks[number])
    changed = register(plan, marks=tuple(marks))
    return windows(changed, lambda given: tuple(after if s == before else s for s in given))


def a_mark_is_not_cut(plan: Plan) -> Plan:
    return windows(plan, lambda strokes: strokes[1:])


def a_mark_is_cut_twice(plan: Plan) -> Plan:
    return windows(plan, lambda strokes: (*strokes, strokes[0]))


def a_mark_is_cut_a_little_beside(plan: Plan) -> Plan:
    def moved(strokes: tuple[Stroke, ...]) -> tuple[Stroke, ...]:
        beside = tuple((x + 0.1, y) for x, y in strokes[0].points)
        return (Stroke(points=beside), *strokes[1:])

    return windows(plan, moved)


def a_mark_is_too_small(plan: Plan) -> Plan:
    return both(plan, 0, size=12.0)


def a_mark_is_too_thin_to_come_out(plan: Plan) -> Plan:
    return both(plan, 0, width=0.2)


def a_mark_lies_too_near_the_edge(plan: Plan) -> Plan:
    mark = plan.registration.marks[0]
    return both(plan, 0, x=mark.x - 8.0 * mark.across)


def a_mark_is_out_of_line(plan: Plan) -> Plan:
    mark = plan.registration.marks[0]
    return both(plan, 0, x=mark.x + 0.5 * mark.across)


def marks_are_laid_out_for_the_front(plan: Plan) -> Plan:
    """As if the machine read them before the flip: every mark faces the other way."""
    for k, mark in enumerate(plan.registration.marks):
        plan = both(plan, k, across=-mark.across, x=mark.x + mark.across * mark.size)
    return plan


def a_mark_is_left_out(plan: Plan) -> Plan:
    return register(plan, marks=plan.registration.marks[1:])


def marks_are_as_far_from_every_edge(plan: Plan) -> Plan:
    """A sheet turned by 180° or not at all would show them in their places."""
    w, h = plan.sheet.width, plan.sheet.height
    for k, mark in enumerate(plan.registration.marks):
        x = 30.0 if mark.across > 0 else w - 30.0
        y = 30.0 if mark.upward > 0 else h - 30.0
        plan = both(plan, k, x=x, y=y)
    return plan


MARKS: dict[Spoil, str] = {
    a_mark_is_not_cut: "mark-strokes",
    a_mark_is_cut_twice: "mark-strokes",
    a_mark_is_cut_a_little_beside: "no-such-mark",
    a_mark_is_too_small: "mark-size",
    a_mark_is_too_thin_to_come_out: "mark-size",
    a_mark_lies_too_near_the_edge: "mark-clearance",
    a_mark_is_out_of_line: "mark-layout",
    marks_are_laid_out_for_the_front: "mark-layout",
    a_mark_is_left_out: "marks-missing",
}


def sentence(value: object) -> str:
    return str(getattr(value, "__name__", value)).replace("_", " ")


@pytest.mark.parametrize("what", ["l-marks", "three"])
@pytest.mark.parametrize(("spoil", "code"), MARKS.items(), ids=sentence)
def test_it_is_found_of_marks_that(spoil: Spoil, code: str, what: str) -> None:
    assert code in errors(spoil(made(what)))


def test_four_marks_as_far_from_every_edge_show_no_wrong_turn_and_three_do() -> None:
    assert "marks-symmetric" in errors(marks_are_as_far_from_every_edge(made("l-marks")))
    assert errors(marks_are_as_far_from_every_edge(made("three"))) == set()


def a_pin_stands_beside_its_hole(plan: Plan) -> Plan:
    (x, y), other = plan.registration.pins
    return register(plan, pins=((x + 0.4, y), other))


def a_hole_is_smaller_than_its_pin(plan: Plan) -> Plan:
    holes = (plan.holes[0].model_copy(update={"diameter": 4.0}), plan.holes[1])
    return plan.model_copy(update={"holes": holes})


def pins_stand_where_the_carrier_has_none(plan: Plan) -> Plan:
    marks = plan.machine.marks.model_copy(update={"pin_spacing": 150.0})
    machine = plan.machine.model_copy(update={"marks": marks})
    return plan.model_copy(update={"machine": machine})


def there_is_one_pin_only(plan: Plan) -> Plan:
    return register(plan, pins=plan.registration.pins[:1])


PINS: dict[Spoil, str] = {
    a_pin_stands_beside_its_hole: "pin-place",
    a_hole_is_smaller_than_its_pin: "hole-diameter",
    pins_stand_where_the_carrier_has_none: "pin-spacing",
    there_is_one_pin_only: "pin-place",
}


@pytest.mark.parametrize("flip", FLIPS)
@pytest.mark.parametrize(("spoil", "code"), PINS.items(), ids=sentence)
def test_it_is_found_of_pins_that(spoil: Spoil, code: str, flip: str) -> None:
    assert code in errors(spoil(made("pins", flip)))


def a_stop_stands_off_the_edge(plan: Plan) -> Plan:
    first, *others = plan.registration.stops
    return register(
        plan, stops=(first.model_copy(update={"y": first.y - 3, "x": first.x - 3}), *others)
    )


def another_edge_is_the_datum_after_the_flip(plan: Plan) -> Plan:
    """The stop stays on its side although the edge goes to the other: the blank's size counts."""
    back = {"right": "left", "top": "bottom"}
    sheet, stops = plan.sheet, []
    for stop in plan.registration.stops:
        if stop.edge in back:
            x = sheet.dx if stop.edge == "right" else stop.x
            y = sheet.dy if stop.edge == "top" else stop.y
            stop = stop.model_copy(update={"edge": back[stop.edge], "x": x, "y": y})
        stops.append(stop)
    return register(plan, stops=tuple(stops))


def a_pass_has_two_stops_only(plan: Plan) -> Plan:
    return register(plan, stops=plan.registration.stops[:-1])


def stops_are_left_in_a_plan_with_holes(plan: Plan) -> Plan:
    return register(plan, kind="none")


STOPS: dict[Spoil, str] = {
    a_stop_stands_off_the_edge: "stop-place",
    another_edge_is_the_datum_after_the_flip: "stop-edge",
    a_pass_has_two_stops_only: "stop-count",
    stops_are_left_in_a_plan_with_holes: "stop-place",
}


@pytest.mark.parametrize("flip", FLIPS)
@pytest.mark.parametrize(("spoil", "code"), STOPS.items(), ids=sentence)
def test_it_is_found_of_stops_that(spoil: Spoil, code: str, flip: str) -> None:
    assert code in errors(spoil(made("edge", flip)))


def test_a_plan_that_registers_by_what_its_machine_cannot_do_is_refused() -> None:
    plan = made("pins").model_copy(update={"machine": hand_made.machine()})
    assert "registration-kind" in errors(plan)


def test_a_plan_that_keeps_silent_about_missing_registration_is_refused() -> None:
    assert "unregistered" in errors(made("none").model_copy(update={"findings": ()}))
