"""What work on a job asks, and asks again, where something came between."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event, Thread

import pytest

from foldmill_fabricate.jobs import Desk, JobState, Kind, Question, Reply, Submission
from foldmill_fabricate.jobs.errors import Cancelled, Leave
from foldmill_fabricate.jobs.proving import Elsewhere
from foldmill_fabricate.jobs.work import Shop, watching, work
from foldmill_fabricate.verify import read_folder

PATIENCE = 180.0


@contextmanager
def at_work(desk: Desk) -> Iterator[None]:
    """Work on the job that is due while the context lasts; then the process ends."""
    job, token = desk.store.take("bench") or pytest.fail("nothing is due")
    leaving = Event()

    def run() -> None:
        try:
            work(Shop(desk.store, desk.plans, desk.places, leaving), job, token, plotter)
        except Leave:
            return

    plotter = desk.plotters["bench"]
    thread = Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        leaving.set()
        thread.join(PATIENCE)
        assert not thread.is_alive()


def asked(desk: Desk, *kinds: Kind) -> Question:
    """Say yes to all that is asked until it is one of these."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        for one in desk.questions():
            if one.kind in kinds:
                return one
            desk.answer(one.id, Reply(sheet=one.sheet, ok=one.kind is not Kind.TRY))
        time.sleep(0.02)
    pytest.fail("it is not asked")


@pytest.mark.long
def test_a_sheet_that_is_made_is_taken_off_though_the_service_ended_before_anybody_said_so(
    desk: Desk, plan: str
) -> None:
    job = desk.submit(Submission(plan=plan, plotter="bench")).id
    with at_work(desk):
        first = asked(desk, Kind.REMOVE)
    assert not desk.job(job).is_ended
    with at_work(desk):
        again = asked(desk, Kind.REMOVE)
        desk.answer(again.id, Reply(), "Ada")
        while not desk.job(job).is_ended:
            time.sleep(0.02)
    assert (first.sheet, first.text) == (again.sheet, again.text)
    assert desk.job(job).state is JobState.DONE
    assert len(desk.job(job).sheets) == 1
    assert [one.who for one in desk.history(job) if one.what == "remove"] == ["Ada"]


def test_a_sheet_that_was_given_up_by_hand_is_asked_about_once_and_made_anew(
    desk: Desk, plan: str
) -> None:
    desk.submit(Submission(plan=plan, plotter="bench"))
    with at_work(desk):
        gate = asked(desk, Kind.LOAD)
        desk.store.ledger.give_up(gate.sheet, "Ada")
        another = asked(desk, Kind.ANOTHER, Kind.TROUBLE)
        assert another.kind is Kind.ANOTHER, another.text
        desk.answer(another.id, Reply())
        assert asked(desk, Kind.LOAD).sheet != gate.sheet


def test_what_was_wanted_while_nobody_worked_is_heard_before_the_first_byte(
    desk: Desk, plan: str
) -> None:
    name = desk.submit(Submission(plan=plan, plotter="bench")).id
    desk.store.take("bench")
    desk.pause(name)
    job, token = desk.store.take("bench") or pytest.fail("a paused job keeps its plotter")
    with watching(Shop(desk.store, desk.plans, desk.places, Event()), job.id, token) as wish:
        assert wish.paused
        assert desk.job(name).state is JobState.PAUSED
    with watching(Shop(desk.store, desk.plans, desk.places, Event()), job.id, token - 1) as wish:
        assert wish.stopped, "a hand that has lost the job moves nothing"


def test_a_job_is_ended_while_its_plan_is_proved(job_folder: Path) -> None:
    looks = iter([None, None, Cancelled("Cancelled.")])

    def heed() -> None:
        if error := next(looks):
            raise error

    with pytest.raises(Cancelled):
        Elsewhere(heed).prove(job_folder, read_folder(job_folder))


def test_a_plotter_that_is_named_wrongly_is_asked_about(desk: Desk, plan: str) -> None:
    machine = desk.plotters["bench"].machine
    wrong = desk.plotters["bench"].model_copy(
        update={"port": f"sim://bench?machine={machine}&turbo=yes"}
    )
    desk.plotters = {"bench": wrong}
    job = desk.submit(Submission(plan=plan, plotter="bench")).id
    with at_work(desk):
        assert "turbo" in asked(desk, Kind.TROUBLE).text
        assert desk.job(job).state is JobState.NEEDS_OPERATOR
