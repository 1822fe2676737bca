"""Small jobs for a drag knife whose machine makes up for nothing, and ways of spoiling them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise
from math import hypot

import stools
from fabricate.verify.corrupt_programs import Steps, locate, stroke_of, with_part
from fabricate.verify.square_job import Job, recorded

from foldmill import CreasePattern, Fold
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Operation, Plan, Role, SetUp, Stroke
from foldmill_fabricate.plan import make

KNIFE = "generic-hpgl-drag-knife"
LIGHT = 20.0
"""gf at which the blade is turned out of thick sheets"""
CORNERS = [(0, 0), (120, 0), (120, 120), (0, 120), (60, 60)]
LINES = "01B 12B 23B 30B 04M 14V 24M 34V"


def fold() -> Fold:
    """A square with four creases from its middle, two of each kind."""
    edges = [(int(word[0]), int(word[1])) for word in LINES.split()]
    letters = [word[2] for word in LINES.split()]
    angles = [{"M": -90.0, "V": 90.0}.get(letter, 0.0) for letter in letters]
    return Fold(CreasePattern.from_lines(CORNERS, edges, letters, angles))


def knife(offset: float = 0.25, units: float = 40.0, **tools: object) -> Machine:
    machine = stools.machine(KNIFE)
    changed = machine.tools.model_copy(update={"blade_offset": offset, **tools})
    axes = machine.axes.model_copy(update={"units_per_mm": units, "highest": round(700 * units)})
    return machine.model_copy(update={"tools": changed, "axes": axes})


def material(swivel: float = 0.0) -> Material:
    shipped = stools.material()
    cut = shipped.cut.model_copy(update={"swivel_force": swivel})
    return shipped.model_copy(update={"cut": cut})


@cache
def job(offset: float = 0.25, swivel: float = 0.0, change: str = "operator") -> Job:
    made = fold()
    plan = make(made, material(swivel), knife(offset, change=change), blank=(260.0, 240.0))
    return recorded(Job(plan, made.pattern, hpgl.write(plan, made)))


def rewritten(good: Job, plan: Plan) -> Job:
    """Keep the plan, and take the programs of another."""
    return recorded(Job(good.plan, good.pattern, hpgl.write(plan, fold())))


def changed(plan: Plan, change: Callable[[SetUp], SetUp]) -> Plan:
    passes = tuple(
        side.model_copy(update={"setups": tuple(change(setup) for setup in side.setups)})
        for side in plan.passes
    )
    return plan.model_copy(update={"passes": passes, "programs": ()})


def _with_lead_in(good: Job, points: tuple[tuple[float, float], ...]) -> Job:
    """Change the plan, and the programs with it: only proof two can tell."""

    def change(setup: SetUp) -> SetUp:
        return setup.model_copy(update={"lead_in": points}) if setup.number == 2 else setup

    plan = changed(good.plan, change)
    return recorded(Job(plan, good.pattern, hpgl.write(plan, fold())))


def the_lead_in_is_forgotten_in_the_plan(good: Job) -> Job:
    return _with_lead_in(good, ())


def the_lead_in_is_forgotten_in_a_program(good: Job) -> Job:
    return rewritten(good, changed(good.plan, lambda s: s.model_copy(update={"lead_in": ()})))


def the_lead_in_is_too_short(good: Job) -> Job:
    (x, y), *rest = good.plan.passes[0].setups[1].lead_in
    short = ((x, y), *(((x + (u - x) / 3), y + (v - y) / 3) for u, v in rest))
    return _with_lead_in(good, short)


def the_lead_in_is_straight(good: Job) -> Job:
    """A blade that points straight against a single leg is never turned round by it."""
    x, y = good.plan.passes[0].setups[1].lead_in[0]
    return _with_lead_in(good, ((x, y), (x + 2, y), (x + 4, y)))


def the_lead_in_is_in_the_part(good: Job) -> Job:
    x, y = good.plan.sheet.width / 2 + 20, good.plan.sheet.height / 2
    return _with_lead_in(good, ((x, y), (x, y - 2), (x + 2, y - 2)))


def the_lead_in_runs_into_a_hole(good: Job) -> Job:
    hole = good.plan.holes[0]
    x, y = hole.x + 3, hole.y
    return _with_lead_in(good, ((x, y), (x, y - 2), (x + 2, y - 2)))


def the_lead_in_is_at_the_edge_of_the_blank(good: Job) -> Job:
    return _with_lead_in(good, ((0.5, 60.0), (0.5, 58.0), (2.5, 58.0)))


def the_lead_in_is_that_of_another_set_up(good: Job) -> Job:
    return _with_lead_in(good, good.plan.passes[0].setups[0].lead_in)


def the_offset_is_left_out(good: Job) -> Job:
    return rewritten(good, _for_machine(good.plan, firmware_offset=True))


def the_offset_is_another_blades(good: Job) -> Job:
    return rewritten(good, _for_machine(good.plan, blade_offset=0.45))


def the_offset_is_made_up_for_twice(good: Job) -> Job:
    """The programs are the knife's; the machine turns out to do it itself."""
    plan = _for_machine(good.plan, firmware_offset=True)
    plan = changed(plan, lambda setup: setup.model_copy(update={"lead_in": ()}))
    return recorded(Job(plan, good.pattern, good.programs))


