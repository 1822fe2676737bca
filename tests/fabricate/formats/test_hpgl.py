"""HP-GL programs, judged by a small reader of our own, by ezdxf and by hp2xx."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from decimal import ROUND_HALF_UP, Decimal
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import hand_made
import numpy as np
import pytest
import readers
from ezdxf.addons.hpgl2.api import MergeControl, record_plotter_output
from hypothesis import given
from hypothesis import strategies as st

from foldmill import UnknownName
from foldmill_fabricate.errors import DoesNotFit
from foldmill_fabricate.formats import hpgl
from foldmill_fabricate.machines import Axes, Dialect
from foldmill_fabricate.passes import Face, Fit
from foldmill_fabricate.sheet import flipped, turned

if TYPE_CHECKING:
    from conftest import Golden

PROGRAMS = hpgl.write(hand_made.plan(), hand_made.fold())
PENS = hand_made.plan(hand_made.machine("generic-hpgl-pens"))
BOTH = {**PROGRAMS, **hpgl.write(PENS, hand_made.fold())}


def instructions(program: bytes) -> list[str]:
    return [part.strip() for part in program.decode("ascii").split(";") if part.strip()]


def strokes(program: bytes) -> Iterator[list[tuple[int, int]]]:
    """Read a program: each run of the tool from down to up, in steps."""
    at = (0, 0)
    run: list[tuple[int, int]] = []
    for instruction in instructions(program):
        numbers = [int(n) for n in re.findall(r"-?\d+", instruction[2:])]
        pairs = list(zip(numbers[::2], numbers[1::2], strict=False))
        if instruction.startswith("PU"):
            if run:
                yield run
            run, at = [], pairs[-1] if pairs else at
        elif instruction.startswith("PD"):
            run = (run or [at]) + pairs


def extent(program: bytes) -> tuple[int, int, int, int]:
    xs, ys = zip(*(xy for run in strokes(program) for xy in run), strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def on_machine(face: Face) -> tuple[float, ...]:
    """Return what a face's extent must be, mm on the carrier, worked out by hand."""
    x0, y0, x1, y1 = hand_made.plan_extent(hand_made.plan(), face)
    if face is Face.REVERSE:
        x0, x1 = hand_made.WIDTH - x1, hand_made.WIDTH - x0
    return tuple(value + hand_made.MARGIN for value in (x0, y0, x1, y1))


def test_an_operators_machine_gets_one_file_per_set_up_in_order_of_work() -> None:
    assert list(PROGRAMS) == [
        "1-front-holes.hpgl",
        "2-front-score.hpgl",
        "3-reverse-score.hpgl",
        "4-reverse-cut.hpgl",
    ]


def test_a_machine_that_selects_its_tools_gets_one_file_per_face() -> None:
    assert [(part.name, part.setups) for part in hpgl.layout(PENS)] == [
        ("front.hpgl", (1, 2)),
        ("reverse.hpgl", (3, 4)),
    ]
    tools = [i for i in instructions(hpgl.program(PENS, (3, 4))) if i.startswith("SP")]
    assert tools == ["SP2", "SP4", "SP0"]


@pytest.mark.parametrize("name", BOTH)
def test_programs_are_as_they_were(name: str, golden: Golden) -> None:
    golden.check(f"hand-made/{name}", BOTH[name])


@pytest.mark.parametrize("name", BOTH)
def test_a_program_initialises_once_and_lifts_before_it_selects(name: str) -> None:
    said = instructions(BOTH[name])
    assert BOTH[name].startswith(b"IN;DF;")
    assert said.count("IN") == 1
    for k, instruction in enumerate(said):
        if instruction.startswith("SP"):
            assert said[k - 1] == "PU"
    assert not {i[:2] for i in said} & {"LT", "LB", "PR", "SC", "IP"}


def test_speed_is_in_whole_cm_per_second_and_force_in_grams() -> None:
    assert {"VS12", "FS240"} <= set(instructions(PROGRAMS["2-front-score.hpgl"]))
    slow = hand_made.plan().passes[0].setups[0].model_copy(update={"speed": 2.0, "force": 0.2})
    assert (hpgl.speed(slow), hpgl.force(slow)) == (1, 1)


def test_a_machine_that_knows_neither_speed_nor_force_hears_of_neither() -> None:
    quiet = hand_made.machine(dialect=Dialect.model_validate({"speed": False, "force": False}))
    said = instructions(hpgl.program(hand_made.plan(quiet), (2,)))
    assert not {i[:2] for i in said} & {"VS", "FS"}


@pytest.mark.parametrize("limit", [32, 96, 240])
def test_long_lists_are_split_at_whole_pairs_without_lifting(limit: int) -> None:
    short = hand_made.plan(
        hand_made.machine(dialect=Dialect.model_validate({"max_instruction": limit}))
    )
    program = hpgl.program(short, (1,))
    assert max(len(line) for line in program.splitlines(keepends=True)) <= limit
    assert list(strokes(program)) == list(strokes(PROGRAMS["1-front-holes.hpgl"]))


def test_each_stroke_is_followed_as_often_as_its_repeats_say() -> None:
    (score,) = strokes(PROGRAMS["3-reverse-score.hpgl"])
    assert score == [(2000, 2800), (2000, 1200), (2000, 2800)]  # 100 - 60 + 10 = 50 mm
    slot, *_ = strokes(PROGRAMS["4-reverse-cut.hpgl"])
    rounds = np.hypot(*np.diff(np.array(slot), axis=0).T).sum() / 40
    assert rounds == pytest.approx(6 * 2 * (10 + 53 / 40) + 1)


