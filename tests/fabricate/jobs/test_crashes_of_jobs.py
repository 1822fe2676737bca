"""However often the service is killed, every stroke is cut as the plan and the person say.

A service in a process of its own makes a sheet on a simulated plotter that is reached over TCP. It
is killed by SIGKILL when a seeded number of bytes has reached the plotter, in the middle of an
instruction too, or at a named point around what it writes down; then it is started anew, and
somebody who can see the sheet answers what it asks.
"""

from __future__ import annotations

import random
from collections import Counter
from pathlib import Path

import pytest
from fabricate.jobs.mortal import POINTS
from fabricate.jobs.workshop import Workshop, workshop
from soaking import Soak

from foldmill_fabricate.jobs import JobState
from foldmill_fabricate.plotter.simulator import faults

KILLS = 3
"""of one sheet"""
WHOLE = 201
NAMED = [f"{name}:{when}" for name in POINTS for when in ("before", "after")]


def kills(seed: int) -> list[dict[str, object]]:
    """Return when the service dies: of each sheet once or twice by bytes, else at a point."""
    chance = random.Random(seed)
    found: list[dict[str, object]] = [{"bytes_": chance.randint(20, 1500)}]
    for k in range(1, KILLS):
        point = NAMED[(seed * (KILLS - 1) + k - 1) % len(NAMED)]
        often = chance.randint(1, 12 if point.startswith(("write", "move", "reply")) else 2)
        found.append({"point": f"{point}:{often}"})
    chance.shuffle(found)
    return found


def killed_and_made(shop: Workshop, seed: int) -> None:
    """Kill it as often as the seed says, and let it be made."""
    for how in kills(seed):
        shop.run(**how)  # type: ignore[arg-type]
        shop.check_ledger()
        if shop.is_ended:
            return
    shop.run()
    shop.check_ledger()


@pytest.mark.parametrize("blind", [False, True], ids=["asks", "blind"])
def test_a_sheet_is_cut_as_planned_however_often_the_service_is_killed(
    tmp_path: Path, soak: Soak, blind: bool
) -> None:
    """With a machine that says where it is, exactly so; else but for what the person chose."""
    count = soak.size(1, WHOLE // KILLS)
    name = f"killed_jobs_{'blind' if blind else 'asking'}"
    with soak.part(name, 0, count * KILLS, "kills") as progress:
        for seed in range(progress.before, count):
            with workshop(tmp_path / str(seed), blind=blind, seed=seed) as shop:
                killed_and_made(shop, seed)
                assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
                assert shop.difference() == (Counter(), Counter()), (seed, shop.log())
            progress.reached(seed + 1)


def test_without_the_guard_a_killed_service_cuts_twice_by_itself(tmp_path: Path) -> None:
    """Were what is under way not fenced, this suite would see it."""
    with workshop(tmp_path, careless=True) as shop:
        assert shop.run(bytes_=400)
        shop.run(point="end:before:1")
        assert shop.difference()[1] != Counter()


def test_a_service_that_is_told_to_end_stops_the_machine_and_waits_for_a_word(
    tmp_path: Path,
) -> None:
    with workshop(tmp_path) as shop:
        shop.start()
        shop.attend(lambda: shop.simulator.device.traffic.begun > 300)
        shop.end()
        shop.rest()
        assert not shop.simulator.sheet.under_way
        record = next(
            one
            for one in shop.at.store.ledger.sheet(shop.at.job(shop.job).sheets[0]).records
            if one.runs and one.state.value != "done"
        )
        assert record.state.value == "interrupted"
        shop.check_ledger()


@pytest.mark.parametrize("fault", ["disconnect@700:2s", "power@5strokes:1s", "silence@700:20s"])
def test_when_the_machine_fails_the_job_asks_and_is_finished_on_a_word(
    tmp_path: Path, fault: str
) -> None:
    """The cable is out, its mains fail, it hangs: no job ends by that, and nothing is left out."""
    with workshop(tmp_path) as shop:
        shop.simulator.fail(faults.parse(fault))
        shop.run()
        shop.check_ledger()
        assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
        missing, _ = shop.difference()
        assert missing == Counter()
        asked = [one.what for one in shop.at.history(shop.job)]
        assert {"asks: decide", "asks: trouble"} & {*asked}
