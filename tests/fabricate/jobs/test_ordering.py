"""A design that is ordered is planned elsewhere, within limits, and refused by its sentence."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import pytest

from foldmill.errors import InvalidInput
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.jobs import Order
from foldmill_fabricate.jobs.errors import Leave
from foldmill_fabricate.jobs.ordering import carry_out_elsewhere
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.plan_options import PlanOptions, read_options
from foldmill_fabricate.verify import verify_folder

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
        ({"family": "waterbomb", "params": {"surface": {"mesh": "/etc/passwd"}}}, "surface"),
    ],
)
def test_what_cannot_be_planned_is_refused_by_its_sentence(
    tmp_path: Path, change: dict[str, object], words: str
) -> None:
    order = STAR.model_copy(update={"preset": "", **change})
    with pytest.raises(CannotPlan, match=words):
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
