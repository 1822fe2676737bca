"""A person who sees that a sheet is spoiled says so anywhere, and the machine stops at once."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from fabricate.jobs.terminal import plain, typing
from fabricate.jobs.workshop import PATIENCE, SPEED_UP, Workshop, workshop

from foldmill_fabricate.jobs import JobState, Kind, Reply
from foldmill_fabricate.plotter.ledger import State

pytestmark = pytest.mark.long

SLOW = SPEED_UP / 8
"""How much slower than in other tests: a person is quick enough to say something."""


def under_way(shop: Workshop) -> str:
    """Attend a job until its machine cuts; return the sheet."""
    shop.start()
    shop.attend(lambda: shop.simulator.sheet.under_way)
    return shop.at.job(shop.job).sheets[-1]


def asked(shop: Workshop, kinds: Sequence[Kind]) -> list[str]:
    """Return the texts of the questions of these kinds, once there is one."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = [one.text for one in shop.at.questions() if one.kind in kinds]
        if found:
            return found
        time.sleep(0.02)
    pytest.fail(shop.log())


def test_the_machine_stops_at_once_and_the_job_asks_for_another_sheet(tmp_path: Path) -> None:
    """The word comes from another process than the one that streams, in the middle of a stroke."""
    with workshop(tmp_path, speed_up=SLOW) as shop:
        sheet = under_way(shop)
        ledger = shop.at.store.ledger
        ledger.give_up(sheet, "Ada")
        sent = ledger.record(sheet, 0).runs[-1].sent
        (text,) = asked(shop, [Kind.ANOTHER, Kind.TROUBLE, Kind.DECIDE])
        shop.rest()
        record = ledger.record(sheet, 0)
        assert f"Sheet {sheet} was given up while 1-front-holes.hpgl was being cut" in text
        assert "drop what it has and to lift its tool" in text
        assert text.endswith("Is another one made in its place?")
        assert shop.at.job(shop.job).state is JobState.NEEDS_OPERATOR
        assert record.state is State.SPOILED
        assert record.runs[-1].sent == sent, "no stroke was begun after the word"
        assert len(record.left) > 0
        assert not shop.simulator.sheet.under_way, "its tool is up"
        shop.check_ledger()
        (question,) = shop.at.questions()
        shop.at.answer(question.id, Reply(ok=False))
        shop.attend(lambda: shop.is_ended)
        job = shop.at.job(shop.job)
        assert (job.state, job.note) == (JobState.FAILED, f"Sheet {sheet} was given up.")
        shop.end()


def test_a_question_about_a_sheet_that_is_given_up_is_withdrawn(tmp_path: Path) -> None:
    with workshop(tmp_path) as shop:
        shop.start()
        shop.attend(lambda: any(q.kind is Kind.TOOL for q in shop.at.questions()))
        sheet = shop.at.job(shop.job).sheets[-1]
        shop.at.store.ledger.give_up(sheet, "Ada")
        (text,) = asked(shop, [Kind.ANOTHER])
        assert text == f"Sheet {sheet} was given up. Is another one made in its place?"
        shop.end()


def test_a_test_cut_stops_too_and_nothing_of_the_part_is_cut(tmp_path: Path) -> None:
    with workshop(tmp_path, speed_up=SPEED_UP / 60) as shop:
        shop.eager = True
        sheet = under_way(shop)
        ledger = shop.at.store.ledger
        assert not ledger.sheet(sheet).is_begun, "it is the test cut"
        ledger.give_up(sheet, "Ada")
        (text,) = asked(shop, [Kind.ANOTHER, Kind.TROUBLE, Kind.JUDGE])
        assert f"Sheet {sheet} was given up while a test cut was made in it" in text
        assert "drop what it has and to lift its tool" in text
        shop.rest()
        assert not shop.simulator.sheet.under_way, "its tool is up"
        assert not ledger.sheet(sheet).is_begun
        shop.end()


def test_that_no_test_cut_was_wanted_is_on_the_record(tmp_path: Path) -> None:
    with workshop(tmp_path, speed_up=SPEED_UP) as shop:
        sheet = under_way(shop)
        happened = [what for _, _, what in shop.at.store.ledger.history(sheet)]
        declined = [what for what in happened if what.startswith("test-cut:")]
        assert declined
        assert all(what.endswith("verdict not wanted") for what in declined)
        shop.end()


def test_a_sheet_that_is_sent_by_hand_is_given_up_by_another_process(tmp_path: Path) -> None:
    with workshop(tmp_path, speed_up=SLOW) as shop:
        shop.at.cancel(shop.job)
        with typing(shop, "send", str(shop.folder), "--port", shop.port) as sender:
            sheet = answered(sender, shop)
            shop.at.store.ledger.give_up(sheet, "Ada")
            told, _ = sender.communicate(timeout=120)
        shop.rest()
        assert sender.returncode == 2, told
        assert f"Sheet {sheet} was given up while" in plain(told)
        assert "lift its tool" in plain(told)
        assert not shop.simulator.sheet.under_way
        assert shop.at.store.ledger.sheet(sheet).is_given_up


def answered(sender: subprocess.Popen[str], shop: Workshop) -> str:
    """Say yes to a sender until its machine cuts; return the sheet."""
    assert sender.stdin is not None
    sender.stdin.write("\n" * 12)
    sender.stdin.flush()
    end = time.monotonic() + PATIENCE
    while not shop.simulator.sheet.under_way:
        assert time.monotonic() < end
        time.sleep(0.02)
    return shop.at.store.ledger.open_sheets()[0].id
