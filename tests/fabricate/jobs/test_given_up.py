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
