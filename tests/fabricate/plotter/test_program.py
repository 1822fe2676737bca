"""A program is cut into whole instructions, divided without bending its path, and timed."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.errors import ProgramRefused
from foldmill_fabricate.plotter.program import checked, instructions, ready, rechunk

Make = Callable[..., Machine]

PAIRS = st.lists(st.tuples(st.integers(0, 32767), st.integers(0, 32767)), min_size=1, max_size=60)
PATHS = st.lists(st.tuples(st.sampled_from(["PU", "PD", "PA"]), PAIRS), min_size=1, max_size=8)


def written(paths: list[tuple[str, list[tuple[int, int]]]], end: str = "\n") -> bytes:
    lists = ((name, ",".join(f"{x},{y}" for x, y in pairs)) for name, pairs in paths)
    return "".join(f"{name}{pairs};{end}" for name, pairs in lists).encode()


def stations(program: bytes) -> list[tuple[str, ...]]:
    """Every pair with the instruction it belongs to: the path, whatever it is divided into."""
    return [
        (name, *pair)
        for name, rest in re.findall(r"(P[UDA])([^;]*);", program.decode())
        for pair in re.findall(r"(\d+),(\d+)", rest)
    ]


@given(st.text("INPUD;,\n 0123456789LB\x03-", max_size=200))
def test_instructions_joined_again_are_the_program(text: str) -> None:
    assert b"".join(instructions(text.encode())) == text.encode()


@given(PATHS, st.integers(16, 120), st.sampled_from(["", "\n", "\r\n"]))
def test_dividing_long_instructions_keeps_the_path(
    paths: list[tuple[str, list[tuple[int, int]]]], limit: int, end: str
) -> None:
    program = written(paths, end)
    divided = rechunk(program, limit)
    assert stations(divided) == stations(program)
    assert max(map(len, instructions(divided))) <= limit
    assert divided.count(b";") == len(instructions(divided))
    assert rechunk(divided, limit) == divided


def test_a_label_stays_whole_up_to_its_etx() -> None:
    assert instructions(b"PU;LBa;b;\x03PD1,2;") == [b"PU;", b"LBa;b;\x03", b"PD1,2;"]


@pytest.mark.parametrize(
    ("program", "words"),
    [
        (b"", "empty"),
        (b"IN;\x1b.K", "Byte 3 of the program is 0x1B"),
        (b"IN;\x13", "0x13"),
        (b"IN;OA;", "asks the machine"),
        (b"IN;PU1,1;IN;", "IN 2 times"),
    ],
)
def test_what_must_not_reach_a_machine_is_refused(
    program: bytes, words: str, machine: Make
) -> None:
    with pytest.raises(ProgramRefused, match=words):
        checked(program, machine())


def test_a_trailing_in_is_taken_where_the_profile_wants_it(machine: Make) -> None:
    base = machine()
    dialect = base.dialect.model_copy(update={"trailer": "PU;SP0;IN;"})
    old_habit = base.model_copy(update={"dialect": dialect})
    assert checked(b"IN;PU;SP0;IN;", old_habit)


def test_half_a_pair_and_what_cannot_be_divided_are_refused(machine: Make) -> None:
    with pytest.raises(ProgramRefused, match="half a pair"):
        ready(b"PD1,2,3;", machine())
    with pytest.raises(ProgramRefused, match="half a pair"):
        rechunk(b"PD1,2,3,4,5;", 10)
    with pytest.raises(ProgramRefused, match="cannot be divided"):
        rechunk(b"PD12345,12345;", 12)


def test_an_instruction_takes_its_lift_its_ramps_and_its_way(machine: Make) -> None:
    slow = machine(travel_speed=400.0, acceleration=2000.0, lift_time=0.06)
    job = ready(b"VS10;PU4000,0;PD4000,2000;PU;", slow)
    travel = 100 / 400 + 400 / 2000
    drawn = 50 / 100 + 100 / 2000
    seconds = [part.seconds for part in job.parts]
    assert seconds == pytest.approx([0, travel, 0.06 + drawn, 0.06])


def test_a_stroke_begins_with_a_lift_and_relative_moves_add_up(machine: Make) -> None:
    job = ready(b"PU100,100;PD200,200;PD;PU300,300;PR;PD10,-5,10,-5;", machine())
    assert [part.stroke for part in job.parts] == [0, 0, 0, 1, 1, 1]
    assert job.end == (320, 290)
    assert ready(b"IN;SP1;", machine()).end is None
