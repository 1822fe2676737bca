"""A design that is ordered is planned elsewhere, within limits, and refused by its sentence."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path
from threading import Event, Thread

import pytest

from foldmill.errors import FoldmillError, InvalidInput
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs import Desk, JobState, Order, Submission
from foldmill_fabricate.jobs.engine import PLANNING
from foldmill_fabricate.jobs.errors import Leave
from foldmill_fabricate.jobs.host import Host
from foldmill_fabricate.jobs.ordering import carry_out, carry_out_elsewhere
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.plan_options import PlanOptions, read_options
from foldmill_fabricate.verify import verify_folder

PATIENCE = 180.0
STAR = Order(family="rotational", preset="star-n6")


def test_an_ordered_design_becomes_a_job_folder_that_verifies(tmp_path: Path) -> None:
    carry_out_elsewhere(STAR, tmp_path / "job", Event())
    assert verify_folder(tmp_path / "job").ok
    plans = Plans(tmp_path / "plans")
    assert plans.about(plans.keep(tmp_path / "job")).machine == "generic-hpgl-600"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"family": "origami"}, "origami"),
        ({"preset": "nobody"}, "nobody"),
        ({"material": "gold-leaf"}, "gold-leaf"),
        ({"options": PlanOptions(blank=(10.0, 10.0))}, "blank"),
    ],
)
def test_what_cannot_be_planned_is_refused_by_its_sentence(
    tmp_path: Path, change: dict[str, object], words: str
) -> None:
    order = STAR.model_copy(update={"preset": "", **change})
    with pytest.raises(FoldmillError, match=words):
        carry_out(order, tmp_path / "job")
    assert not (tmp_path / "job").exists()


def test_a_refusal_of_the_process_that_plans_is_heard_and_it_reads_no_file(tmp_path: Path) -> None:
    """What an order says comes from elsewhere, and may name no file of this computer."""
    mesh = {"surface": {"mesh": "/etc/passwd"}}
    order = STAR.model_copy(update={"preset": "", "family": "waterbomb", "params": mesh})
    with pytest.raises(CannotPlan, match="surface"):
        carry_out_elsewhere(order, tmp_path / "job", Event())
    assert not (tmp_path / "job").exists()


def test_options_that_there_are_not_are_refused_at_once() -> None:
    with pytest.raises(InvalidInput, match="turbo"):
        read_options({"turbo": True})


def test_planning_ends_with_the_process_that_wants_it(tmp_path: Path) -> None:
    leaving = Event()
    leaving.set()
    with pytest.raises(Leave):
        carry_out_elsewhere(STAR, tmp_path / "job", leaving)


def test_an_order_that_is_cancelled_is_planned_no_further(desk: Desk) -> None:
    host = Host(desk.places, desk.plotters)
    job = desk.submit(Submission(design=STAR, plotter="bench")).id
    planning = Thread(target=host._plan, args=(PLANNING, job))
    planning.start()
    end = time.monotonic() + PATIENCE
    while not _planners():
        assert time.monotonic() < end
        time.sleep(0.02)
    desk.cancel(job, "Ada")
    planning.join(PATIENCE)
    assert not planning.is_alive()
    assert not _planners()
    assert desk.job(job).state is JobState.CANCELLED
    assert desk.history(job)[-1].who == "Ada", "nothing has happened to it since"
    assert not desk.places.plans.exists(), "nothing came of it"
    host._held.close()


def _planners() -> list[str]:
    """Return the processes that plan for this one."""
    words = ["pgrep", "-P", str(os.getpid()), "-f", "foldmill_fabricate.jobs.ordering"]
    return subprocess.run(words, capture_output=True, text=True, check=False).stdout.split()
