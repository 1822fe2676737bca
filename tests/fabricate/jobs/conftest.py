"""A store in a file of its own, and a plan that is kept."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from pathlib import Path

import pytest
from fabricate.bench import small_plan
from fabricate.jobs import postgres
from fabricate.verify import knife_job

from foldmill_fabricate import folder
from foldmill_fabricate.jobs import Desk, Places
from foldmill_fabricate.jobs.plotters import Plotter

MACHINE = "generic-hpgl-600"
_NUMBERS = count()


@pytest.fixture(scope="session")
def job_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A planned square with four creases."""
    place = tmp_path_factory.mktemp("planned")
    folder.write(knife_job.fold(), small_plan(), place, ["svg", "hpgl"])
    return place


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    """The verbs, on two plotters that nobody works on."""
    names = ("bench", "other")
    plotters = {
        n: Plotter(name=n, port=f"sim://{n}?machine={MACHINE}", machine=MACHINE) for n in names
    }
    made = Desk(Places(tmp_path / "state", ""), plotters)
    yield made
    made.store.close()


@pytest.fixture
def plan(desk: Desk, job_folder: Path) -> str:
    """The id of a plan that is kept."""
    return desk.keep(job_folder)


@pytest.fixture(scope="module")
def server() -> Iterator[postgres.Server]:
    """A running PostgreSQL server."""
    assert postgres.PROGRAMS is not None
    with postgres.server(postgres.PROGRAMS) as running:
        yield running


@pytest.fixture
def database(server: postgres.Server) -> str:
    """The URL of an empty database."""
    return postgres.new_database(server, f"jobs{next(_NUMBERS)}")