def a_lead_in_stands_where_the_machine_needs_none(good: Job) -> Job:
    plan = _for_machine(good.plan, firmware_offset=True).model_copy(update={"programs": ()})
    return recorded(Job(plan, good.pattern, hpgl.write(plan, fold())))


def _for_machine(plan: Plan, **tools: object) -> Plan:
    machine = plan.machine
    changed_tools = machine.tools.model_copy(update=tools)
    return plan.model_copy(update={"machine": machine.model_copy(update={"tools": changed_tools})})


def the_blade_is_turned_in_the_material(good: Job) -> Job:
    """Not lifted out for it, as the plan of a thick sheet says it is."""
    plan = changed(good.plan, lambda s: s.model_copy(update={"swivel_force": 0.0}))
    return rewritten(good, plan)


def the_light_force_is_not_the_materials(good: Job) -> Job:
    def change(setup: SetUp) -> SetUp:
        heavy = 2 * LIGHT if setup.swivel_force else 0.0
        return setup.model_copy(update={"swivel_force": heavy})

    plan = changed(good.plan, change)
    return recorded(Job(plan, good.pattern, hpgl.write(plan, fold())))


def a_light_swivel_drags_the_blade_along(good: Job) -> Job:
    """Turn the first 3 mm of a cut into a motion with the light force."""
    name = good.plan.programs[-1].name
    text = good.programs[name].decode()
    at = text.index(f"FS{LIGHT:.0f};")
    start = text.index("PD", at)
    end = text.index(";", start)
    numbers = [int(word) for word in text[start + 2 : end].split(",")]
    strayed = f"{numbers[-2] + 120},{numbers[-1]}"
    data = f"{text[:end]},{strayed}{text[end:]}".encode()
    return recorded(Job(good.plan, good.pattern, {**good.programs, name: data}))


def a_score_is_overcut(good: Job) -> Job:
    def longer(operation: Operation) -> Operation:
        scored = operation.role is Role.SCORE
        return operation.model_copy(update={"overcut": 1.0}) if scored else operation

    def change(setup: SetUp) -> SetUp:
        operations = tuple(longer(operation) for operation in setup.operations)
        return setup.model_copy(update={"operations": operations})

    plan = changed(good.plan, change)
    return recorded(Job(plan, good.pattern, hpgl.write(plan, fold())))


