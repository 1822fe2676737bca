"""The interpreter reads HP-GL as a plotter does, and says what is wrong in it."""

from __future__ import annotations

import numpy as np
import pytest

from foldmill_fabricate.verify.interpreter import Trace, interpret

GOOD = b"IN;DF;PA;PU;SP2;VS12;FS240;PU100,200;PD100,400,300,400;PU500,0;PD600,0;PU;SP0;"


def codes(program: bytes) -> list[str]:
    return [finding.code for finding in interpret(program).findings]


def drawn(trace: Trace) -> list[list[list[float]]]:
    return [run.points.tolist() for run in trace.runs]


def test_a_program_draws_what_lies_between_pen_down_and_pen_up() -> None:
    trace = interpret(GOOD)
    assert not trace.findings
    assert drawn(trace) == [[[100, 200], [100, 400], [300, 400]], [[500, 0], [600, 0]]]
    assert [(run.tool, run.speed, run.force) for run in trace.runs] == [(2, 120.0, 240.0)] * 2
    assert GOOD[trace.runs[1].byte :].startswith(b"PD600")


@pytest.mark.parametrize(
    "spelling",
    [
        GOOD.replace(b";", b";\r\n"),
        GOOD.replace(b"PD100,400,300,400;", b"PD100,400;PD300,400;"),
        GOOD.replace(b"PD100,400,300,400;", b"PD;PA100,400,300,400;"),
        GOOD.replace(b"PD100,400,300,400;", b"PD;PR0,200,200,0;PA;"),
        GOOD.replace(b"PD100,400,300,400;", b"pd 100 400, +300 400;"),
        GOOD.replace(b";", b""),
        GOOD.replace(b"PU;SP0;", b"PU;;SP;"),
    ],
)
def test_other_spellings_draw_the_same(spelling: bytes) -> None:
    trace = interpret(spelling)
    assert not trace.findings
    assert drawn(trace) == drawn(interpret(GOOD))


@pytest.mark.parametrize(
    ("code", "good", "bad"),
    [
        ("unknown-instruction", b"FS240", b"LT2,4"),
        ("unknown-instruction", b"FS240", b"FS240;CI50"),
        ("syntax", b"IN;", b"IN;\x1b.(;"),
        ("syntax", b"100,400", b"100,,400"),
        ("syntax", b"PD600,0", b"PD600,0,"),
        ("syntax", b"VS12", b"VS12,1"),
        ("syntax", b"SP2", b"SP2.5"),
        ("odd-coordinates", b"PD600,0", b"PD600"),
        ("not-whole", b"PD600,0", b"PD600.5,0"),
        ("second-initialise", b"PU500", b"PU;IN;SP2;PU500"),
        ("no-initialise", b"IN;", b""),
        ("no-tool", b"SP2;", b""),
        ("no-position", b"PU100,200;", b""),
        ("tool-change-down", b"PD600,0;", b"PD600,0;SP3;"),
        ("pen-left-down", b"PU;SP0;", b""),
    ],
)
def test_a_faulty_program_is_named_with_its_fault(code: str, good: bytes, bad: bytes) -> None:
    assert good in GOOD
    program = GOOD.replace(good, bad, 1)
    assert code in codes(program)


def test_a_fault_is_told_with_the_byte_it_stands_at() -> None:
    program = GOOD.replace(b"FS240", b"XX240")
    (finding,) = interpret(program, "front.hpgl").findings
    assert finding.where == f"front.hpgl, byte {program.index(b'XX')}"


def test_a_machine_with_one_tool_for_all_needs_no_tool_number() -> None:
    program = GOOD.replace(b"SP2;", b"")
    assert {finding.code for finding in interpret(program).findings} == {"no-tool"}
    assert not interpret(program, selects=False).findings


def test_a_change_of_speed_on_the_way_begins_a_new_run() -> None:
    trace = interpret(GOOD.replace(b"PD100,400,300,400", b"PD100,400;VS5;PD300,400"))
    assert [run.speed for run in trace.runs] == [120.0, 50.0, 50.0]
    assert np.array_equal(trace.runs[0].points[-1], trace.runs[1].points[0])
