"""The ledger knows after any crash what is cut for certain, what may be, and what is left."""

from __future__ import annotations

import multiprocessing
import os
import signal
from datetime import UTC, datetime
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from foldmill_fabricate.plotter.errors import Fenced, LedgerRefused, Spoiled
from foldmill_fabricate.plotter.ledger import (
    GoesOn,
    Ledger,
    Origin,
    Program,
    Said,
    SheetRecord,
    State,
    Word,
    origins,
)
from foldmill_fabricate.plotter.ledger.values import FOLLOWS

JOB = "a" * 64
STROKES = 12
NOON = datetime(2026, 3, 1, 12, tzinfo=UTC)


@pytest.fixture
def ledger(tmp_path: Path) -> Any:
    opened = Ledger(tmp_path / "state" / "ledger.sqlite", lambda: NOON)
    yield opened
    opened.close()


def lay(ledger: Ledger, job: str = JOB) -> SheetRecord:
    programs = [
        Program("1-front-score.hpgl", "front", "b" * 64, STROKES),
        Program("2-reverse-cut.hpgl", "reverse", "c" * 64, 3),
    ]
    return ledger.lay(job, programs, title="Stool", machine="m", material="pp-0.75")


def test_every_sheet_of_a_job_has_an_id_of_its_own_that_can_be_written_on_it(
    ledger: Ledger,
) -> None:
    ids = [lay(ledger).id for _ in range(40)]
    assert len(set(ids)) == 40
    assert all(len(name) == 4 and not set(name) & set("IO01") for name in ids)


def test_a_sheet_that_was_only_laid_is_not_open_and_one_that_was_begun_is(ledger: Ledger) -> None:
    laid, begun = lay(ledger), lay(ledger)
    ledger.claim(begun.id, 0, "dev")
    assert [sheet.id for sheet in ledger.open_sheets(JOB)] == [begun.id]
    assert laid.id != begun.id


