"""What a workshop's figures say when a machine, a line or a computer does not do its part."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Event, Thread

import pytest
from fabricate.bench import Hands, small_plan
from fabricate.verify import knife_job
from prometheus_client import CollectorRegistry, generate_latest

from foldmill_fabricate import folder, shelf
from foldmill_fabricate.choosing import NEW, choose_sheet
from foldmill_fabricate.delivering import send_job
from foldmill_fabricate.jobs import Desk, Kind, Places, Question, Reply, Submission
from foldmill_fabricate.jobs.errors import Leave
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.jobs.work import Shop, work
from foldmill_fabricate.passes import Face, ProgramFile
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.sender import Progress
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.devices import adjusted
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.sending import Job, open_job
from foldmill_fabricate.service.measuring import REASONS, Measured

PATIENCE = 180.0
MACHINE = "generic-hpgl-600"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the job folder of a square with four creases."""
    place = tmp_path_factory.mktemp("made")
    folder.write(knife_job.fold(), small_plan(), place, ["svg", "hpgl"])
    return place


@pytest.fixture(scope="module")
def opened(made: Path) -> Job:
    return open_job(made)


@contextmanager
def shop(place: Path, made: Path, faults: str = "", **settings: str) -> Iterator[Desk]:
    """Give the desk of a workshop with one simulated machine and one job for it."""
    cutter = adjusted(shelf.machine(MACHINE), settings)
    url = devices.plug("watched", Simulator(cutter, faults=parse(faults) if faults else ()))
    desk = Desk(Places(place, ""), {"bench": Plotter(name="bench", port=url, machine=MACHINE)})
    desk.submit(Submission(plan=desk.keep(made), plotter="bench"))
    try:
        yield desk
    finally:
        devices.unplug(url)
        desk.store.close()


def figures(told: Measured) -> dict[str, float]:
    """Return what is told, by name and labels."""
    registry = CollectorRegistry(auto_describe=False)
    registry.register(told)
    lines = generate_latest(registry).decode().splitlines()
    rows = (re.fullmatch(r"(foldmill_\S+\{.*\}) (\S+)", line) for line in lines)
    return {row[1]: float(row[2]) for row in rows if row}


def reasons(told: Measured) -> dict[str, float]:
    """Return how many programs ended in doubt, by the reasons for which any did."""
    found = figures(told)
    name = 'foldmill_interruptions_total{{plotter="bench",reason="{}"}}'
    counts = {reason: found[name.format(reason)] for reason in REASONS}
    return {reason: count for reason, count in counts.items() if count}


def send(desk: Desk, opened: Job, busy: float = 0.0) -> Measured:
    """Send the job's one sheet, and tell of it as the work on a job does.

    busy : s for which the computer has no time for it after the tenth instruction of each program.
    """
    told, [record] = Measured(desk), desk.jobs()
    url, ledger = desk.plotters["bench"].port, desk.store.ledger
    sheet = choose_sheet(ledger, opened, tuple(Face), NEW).id

    def tell(part: ProgramFile, progress: Progress) -> None:
        told.sent(record, sheet, part, progress)
        if progress.instructions == 10:
            devices.behind(url).clock.sleep(busy)

    parts = send_job(
        opened,
        url,
        Hands(url),
        ledger=ledger,
        sheet=sheet,
        tell=tell,
    )
    try:
        for sent in parts:
            told.ended(record, sent)
    except PlotterError as error:
        told.broke_off(record, error)
    return told


@pytest.mark.parametrize(
    ("fault", "settings", "reason"),
    [
        ("overflow@400program", {}, "bytes lost"),
        ("framing@400program", {}, "bytes lost"),
        ("noise@400programx60", {"handshake": "xon-xoff"}, "bytes lost"),
        ("silence@400program", {}, "no answer"),
        ("disconnect@400program", {}, "port or machine"),
    ],
)
def test_a_program_that_ends_in_doubt_is_counted_by_its_reason(
    fault: str, settings: dict[str, str], reason: str, tmp_path: Path, made: Path, opened: Job
) -> None:
    with shop(tmp_path, made, fault, **({"handshake": "esc-b"} | settings)) as desk:
        told = send(desk, opened)
        assert reasons(told) == {reason: 1}
        assert figures(told)['foldmill_left_bytes{plotter="bench"}'] == 0


def test_work_on_a_job_tells_of_a_program_that_broke_off(tmp_path: Path, made: Path) -> None:
    with shop(tmp_path, made, "overflow@400program", handshake="esc-b") as desk:
        job, token = desk.store.take("bench") or pytest.fail("nothing is due")
        told, leaving = Measured(desk), Event()

        def run() -> None:
            with suppress(Leave):
                at = Shop(desk.store, desk.plans, desk.places, leaving, told)
                work(at, job, token, desk.plotters["bench"])

        thread = Thread(target=run)
        thread.start()
        try:
            asked = _until_trouble(desk)
            found = figures(told)
        finally:
            leaving.set()
            thread.join(PATIENCE)
        assert "the machine reports error" in asked.text
        assert reasons(told) == {"bytes lost": 1}
        assert found['foldmill_questions{kind="trouble"}'] == 1


def _until_trouble(desk: Desk) -> Question:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        for one in desk.questions():
            if one.kind is Kind.TROUBLE:
                return one
            desk.answer(one.id, Reply(sheet=one.sheet, ok=one.kind is not Kind.TRY))
        time.sleep(0.01)
    pytest.fail("it is not asked")


def test_a_job_that_goes_through_leaves_nothing_in_doubt_and_its_times_by_the_estimate(
    tmp_path: Path, made: Path, opened: Job
) -> None:
    with shop(tmp_path, made) as desk:
        told = send(desk, opened)
        found = figures(told)
        assert reasons(told) == {}
    assert found['foldmill_starved_seconds_total{plotter="bench"}'] < 0.5
    for program in opened.plan.programs:
        name = program.name.removesuffix(".hpgl").partition("-")[2]
        label = f'{{plotter="bench",set_up="{name}"}}'
        assert found[f"foldmill_set_up_time_share_count{label}"] == 1
        assert found[f"foldmill_set_up_time_share_sum{label}"] == pytest.approx(1, abs=0.3)


def test_a_computer_that_has_no_time_is_seen_as_time_that_its_machine_starves(
    tmp_path: Path, made: Path, opened: Job
) -> None:
    with shop(tmp_path, made) as desk:
        found = figures(send(desk, opened, busy=20.0))
    starved, gap = (
        found[f'foldmill_{name}{{plotter="bench"}}']
        for name in ("starved_seconds_total", "gap_seconds")
    )
    assert 15 < gap <= 20
    count = len(opened.plan.programs)
    assert 15 * count < starved <= 20 * count + 0.5
    assert found['foldmill_late_seconds{plotter="bench"}'] == 0, "a virtual clock is punctual"
