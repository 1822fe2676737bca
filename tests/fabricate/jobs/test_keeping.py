"""What somebody asks for is there as long as they may want it; what nobody asks for goes."""

from __future__ import annotations

import os
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from fabricate.bench import small_plan
from fabricate.half_made import ONE_TOOL, job_of

from foldmill_fabricate.jobs import Desk, JobState, Places, Plans, Submission
from foldmill_fabricate.jobs.errors import NoSuchJob
from foldmill_fabricate.jobs.keeping import DAY, Keeping
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.plotter.ledger import Program

ID = "0123456789abcdef" * 4
OTHER = "f" * 64
ROUNDS = 40


class Calendar:
    """A clock that goes when it is told to."""

    def __init__(self) -> None:
        self.now = 1.7e9

    def __call__(self) -> float:
        return self.now

    def pass_days(self, days: float) -> None:
        self.now += days * DAY


@pytest.fixture
def calendar() -> Calendar:
    return Calendar()


@pytest.fixture
def kept(tmp_path: Path, calendar: Calendar) -> Keeping:
    return Keeping(tmp_path / "kept", "proof", calendar)


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    bench = Plotter(name="bench", port=f"sim://{ONE_TOOL}", machine=ONE_TOOL)
    made = Desk(Places(tmp_path / "state", ""), {"bench": bench})
    yield made
    made.store.close()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return job_of(tmp_path_factory.mktemp("job"), small_plan(ONE_TOOL)).path


def put(kept: Keeping, name: str, proof: str = "proof") -> Path:
    with kept.draft() as draft:
        (draft / proof).write_text(name)
        return kept.settle(draft, name)


def make_old(plans: Path, name: str) -> None:
    os.utime(plans / name, (1.7e9, 1.7e9))


def test_what_nobody_asks_for_goes_and_what_is_asked_for_stays(
    kept: Keeping, calendar: Calendar
) -> None:
    put(kept, ID)
    put(kept, OTHER)
    calendar.pass_days(20)
    assert kept.find(OTHER) == kept.place(OTHER)
    calendar.pass_days(20)
    assert kept.throw_away(30) == [ID]
    assert kept.find(ID) is None
    assert [*kept] == [OTHER]


def test_listing_what_there_is_asks_for_nothing(kept: Keeping, calendar: Calendar) -> None:
    put(kept, ID)
    calendar.pass_days(40)
    assert [*kept] == [ID]
    assert kept.throw_away(30) == [ID]


def test_what_is_needed_stays_however_old_it_is(kept: Keeping, calendar: Calendar) -> None:
    put(kept, ID)
    calendar.pass_days(4000)
    assert kept.throw_away(30, {ID}) == []
    assert kept.find(ID) is not None


def test_to_keep_the_same_again_is_to_ask_for_it(kept: Keeping, calendar: Calendar) -> None:
    put(kept, ID)
    calendar.pass_days(29)
    put(kept, ID)
    calendar.pass_days(29)
    assert kept.throw_away(30) == []


def test_what_a_crash_has_left_half_done_is_cleared_away_and_never_found(
    kept: Keeping, calendar: Calendar
) -> None:
    (kept.root / ".draft-old").mkdir(parents=True)
    os.utime(kept.root / ".draft-old", (calendar.now, calendar.now))
    (kept.root / f".gone-{OTHER}" / "part").mkdir(parents=True)
    (kept.root / ID).mkdir()  # without its proof
    assert kept.find(ID) is None
    calendar.pass_days(2)
    (kept.root / ".draft-new").mkdir()
    os.utime(kept.root / ".draft-new", (calendar.now, calendar.now))
    assert kept.throw_away(30) == []
    assert {place.name for place in kept.root.iterdir()} == {".draft-new", ".lock", ID}
    assert put(kept, ID).joinpath("proof").read_text() == ID


@pytest.mark.parametrize("name", ["", "..", ".lock", "../kept", ID[:-1], ID.upper(), f"{ID}/"])
def test_no_name_but_a_digest_is_ever_looked_for(kept: Keeping, name: str) -> None:
    put(kept, ID)
    assert kept.find(name) is None


def test_a_job_submitted_while_things_are_thrown_away_keeps_its_plan(
    desk: Desk, folder: Path
) -> None:
    """What is needed was read before the job was there: the submission itself has asked for it."""
    plan = desk.keep(folder)
    make_old(desk.places.plans, plan)
    needed = desk.store.plans_needed()
    assert plan not in needed
    desk.submit(Submission(plan=plan, plotter="bench"))
    assert desk.plans.throw_away(1, needed) == []
    make_old(desk.places.plans, plan)
    assert desk.plans.throw_away(1, desk.store.plans_needed()) == []
    assert desk.plans.plan(plan).digest == plan


def test_whoever_comes_first_a_job_has_its_plan_or_is_refused(desk: Desk, folder: Path) -> None:
    count = 0
    for _ in range(ROUNDS):
        plan = desk.keep(folder)
        make_old(desk.places.plans, plan)
        needed = desk.store.plans_needed() - {plan}  # as it was before the jobs of earlier rounds
        another, together = Plans(desk.places.plans), threading.Barrier(2)

        def throw_away(plans: Plans = another, both: threading.Barrier = together) -> None:
            both.wait()
            plans.throw_away(1, needed)  # noqa: B023 - joined before it changes

        beside = threading.Thread(target=throw_away)
        beside.start()
        together.wait()
        try:
            desk.submit(Submission(plan=plan, plotter="bench"))
            submitted = True
        except NoSuchJob:
            submitted = False
        beside.join()
        assert (desk.places.plans / plan / "plan.json").is_file() == submitted
        count += submitted
    assert len(desk.jobs([JobState.SUBMITTED])) == count


def test_a_plan_that_only_the_record_of_a_sheet_names_is_needed(desk: Desk, folder: Path) -> None:
    plan = desk.keep(folder)
    program = Program("front.hpgl", "front", OTHER, 3)
    desk.store.ledger.lay(plan, [program], title="", machine=ONE_TOOL, material="pp-0.75")
    assert desk.store.plans_needed() == {plan}


def test_a_plan_that_was_submitted_before_is_missed_once_it_is_gone(
    desk: Desk, folder: Path
) -> None:
    plan = desk.keep(folder)
    asked = Submission(plan=plan, plotter="bench")
    desk.submit(asked)
    desk.submit(asked)
    shutil.rmtree(desk.plans.folder(plan))
    with pytest.raises(NoSuchJob, match="plan it anew"):
        desk.submit(asked)