def test_the_reverse_is_mirrored_and_the_front_is_not() -> None:
    for face, numbers in ((Face.FRONT, (1, 2)), (Face.REVERSE, (3, 4))):
        expected = [round(40 * mm) for mm in on_machine(face)]
        assert list(extent(hpgl.program(PENS, numbers))) == pytest.approx(expected, abs=1)


def test_turning_end_over_end_mirrors_up_and_down_instead() -> None:
    plan = hand_made.plan(kind="end-over-end")
    (score,) = strokes(hpgl.program(plan, (3,)))
    assert score == [(2800, 1200), (2800, 2800), (2800, 1200)]


def test_a_machine_that_swaps_its_axes_gets_y_first() -> None:
    swapped = hand_made.machine(axes=Axes(units_per_mm=40, swap=True))
    straight = strokes(PROGRAMS["3-reverse-score.hpgl"])
    assert [[(y, x) for x, y in run] for run in straight] == list(
        strokes(hpgl.program(hand_made.plan(swapped), (3,)))
    )


def test_measured_marks_move_the_reverse_and_leave_the_front_alone() -> None:
    plan, fit = hand_made.plan(), Fit(angle=0.5, dx=0.4, dy=0.7)
    assert hpgl.program(plan, (1,), fit) == hpgl.program(plan, (1,))
    (before,), (after,) = strokes(hpgl.program(plan, (3,))), strokes(hpgl.program(plan, (3,), fit))
    moved = 40 * (turned(np.array(before) / 40, 0.5) + np.array([0.4, 0.7]))
    assert np.abs(np.array(after) - moved).max() <= 0.5


def test_what_lies_beyond_the_firmwares_range_is_refused_with_the_missing_mm() -> None:
    small = hand_made.machine(axes=Axes(units_per_mm=40, highest=3500))
    beyond = r'Set-up 4 "reverse-cut" runs 2\.500 mm out .* 0 to 87\.5 mm'
    with pytest.raises(DoesNotFit, match=beyond):
        hpgl.program(hand_made.plan(small), (4,))
    pushed = Fit(angle=0, dx=-31, dy=0)
    with pytest.raises(DoesNotFit, match=r"1\.000 mm out"):
        hpgl.program(hand_made.plan(), (4,), pushed)


def test_a_set_up_that_is_not_in_the_plan_is_named() -> None:
    with pytest.raises(UnknownName, match=r"no set-up '7'.* 1, 2, 3, 4"):
        hpgl.program(hand_made.plan(), (7,))


def test_a_stroke_shorter_than_a_step_draws_nothing_and_repeats_no_point() -> None:
    for program in BOTH.values():
        for run in strokes(program):
            assert all(a != b for a, b in pairwise(run))
    tiny = hand_made.plan()
    score = tiny.passes[1].setups[0]
    stroke = replace(score.operations[0].strokes[0], points=((10.0, 10.0), (10.001, 10.0)))
    operation = score.operations[0].model_copy(update={"strokes": (stroke,)})
    setup = score.model_copy(update={"operations": (operation,)})
    work = tiny.passes[1].model_copy(update={"setups": (setup,)})
    program = hpgl.program(tiny.model_copy(update={"passes": (work,)}), (3,))
    assert list(strokes(program)) == []


@given(st.floats(-1e6, 1e6))
def test_halves_are_rounded_away_from_zero(value: float) -> None:
    whole = Decimal(value).quantize(Decimal(1), ROUND_HALF_UP)  # decimal's "up" is away from zero
    assert int(hpgl.half_away(value)) == int(whole)


@pytest.mark.parametrize(("value", "whole"), [(0.5, 1), (1.5, 2), (2.5, 3), (-0.5, -1), (-2.5, -3)])
def test_halves_are_not_rounded_to_even(value: float, whole: int) -> None:
    assert int(hpgl.half_away(value)) == whole


@given(
    st.lists(st.tuples(st.floats(0, 100), st.floats(0, 80)), min_size=1, max_size=9),
    st.sampled_from(sorted(hand_made.FLIP_AXIS)),
)
def test_turning_over_twice_gives_the_sheet_back_and_stays_on_it(
    points: list[tuple[float, float]], kind: str
) -> None:
    flip = hand_made.plan(kind=kind).flip
    once = flipped(points, flip)
    assert (once >= 0).all()
    assert (once <= (hand_made.WIDTH, hand_made.HEIGHT)).all()
    assert np.allclose(flipped(once, flip), points, atol=1e-12)


@pytest.mark.parametrize("name", BOTH)
def test_ezdxf_reads_the_same_extent(name: str) -> None:
    box = record_plotter_output(BOTH[name], MergeControl.NONE).bbox()
    found = (*box.extmin, *box.extmax)
    assert found == pytest.approx(extent(BOTH[name]), abs=1)


@pytest.mark.parametrize("name", BOTH)
def test_hp2xx_reads_the_same_extent(name: str, tmp_path: Path) -> None:
    found = readers.hp2xx_extent(BOTH[name], tmp_path)
    assert found == pytest.approx(extent(BOTH[name]), abs=1)