def test_a_run_that_confirmed_everything_is_done_and_never_sent_again(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    run = ledger.claim(sheet, 0, "dev")
    run.advance(STROKES, STROKES)
    run.end(State.DONE)
    assert ledger.record(sheet, 0).certain == tuple(range(STROKES))
    with pytest.raises(LedgerRefused, match="done; it is not sent again"):
        ledger.claim(sheet, 0, "dev")


def test_what_is_left_open_by_a_crash_becomes_a_persons_question(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    ledger.claim(sheet, 0, "dev").advance(7, 5)
    with pytest.raises(
        LedgerRefused, match=r"5 are cut for certain, 2 are doubtful \(numbers 6 to 7\), 5 are left"
    ):
        ledger.claim(sheet, 0, "dev")
    found = ledger.record(sheet, 0)
    assert (found.state, found.certain) == (State.INTERRUPTED, (0, 1, 2, 3, 4))
    assert (found.doubtful, found.left) == ((5, 6), (7, 8, 9, 10, 11))


def test_a_run_whose_token_was_taken_writes_nothing_more(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    old = ledger.claim(sheet, 0, "dev")
    old.advance(3, 2)
    with pytest.raises(LedgerRefused):
        ledger.claim(sheet, 0, "dev")
    with pytest.raises(Fenced, match="taken over"):
        old.advance(4, 3)
    ledger.say(sheet, 0, Said(Word.GO_ON, 2))
    ledger.claim(sheet, 0, "dev").advance(5, 4)
    with pytest.raises(Fenced):
        old.advance(9, 9)
    with pytest.raises(Fenced):
        old.end(State.DONE)
    assert ledger.record(sheet, 0).certain == (0, 1, 2, 3)


def test_going_on_is_possible_only_where_the_doubt_is(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    run = ledger.claim(sheet, 0, "dev")
    run.advance(7, 5)
    run.end(State.INTERRUPTED, "The cable is out.")
    for stroke in (0, 4, 8, 11):
        with pytest.raises(LedgerRefused, match="from stroke 6 to 8"):
            ledger.say(sheet, 0, Said(Word.GO_ON, stroke))
    with pytest.raises(LedgerRefused, match="of 5 strokes, the first of them number 8, no byte"):
        ledger.say(sheet, 0, Said(Word.FINISHED))
    assert ledger.say(sheet, 0, Said(Word.GO_ON, 6)).first == 6
    assert ledger.record(sheet, 0).certain == (0, 1, 2, 3, 4, 5)
    assert ledger.record(sheet, 0).doubtful == ()


def test_a_spoiled_sheet_is_given_up_whole(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    ledger.claim(sheet, 0, "dev").end(State.INTERRUPTED, "A crash of the head.")
    ledger.say(sheet, 0, Said(Word.SPOILED), who="Ada")
    assert {record.state for record in ledger.sheet(sheet).records} == {State.SPOILED}
    assert ledger.open_sheets() == []
    assert ledger.history(sheet)[-1] == (NOON.isoformat(timespec="milliseconds"), "Ada", "spoiled")


def test_a_sheet_that_is_given_up_while_it_is_cut_takes_the_token_from_whoever_cuts_it(
    ledger: Ledger,
) -> None:
    sheet = lay(ledger).id
    run = ledger.claim(sheet, 0, "dev")
    run.advance(4, 2)
    assert run.loss() is None
    before = ledger.sheet(sheet).digest
    ledger.give_up(sheet, "Ada")
    with pytest.raises(Spoiled, match=f"Sheet {sheet} was given up while 1-front-score.hpgl"):
        run.advance(5, 3)
    with pytest.raises(Spoiled, match=f"Sheet {sheet} was given up while 1-front-score.hpgl"):
        run.end(State.DONE)
    assert isinstance(run.loss(), Spoiled)
    found = ledger.record(sheet, 0)
    assert (found.state, found.certain, found.doubtful) == (State.SPOILED, (0, 1), (2, 3))
    assert "while it was being cut" in found.note
    assert ledger.sheet(sheet).digest == before, "what is missing can be planned"
    with pytest.raises(LedgerRefused, match="spoiled; it is not sent again"):
        ledger.claim(sheet, 0, "dev")


def test_who_only_goes_on_with_a_sheet_takes_no_token_from_whoever_cuts_it(
    ledger: Ledger, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a database that lets both look first, a run that began meanwhile is left alone."""
    sheet = lay(ledger).id
    run = ledger.claim(sheet, 0, "dev")
    run.advance(3, 2)
    place = GoesOn(sheet, ledger.sheet(sheet).digest)
    programs = [Program("1.hpgl", "front", "d" * 64, 10)]
    monkeypatch.setattr(origins, "_is_made", lambda _record: False)
    with pytest.raises(LedgerRefused, match="taken up by another just now"):
        ledger.lay("e" * 64, programs, title="Rest", machine="m", material="pp", goes_on=place)
    run.advance(4, 3)
    assert {one.state for one in ledger.sheet(sheet).records} == {State.RUNNING, State.READY}


def test_a_word_on_what_is_not_in_doubt_is_refused(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    with pytest.raises(LedgerRefused, match="is ready; there is nothing to decide"):
        ledger.say(sheet, 0, Said(Word.FINISHED))
    with pytest.raises(LedgerRefused, match="knows no sheet"):
        ledger.sheet("XXXX")
    with pytest.raises(LedgerRefused, match="has no program 6"):
        ledger.claim(sheet, 5, "dev")


def test_a_ledger_that_cannot_be_opened_is_told_of_in_a_sentence(tmp_path: Path) -> None:
    broken = tmp_path / "ledger.sqlite"
    broken.write_text("this is no database, and long enough to be read as one " * 20)
    with pytest.raises(LedgerRefused, match="Nothing is sent without it"):
        Ledger(broken)
    with pytest.raises(LedgerRefused, match="cannot be opened"):
        Ledger(broken / "below" / "a.sqlite")


def test_no_state_leads_out_of_a_spoiled_sheet_and_none_back_to_ready_by_itself() -> None:
    assert not FOLLOWS[State.SPOILED]
    assert State.READY not in FOLLOWS[State.RUNNING] | FOLLOWS[State.DONE]
    assert set(FOLLOWS) == set(State)


STEPS = st.lists(
    st.tuples(
        st.sampled_from(["claim", "advance", "crash", "end", "go on", "finished"]),
        st.integers(0, STROKES),
        st.integers(0, STROKES),
    ),
    max_size=25,
)
numbers = count()


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(STEPS)
def test_no_stroke_is_ever_begun_twice_without_a_persons_word(
    ledger: Ledger, steps: list[tuple[str, int, int]]
) -> None:
    """Against a second book that is kept by hand: which strokes the knife may have gone over."""
    sheet = lay(ledger, f"{next(numbers):064d}").id
    run = None
    over: dict[int, int] = {}  # stroke -> times a byte of it may have left
    allowed: dict[int, int] = {}  # stroke -> times a person allowed it beyond the first
    for what, one, two in steps:
        try:
            if what == "claim":
                run = ledger.claim(sheet, 0, "dev")
            elif what == "advance" and run is not None:
                sent = max(run.sent, one)
                already = range(run.sent, sent)
                run.advance(sent, min(max(two, run.first), sent))
                for stroke in already:
                    over[stroke] = over.get(stroke, 0) + 1
            elif what == "crash":
                run = None
            elif what == "end" and run is not None:
                run.end(State.DONE if run.acked == STROKES else State.INTERRUPTED)
                run = None
            elif what in {"go on", "finished"}:
                before = ledger.record(sheet, 0)
                ledger.say(sheet, 0, Said(Word(what), one))
                for stroke in range(one, before.runs[-1].sent) if what == "go on" else ():
                    allowed[stroke] = allowed.get(stroke, 0) + 1
        except (LedgerRefused, Fenced):
            pass
        found = ledger.record(sheet, 0)
        assert all(over[s] <= 1 + allowed.get(s, 0) for s in over)
        assert {*found.certain, *found.doubtful, *found.left} == set(range(STROKES))
        assert len(found.certain) + len(found.doubtful) + len(found.left) == STROKES
        assert not set(found.left) & {s for s in over if not allowed.get(s)}


def _try(place: Path, sheet: str, start: Any, won: Any) -> None:
    ledger = Ledger(place)
    start.wait()
    try:
        ledger.claim(sheet, 0, f"dev {os.getpid()}")
    except LedgerRefused:
        return
    won.put(os.getpid())


def test_of_processes_that_begin_a_program_at_once_only_one_gets_it(tmp_path: Path) -> None:
    place = tmp_path / "ledger.sqlite"
    ledger = Ledger(place)
    sheet = lay(ledger).id
    context = multiprocessing.get_context("spawn")
    start, won = context.Event(), context.Queue()
    workers = [context.Process(target=_try, args=(place, sheet, start, won)) for _ in range(4)]
    for worker in workers:
        worker.start()
    start.set()
    for worker in workers:
        worker.join()
    assert won.get()
    assert won.empty()
    ledger.close()


def _run_and_die(place: Path, sheet: str, strokes: int) -> None:
    run = Ledger(place).claim(sheet, 0, "dev")
    for stroke in range(strokes):
        run.advance(stroke + 1, stroke)
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.parametrize("strokes", [0, 1, 8, STROKES])
def test_a_killed_process_leaves_every_stroke_it_wrote_down(tmp_path: Path, strokes: int) -> None:
    place = tmp_path / "ledger.sqlite"
    ledger = Ledger(place)
    sheet = lay(ledger).id
    context = multiprocessing.get_context("spawn")
    worker = context.Process(target=_run_and_die, args=(place, sheet, strokes))
    worker.start()
    worker.join()
    assert worker.exitcode == -signal.SIGKILL
    with pytest.raises(LedgerRefused, match=r"is interrupted\. Of 12 strokes"):
        ledger.claim(sheet, 0, "dev")
    found = ledger.record(sheet, 0)
    assert found.doubtful == tuple(range(max(0, strokes - 1), strokes))
    assert found.left == tuple(range(strokes, STROKES))
    ledger.close()


def test_a_sheet_is_gone_on_with_once_and_given_up_with_that(ledger: Ledger) -> None:
    first = lay(ledger)
    run = ledger.claim(first.id, 0, "dev")
    run.advance(4, 2)
    run.end(State.INTERRUPTED)
    place = GoesOn(first.id, ledger.sheet(first.id).digest)
    programs = [Program("1-front-score.hpgl", "front", "d" * 64, 10)]
    head = {"title": "Rest", "machine": "m", "material": "pp-0.75"}
    second = ledger.lay("e" * 64, programs, **head, folder="out/rest", goes_on=place)
    assert ledger.origin(second.id) == Origin("out/rest", first.id)
    assert ledger.successor(first.id) == second
    assert ledger.sheet(first.id).records[0].state is State.SPOILED
    with pytest.raises(LedgerRefused, match=f"gone on with already, as {second.id}"):
        ledger.lay("f" * 64, programs, **head, goes_on=place)
    assert [sheet.id for sheet in ledger.open_sheets()] == []


def test_what_a_sheet_holds_has_another_digest_after_each_stroke_and_word(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    digests = [ledger.sheet(sheet).digest]
    run = ledger.claim(sheet, 0, "dev")
    for sent in range(1, 5):
        run.advance(sent, sent - 1)
        digests.append(ledger.sheet(sheet).digest)
    run.end(State.INTERRUPTED)
    ledger.say(sheet, 0, Said(Word.GO_ON, 3))
    digests.append(ledger.sheet(sheet).digest)
    assert len({*digests}) == len(digests)
    ledger.give_up(sheet)
    assert ledger.sheet(sheet).digest == digests[-1]


def test_a_rest_planned_before_the_last_stroke_is_not_laid(ledger: Ledger) -> None:
    sheet = lay(ledger).id
    run = ledger.claim(sheet, 0, "dev")
    run.advance(1, 0)
    old = ledger.sheet(sheet).digest
    run.advance(3, 2)
    programs = [Program("1.hpgl", "front", "d" * 64, 10)]
    head = {"title": "Rest", "machine": "m", "material": "pp-0.75"}
    with pytest.raises(LedgerRefused, match="is being made"):
        ledger.lay("e" * 64, programs, **head, goes_on=GoesOn(sheet, old))
    run.end(State.INTERRUPTED)
    with pytest.raises(LedgerRefused, match="not as it was"):
        ledger.lay("e" * 64, programs, **head, goes_on=GoesOn(sheet, old))
    assert ledger.successor(sheet) is None
    assert ledger.sheet(sheet).records[0].state is State.INTERRUPTED


def test_two_who_go_on_with_a_sheet_at_once_do_not_both_get_it(
    ledger: Ledger, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a database that lets both look first, the second to write is refused."""
    sheet = lay(ledger).id
    run = ledger.claim(sheet, 0, "dev")
    run.advance(3, 2)
    run.end(State.INTERRUPTED)
    place = GoesOn(sheet, ledger.sheet(sheet).digest)
    programs = [Program("1.hpgl", "front", "d" * 64, 10)]
    head = {"title": "Rest", "machine": "m", "material": "pp-0.75"}
    first = ledger.lay("e" * 64, programs, **head, goes_on=place)
    monkeypatch.setattr(origins, "successor", lambda _at, _sheet: "")
    with pytest.raises(LedgerRefused, match="gone on with by another"):
        ledger.lay("f" * 64, programs, **head, goes_on=place)
    monkeypatch.undo()
    assert ledger.successor(sheet) == first


def test_a_stroke_that_goes_on_from_inside_is_never_taken_for_one_that_nothing_is_cut_of(
    ledger: Ledger,
) -> None:
    """The power fails once more, before a byte of its rest has left."""
    sheet = lay(ledger).id
    ledger.claim(sheet, 0, "dev").advance(3, 2)
    ledger.recover(sheet, 0)
    assert ledger.say(sheet, 0, Said(Word.GO_ON, 2, vertex=5)).doubtful == (2,)
    ledger.claim(sheet, 0, "dev")
    record = ledger.recover(sheet, 0)
    assert record.doubtful == (2,)
    assert record.left == tuple(range(3, STROKES))
    with pytest.raises(LedgerRefused, match="10 strokes, the first of them number 3"):
        ledger.say(sheet, 0, Said(Word.FINISHED))
