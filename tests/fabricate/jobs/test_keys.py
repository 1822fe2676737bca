"""A key gives the job it was first used for, whichever version of foldmill kept that job."""

from __future__ import annotations

import hashlib
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from foldmill_fabricate.jobs import JobRecord, JobStore, Submission
from foldmill_fabricate.jobs.errors import Clash
from foldmill_fabricate.jobs.rows import About, digest

PLAN = "0123456789abcdef" * 4
ABOUT = About("star", "pp-0.75", "generic-hpgl-600")
OF_A_PLAN = (
    f'{{"plan":"{PLAN}","design":null,"plotter":"tisch für \\"A1\\"","copies":2,"priority":-3,'
    '"remakes":""}'
)
ORDER = (
    '{"family":"rotational","preset":"star-n6","params":{"n":7},"material":"pp-0.75",'
    '"machine":"generic-hpgl-600","options":{"relief":"needed","blank":[500,400]}}'
)
OF_A_DESIGN = (
    f'{{"plan":"","design":{ORDER},"plotter":"bench","copies":1,"priority":0,"remakes":""}}'
)
"""Submissions as the first versions wrote them down to take their digest."""


class Later(Submission):
    """What a later version may ask for besides."""

    deadline: str = ""
    colours: tuple[str, ...] = ()


@pytest.fixture
def store(tmp_path: Path) -> Iterator[JobStore]:
    made = JobStore(tmp_path / "ledger.sqlite")
    yield made
    made.close()


def kept_before(store: JobStore, tmp_path: Path, text: str, order: str = "") -> JobRecord:
    """Keep a job as the first versions did."""
    job = store.submit(asked(text), ABOUT)
    with sqlite3.connect(tmp_path / "ledger.sqlite") as base:
        values = (hashlib.sha256(text.encode()).hexdigest(), order, job.id)
        base.execute('update jobs set content = ?, "order" = ? where id = ?', values)
    base.close()
    return job


def asked(text: str, **more: Any) -> Submission:
    return Submission.model_validate_json(text).model_copy(update={"key": "monday", **more})


@pytest.mark.parametrize(("text", "order"), [(OF_A_PLAN, ""), (OF_A_DESIGN, ORDER)])
def test_a_key_of_before_an_upgrade_gives_its_job(
    store: JobStore, tmp_path: Path, text: str, order: str
) -> None:
    job = kept_before(store, tmp_path, text, order)
    assert store.submit(asked(text), ABOUT).id == job.id
    assert [one.id for one in store.jobs()] == [job.id]


@pytest.mark.parametrize(("text", "order"), [(OF_A_PLAN, ""), (OF_A_DESIGN, ORDER)])
@pytest.mark.parametrize(
    "change", [{"copies": 9}, {"priority": 1}, {"plotter": "other"}, {"remakes": "ABCD"}]
)
def test_a_key_of_before_an_upgrade_is_refused_for_anything_else(
    store: JobStore, tmp_path: Path, text: str, order: str, change: dict[str, Any]
) -> None:
    kept_before(store, tmp_path, text, order)
    with pytest.raises(Clash, match="'monday' was used before"):
        store.submit(asked(text, **change), ABOUT)


def test_another_design_under_a_key_of_before_an_upgrade_is_refused(
    store: JobStore, tmp_path: Path
) -> None:
    kept_before(store, tmp_path, OF_A_DESIGN, ORDER)
    for was, now in (('"n":7', '"n":8'), ("needed", "all"), ("500", "501")):
        with pytest.raises(Clash):
            store.submit(asked(OF_A_DESIGN.replace(was, now)), ABOUT)
    with pytest.raises(Clash):
        store.submit(asked(OF_A_PLAN), ABOUT)


def test_a_version_that_knows_more_to_ask_for_knows_the_job_of_who_does_not_ask(
    store: JobStore,
) -> None:
    job = store.submit(asked(OF_A_DESIGN), ABOUT)
    later = Later.model_validate(asked(OF_A_DESIGN).model_dump())
    assert store.submit(later, ABOUT).id == job.id
    with pytest.raises(Clash):
        store.submit(later.model_copy(update={"deadline": "noon"}), ABOUT)


def test_what_is_left_out_is_the_same_as_its_default_and_names_have_no_order() -> None:
    short = Submission.model_validate({"plan": PLAN, "plotter": "bench"})
    whole = Submission.model_validate(short.model_dump())
    assert digest(short) == digest(whole)
    design = {"family": "f", "params": {"a": 1, "b": 2}, "options": {"blank": [500, 400]}}
    turned = {"options": {"blank": [500.0, 400.0]}, "params": {"b": 2, "a": 1}, "family": "f"}
    first, second = (
        Submission.model_validate({"plotter": "p", "design": d}) for d in (design, turned)
    )
    assert digest(first) == digest(second) != digest(short)
