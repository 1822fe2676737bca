"""Jobs for machines that can only pull the sheet, and ways of spoiling them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Literal

from fabricate.verify.corrupt_programs import locate, read, stroke_of, with_part, with_program
from fabricate.verify.row_job import fold
from fabricate.verify.square_job import Job, recorded

from foldmill import Fold
from foldmill_fabricate import shelf
from foldmill_fabricate.formats import gcode, gpgl, hpgl
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face, Plan, Role
from foldmill_fabricate.plan import make

WRITERS: Mapping[str, Callable[[Plan, Fold], Mapping[str, bytes]]] = {
    "hpgl": hpgl.write,
    "gp-gl": gpgl.write,
    "gcode": gcode.write,
}
MATLESS = "silhouette-like-matless"


def machine(slug: str, pull: Literal["up", "down"] | None) -> Machine:
    found = shelf.machine(slug)
    tools = found.tools
    if tools.max_force is not None:
        tools = tools.model_copy(update={"max_force": 600.0})
    bed = found.bed.model_copy(update={"pull": pull})
    return found.model_copy(update={"bed": bed, "tools": tools})


@cache
def job(slug: str, pull: Literal["up", "down"] | None = "up", flip: str = "left-right") -> Job:
    made, used = fold(), machine(slug, pull)
    plan = make(made, shelf.material("pp-0.75"), used, flip=flip)  # type: ignore[arg-type]
    programs = WRITERS[used.language](plan, made)
    return recorded(Job(plan, made.pattern, programs))


def a_stroke_is_cut_the_other_way(good: Job) -> Job:
    """Turn round one score, which draws the same line."""
    name, part = locate(good, Role.SCORE, Face.REVERSE, 1)
    return with_part(good, name, part, stroke_of(good, name, part)[::-1])


def a_repeat_goes_there_and_back(good: Job) -> Job:
    """Draw both repeats of one score without lifting, as on a mat."""
    name, _ = locate(good, Role.SCORE, Face.REVERSE)
    parts = read(good.programs[name])
    part = next(k for k in range(1, len(parts), 2) if parts[k] == parts[k + 2])
    own = stroke_of(good, name, part)
    return with_part(with_part(good, name, part + 2), name, part, [*own, *own[::-1][1:]])


def the_programs_are_those_of_the_same_machine_with_a_mat(good: Job) -> Job:
    mat = machine(good.plan.machine.slug, None)
    plan = good.plan.model_copy(update={"machine": mat, "programs": ()})
    for name, data in WRITERS[mat.language](plan, fold()).items():
        good = with_program(good, name, data)
    return good


PULLED: dict[Callable[[Job], Job], str] = {
    a_stroke_is_cut_the_other_way: "pushes",
    a_repeat_goes_there_and_back: "pushes",
    the_programs_are_those_of_the_same_machine_with_a_mat: "pushes",
}
"""What is done to such a job in HP-GL, and what must be found."""
