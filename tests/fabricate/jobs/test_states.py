"""The states of a job form one table, in the code and in the docs."""

from __future__ import annotations

from pathlib import Path

from foldmill_fabricate.jobs.states import ACTIVE, ENDED, FOLLOWS, JobState, table

DOCS = Path(__file__).parents[3] / "docs" / "jobs.md"


def test_every_state_is_reached_from_a_new_job() -> None:
    reached, more = set(), {JobState.PLANNING}
    while more:
        reached |= more
        more = {to for state in more for to in FOLLOWS[state]} - reached
    assert reached == set(JobState)


def test_a_person_can_end_every_job_that_has_not_ended() -> None:
    for state in set(JobState) - ENDED:
        assert JobState.CANCELLED in FOLLOWS[state]


def test_nothing_follows_an_end() -> None:
    assert {JobState.DONE, JobState.CANCELLED, JobState.FAILED} == ENDED
    assert not ENDED & ACTIVE


def test_the_docs_hold_the_table_of_the_code() -> None:
    assert table() in DOCS.read_text(encoding="utf-8")