def a_score_runs_on_past_its_end(good: Job) -> Job:
    """Both laps of it, by 1 mm: an overcut where nothing may be cut."""

    def longer(operation: Operation) -> Operation:
        if operation.role is not Role.SCORE:
            return operation
        (x, y), (u, v) = operation.strokes[0].points
        share = 1 / hypot(u - x, v - y)
        far = Stroke(points=((x, y), (u + share * (u - x), v + share * (v - y))))
        return operation.model_copy(update={"strokes": (far, *operation.strokes[1:])})

    def change(setup: SetUp) -> SetUp:
        operations = tuple(longer(operation) for operation in setup.operations)
        return setup.model_copy(update={"operations": operations})

    return rewritten(good, changed(good.plan, change))


def a_knifes_stroke_is_missing(good: Job) -> Job:
    name, part = locate(good, Role.SCORE, Face.FRONT)
    return with_part(good, name, part + 2)  # behind the lead-in and one stroke


def a_knifes_stroke_is_moved_by_a_twentieth_of_a_mm(good: Job) -> Job:
    name, part = locate(good, Role.SCORE, Face.REVERSE)
    part += 2  # behind the lead-in
    way = stroke_of(good, name, part)
    aside = max(((2, 0), (0, 2), (2, 2), (2, -2)), key=lambda step: abs(_across(way, step)))
    return with_part(good, name, part, [(x + aside[0], y + aside[1]) for x, y in way])


def _across(way: list[Steps], step: Steps) -> float:
    """Return how far a step leads away from the line between a way's farthest points, steps."""
    (x, y), (u, v) = min(way), max(way)
    return ((u - x) * step[1] - (v - y) * step[0]) / hypot(u - x, v - y)


def a_knifes_stroke_begins_with_the_blade_askew(good: Job) -> Job:
    """The arc on which the holder swings about the tip is left out of a stroke."""
    name, part = locate(good, Role.SCORE, Face.REVERSE)
    first, *way = stroke_of(good, name, part + 2)
    return with_part(good, name, part + 2, [first, *way[_straight(way) + 1 :]])


def _straight(way: list[Steps]) -> int:
    """Return which of its steps is the longest."""
    steps = [abs(a[0] - b[0]) + abs(a[1] - b[1]) for a, b in pairwise(way)]
    return steps.index(max(steps))


KNIFE_JOBS: dict[Callable[[Job], Job], str] = {
    the_lead_in_is_forgotten_in_the_plan: "lead-in-missing",
    the_lead_in_is_forgotten_in_a_program: "lead-in-missing",
    the_lead_in_is_too_short: "lead-in-short",
    the_lead_in_is_straight: "lead-in-short",
    the_lead_in_is_in_the_part: "lead-in-on-part",
    the_lead_in_runs_into_a_hole: "lead-in-place",
    the_lead_in_is_at_the_edge_of_the_blank: "lead-in-place",
    the_lead_in_is_that_of_another_set_up: "lead-in-place",
    a_lead_in_stands_where_the_machine_needs_none: "lead-in-superfluous",
    the_offset_is_left_out: "offset-left-out",
    the_offset_is_another_blades: "wrong-offset",
    the_offset_is_made_up_for_twice: "offset-twice",
    a_score_is_overcut: "overcut-on-score",
    a_score_runs_on_past_its_end: "extra-line",
    a_knifes_stroke_is_missing: "missing-stroke",
    a_knifes_stroke_is_moved_by_a_twentieth_of_a_mm: "moved",
    a_knifes_stroke_begins_with_the_blade_askew: "extra-line",
}
"""What is done to a job of a drag knife, and the finding that must name it."""

SWIVEL_JOBS: dict[Callable[[Job], Job], str] = {
    the_blade_is_turned_in_the_material: "swivel-missing",
    the_light_force_is_not_the_materials: "set-up-values",
    a_light_swivel_drags_the_blade_along: "swivel-astray",
}
"""The same for a thick sheet, whose cuts are turned at out of the material."""
