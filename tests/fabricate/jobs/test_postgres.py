"""Jobs and ledger in PostgreSQL, on a real server: the same rules, crashes and sheets."""

from __future__ import annotations

from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event

import pytest
from fabricate.jobs import postgres
from fabricate.jobs.workshop import workshop
from sqlalchemy import func, select

from foldmill_fabricate.jobs import Desk, JobState, Places, Submission, rows
from foldmill_fabricate.jobs.errors import Clash, JobRefused
from foldmill_fabricate.jobs.host import Host
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.jobs.tables import JOBS
from foldmill_fabricate.plotter.ledger.tables import reading

pytestmark = postgres.NEEDED
MACHINE = "generic-hpgl-600"


def test_a_sheet_is_cut_as_planned_though_the_service_is_killed(
    tmp_path: Path, database: str
) -> None:
    with workshop(tmp_path, database=database) as shop:
        assert shop.run(bytes_=600)
        shop.check_ledger()
        shop.run()
        assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
        assert shop.difference() == (Counter(), Counter())


def test_the_queue_keeps_its_order_and_its_keys(
    tmp_path: Path, database: str, job_folder: Path
) -> None:
    plotter = Plotter(name="bench", port=f"sim://{MACHINE}", machine=MACHINE)
    desk = Desk(Places(tmp_path, database), {"bench": plotter})
    asked = Submission(plan=desk.keep(job_folder), plotter="bench", key="k")
    with ThreadPoolExecutor(4) as pool:
        names = set(pool.map(lambda _: desk.submit(asked).id, range(12)))
    assert len(names) == 1
    with pytest.raises(Clash):
        desk.submit(asked.model_copy(update={"copies": 2}))
    urgent = desk.submit(asked.model_copy(update={"key": "", "priority": 3})).id
    with ThreadPoolExecutor(4) as pool:
        taken = [one for one in pool.map(lambda _: desk.store.take("bench"), range(4)) if one]
    assert {job.id for job, _ in taken} == {urgent}
    tokens = [token for _, token in taken]
    assert len(set(tokens)) == len(tokens), "no two hands hold one token"
    desk.store.close()


def test_a_computer_without_a_name_is_refused(tmp_path: Path, database: str) -> None:
    with pytest.raises(JobRefused, match="--host-name"):
        Host(Places(tmp_path, database), {})


def test_no_event_is_missed_by_who_follows_while_many_write(tmp_path: Path, database: str) -> None:
    desk, heard = Desk(Places(tmp_path, database), {}), list[int]()
    store, rounds, over = desk.store, 40, Event()

    def write(name: str) -> None:
        for k in range(rounds):
            store.prioritise(name, k)

    def follow() -> None:
        while True:
            last = over.is_set()
            heard.extend(each.number for each in store.events(heard[-1] if heard else 0))
            if last:
                return

    about = rows.About(title="a", material="b", machine="c")
    asked = Submission(plan="0" * 64, plotter="bench")
    names = [store.submit(asked, about).id for _ in range(4)]
    with ThreadPoolExecutor(5) as several:
        following = several.submit(follow)
        for each in [several.submit(write, name) for name in names]:
            each.result()
        over.set()
        following.result()
    desk.store.close()
    assert len(heard) == len(set(heard)) == len(names) * (1 + rounds)


def test_what_is_read_in_one_go_is_of_one_moment(tmp_path: Path, database: str) -> None:
    """Else a sheet that ends between two statements is listed as one that is under work."""
    store = Desk(Places(tmp_path, database), {}).store
    about = rows.About(title="a", material="b", machine="c")
    asked = Submission(plan="0" * 64, plotter="bench")
    store.submit(asked, about)
    with reading(store._engine) as at:
        assert at.execute(select(func.count()).select_from(JOBS)).scalar() == 1
        store.submit(asked, about)
        assert at.execute(select(func.count()).select_from(JOBS)).scalar() == 1
    assert len(store.jobs()) == 2
    store.close()
