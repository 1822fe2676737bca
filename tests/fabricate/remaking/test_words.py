"""What a person says of strokes in doubt is read, and never guessed."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Face, Role, SetUp, Stroke
from foldmill_fabricate.plotter.ledger import Entry, Program, Record, SheetRecord, State
from foldmill_fabricate.remaking.strokes import Account, standings
from foldmill_fabricate.remaking.words import Fate, Spoken, listed, read_spoken, settled

SETUP = SetUp(
    number=1,
    name="front-score",
    process="score",
    tool=0,
    exposure=0.4,
    force=100,
    speed=100,
    gates=(),
    operations=(),
)


def sheet(*runs: Entry) -> tuple[SheetRecord, list[Account]]:
    """Of each run a program of ten strokes."""
    records = tuple(
        Record(
            "ABCD",
            k,
            Program(f"{k + 1}.hpgl", "front", "", 10),
            State.INTERRUPTED,
            *(0, 0, 0.0, ""),
            (run,),
        )
        for k, run in enumerate(runs)
    )
    line = Stroke(points=((0.0, 0.0), (1.0, 0.0)))
    found = [
        Account(Face.FRONT, SETUP, Role.SCORE, k + 1, line, record.number, {k: how})
        for record in records
        for k, how in enumerate(standings(record))
    ]
    return SheetRecord("ABCD", "", "", "", "", "", records), found


ONE = sheet(Entry(1, 0, 0, 7, 3))
TWO = sheet(Entry(1, 0, 0, 7, 3), Entry(1, 0, 0, 2, 0))


@given(st.sets(st.integers(0, 60), min_size=1))
def test_numbers_are_read_as_they_are_written(strokes: set[int]) -> None:
    assert read_spoken(listed(strokes)) == Spoken(Fate.MISSING, frozenset(strokes), Fate.CUT)


@pytest.mark.parametrize("text", ["", "0", "3-1", "a", "1;2", "1,,2", "-3", "1-9999999", "x:", "½"])
def test_what_names_no_stroke_is_refused(text: str) -> None:
    with pytest.raises(CannotPlan, match="names no strokes"):
        read_spoken(text)


def test_the_numbers_named_are_missing_and_the_others_in_doubt_are_cut() -> None:
    fates = settled(*ONE, [read_spoken("5-6")])
    assert {k: fate for (_, k), fate in fates.items()} == {
        3: Fate.CUT,
        4: Fate.MISSING,
        5: Fate.MISSING,
        6: Fate.CUT,
    }


@pytest.mark.parametrize("text", ["4,8", "1", "3,4"])
def test_of_what_is_certain_or_left_nothing_can_be_said(text: str) -> None:
    with pytest.raises(CannotPlan, match="In doubt are 4-7"):
        settled(*ONE, [read_spoken(text)])


def test_silence_on_one_stroke_is_told_with_its_number() -> None:
    said = Spoken(Fate.CUT, frozenset({3, 4, 6}))
    with pytest.raises(CannotPlan, match=r"1\.hpgl: 6\. Look at the sheet"):
        settled(*ONE, [said])


def test_a_stroke_is_not_two_things() -> None:
    with pytest.raises(CannotPlan, match=r"Stroke 5 of 1\.hpgl is said to be two things"):
        settled(*ONE, [read_spoken("5"), read_spoken("5", Fate.HALF)])


def test_where_several_programs_are_in_doubt_each_is_named() -> None:
    with pytest.raises(CannotPlan, match=r"1\.hpgl, 2\.hpgl. Say of which"):
        settled(*TWO, [read_spoken("missing")])
    with pytest.raises(CannotPlan, match=r"may be cut or not: 2\.hpgl: 1-2"):
        settled(*TWO, [read_spoken("1.hpgl:cut")])
    with pytest.raises(CannotPlan, match=r"no program 'front'"):
        settled(*TWO, [read_spoken("front:cut")])
    fates = settled(*TWO, [read_spoken("1.hpgl:cut"), read_spoken("2.hpgl:2")])
    assert [fates[1, 0], fates[1, 1]] == [Fate.CUT, Fate.MISSING]
    assert {fate for (number, _), fate in fates.items() if number == 0} == {Fate.CUT}


def test_a_stroke_that_was_gone_on_with_from_inside_is_never_wholly_missing() -> None:
    half = sheet(Entry(2, 3, 4, 5, 3))
    fates = settled(*half, [read_spoken("missing")])
    assert fates == {(0, 3): Fate.HALF, (0, 4): Fate.MISSING}
    assert settled(*half, [read_spoken("cut")])[0, 3] is Fate.CUT
