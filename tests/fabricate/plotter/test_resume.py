"""The rest of a program draws what is left, with the tool set as it was; nothing is lost."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate import shelf
from foldmill_fabricate.plotter import resume
from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.plotter.program import ready
from foldmill_fabricate.verify.interpreter import Run, interpret

MACHINE = shelf.machine("generic-hpgl-pens")
spots = st.tuples(st.integers(0, 9000), st.integers(0, 9000))
strokes = st.lists(
    st.tuples(spots, st.lists(spots, min_size=1, max_size=6), st.integers(0, 2)),
    min_size=1,
    max_size=6,
)


def program(drawn: list[tuple[tuple[int, int], list[tuple[int, int]], int]]) -> bytes:
    lines = ["IN;DF;PA;", "PU;SP1;VS20;FS80;"]
    for start, onward, setting in drawn:
        if setting:
            lines.append(f"PU;SP{setting};VS{setting * 5};")
        lines.append(f"PU{start[0]},{start[1]};")
        lines += [f"PD{x},{y};" for x, y in onward]
    return "\n".join([*lines, "PU;SP0;\n"]).encode()


def drawn_by(data: bytes) -> list[Run]:
    """By the interpreter that verification uses; what begins a job anew is put in front again."""
    found = interpret(b"IN;DF;PA;\n" + re.sub(rb"\b(IN|DF|PA);", b"", data))
    assert not found.findings
    return list(found.runs)


def length(path: Sequence[Sequence[float]]) -> float:
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(path))


@given(strokes, st.data())
def test_what_was_cut_and_the_rest_are_the_whole_program(
    drawn: list[tuple[tuple[int, int], list[tuple[int, int]], int]], data: st.DataObject
) -> None:
    job = ready(program(drawn), MACHINE)
    whole = drawn_by(job.data)
    last = job.parts[-1].stroke
    stroke = data.draw(st.integers(0, last), label="stroke")
    path = resume.vertices(job, stroke)
    vertex = data.draw(st.integers(0, max(0, len(path) - 2)), label="vertex")
    left = resume.rest(job, MACHINE, 1000, resume.Start(stroke, vertex))
    found = drawn_by(left.data)
    before = len(whole) - len(found)
    assert b"IN" not in left.data
    for was, now in zip(whole[before:], found, strict=True):
        cut = vertex if was is whole[before] and path else 0
        assert now.points.tolist() == was.points[cut:].tolist()
        assert (now.tool, now.speed, now.force) == (was.tool, was.speed, was.force)
    assert left.parts[0].stroke == stroke
    assert [p for p in left.parts if p.stroke > stroke] == [
        replace(p, seconds=q.seconds)
        for p, q in zip(
            [p for p in job.parts if p.stroke > stroke],
            [q for q in left.parts if q.stroke > stroke],
            strict=True,
        )
    ]


@given(st.lists(spots, min_size=2, max_size=8, unique=True), st.floats(0, 400), st.data())
def test_an_overlap_goes_back_along_the_way_that_was_cut_and_no_further(
    path: list[tuple[int, int]], overlap: float, data: st.DataObject
) -> None:
    job = ready(program([(path[0], path[1:], 0)]), MACHINE)
    vertex = data.draw(st.integers(0, len(path) - 1))
    steps = overlap * MACHINE.axes.units_per_mm
    before = length(path[: vertex + 1])
    left = resume.rest(job, MACHINE, 1000, resume.Start(0, vertex, overlap))
    found = drawn_by(left.data)
    if vertex == len(path) - 1 and min(before, steps) < 0.5:
        return  # nothing, or less than a step, is left
    way = found[0].points.tolist()
    after = length(path[vertex:])
    assert length(way) == pytest.approx(after + min(before, steps), abs=2)
    assert way[-1] == list(map(float, path[-1]))


def test_a_lead_in_is_drawn_again_before_the_blade_goes_on() -> None:
    job = ready(program([((0, 0), [(200, 0)], 0), ((500, 500), [(900, 500)], 0)]), MACHINE)
    left = resume.rest(job, MACHINE, 1000, resume.Start(1, again=(0,)))
    assert [run.points.tolist() for run in drawn_by(left.data)] == [
        [[0, 0], [200, 0]],
        [[500, 500], [900, 500]],
    ]
    assert {part.stroke for part in left.parts} == {1, 2}


@pytest.mark.parametrize(
    ("stroke", "vertex", "sentence"),
    [(9, 0, "strokes 1 to 3, not 10"), (-1, 0, "not 0"), (1, 2, "vertices 0 to 1, not 2")],
)
def test_what_is_not_there_is_not_gone_on_from(stroke: int, vertex: int, sentence: str) -> None:
    job = ready(program([((0, 0), [(200, 0)], 0), ((500, 500), [(900, 500)], 0)]), MACHINE)
    with pytest.raises(ProgramRefused, match=sentence):
        resume.rest(job, MACHINE, 1000, resume.Start(stroke, vertex))


def test_relative_moves_are_not_gone_on_from() -> None:
    job = ready(b"IN;PA;PU10,10;PD20,20;PR;PU1,1;PD5,5;", MACHINE)
    with pytest.raises(ProgramRefused, match="relative"):
        resume.rest(job, MACHINE, 1000, resume.Start(1))


@given(strokes, st.data())
def test_what_is_left_of_a_program_counts_its_strokes_as_the_whole_does(
    drawn: list[tuple[tuple[int, int], list[tuple[int, int]], int]], data: st.DataObject
) -> None:
    """Else a second interruption would call doubtful strokes certain to be untouched."""
    job = ready(program(drawn), MACHINE)
    stroke = data.draw(st.integers(0, job.strokes - 1), label="stroke")
    left = resume.rest(job, MACHINE, 1000, resume.Start(stroke))
    assert left.strokes == job.strokes
    assert max(part.stroke for part in left.parts) == max(part.stroke for part in job.parts)
