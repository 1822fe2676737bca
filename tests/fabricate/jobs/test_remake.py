"""What is missing on a sheet of a cancelled job is a job of its own, on the same sheet."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from fabricate.jobs.workshop import Workshop, drawn, workshop

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs import JobState, Kind, Rest
from foldmill_fabricate.jobs.errors import JobRefused

pytestmark = pytest.mark.long


def cancelled_at(shop: Workshop, setup: str) -> None:
    """Make the sheet until a set-up is due, and end the job there."""
    shop.start()

    def is_due() -> bool:
        tools = [q for q in shop.at.questions() if q.kind is Kind.TOOL]
        return shop.is_ended or any(q.setup == setup for q in tools)

    shop.attend(is_due)
    shop.at.cancel(shop.job)
    shop.attend(lambda: shop.is_ended)
    shop.end()
    shop.rest()


def test_what_is_missing_is_cut_on_the_same_sheet_and_nothing_twice(tmp_path: Path) -> None:
    with workshop(tmp_path) as shop:
        with pytest.raises(JobRefused, match="cancel it"):
            shop.at.remake(shop.job, Rest())
        cancelled_at(shop, "reverse-cut")
        (sheet,) = shop.at.job(shop.job).sheets
        assert shop.at.job(shop.job).state is JobState.CANCELLED
        before = drawn(shop.simulator)
        rest = shop.at.remake(shop.job, Rest(), "rob")
        signed = [line.who for line in shop.at.history(shop.job) if line.what == "spoiled"]
        assert (rest.who, signed) == ("rob", ["rob"])
        assert shop.at.remake(shop.job, Rest()).id == rest.id, "the rest is made once"
        shop.at.cancel(rest.id)
        idle, rest = rest, shop.at.remake(shop.job, Rest())
        assert rest.id != idle.id, "one that was ended before it was begun stands in no one's way"
        assert rest.remakes == sheet
        shop.job = rest.id
        shop.run()
        assert shop.at.job(rest.id).state is JobState.DONE, shop.log()
        assert not before - drawn(shop.simulator)
        assert shop.difference() == (Counter(), Counter())


def test_a_job_on_which_nothing_is_cut_has_no_rest(tmp_path: Path) -> None:
    with workshop(tmp_path) as shop:
        shop.at.cancel(shop.job)
        with pytest.raises(JobRefused, match="none was begun"):
            shop.at.remake(shop.job, Rest())
        with pytest.raises((JobRefused, CannotPlan)):
            shop.at.remake(shop.job, Rest(sheet="ABCD"))
