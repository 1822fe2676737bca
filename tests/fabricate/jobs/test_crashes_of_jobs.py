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

FAULTS = ("disconnect@700:2s", "power@5strokes:1s", "silence@700:20s")
KILLS = 3
"""of one sheet"""
WHOLE = 201
WHEN = ("before", "after")
AT_FIRST = {"lay", "begin-sheet", "take"}
"""points that a sheet passes once, before anything of it is cut"""
OFTEN = {"write", "move", "reply"}
FIRST = {"killed_jobs_asking": 2, "killed_jobs_blind": 5}
"""seed of the sample: of strokes that are written down, of a word that is said"""


def kills(seed: int) -> list[dict[str, object]]:
    """Return when the service dies: once by bytes, and before and after something is written.

    What is written but once comes while the sheet is new; the others once a program was cut off.
    """
    chance = random.Random(seed)
    name = [*POINTS][seed % len(POINTS)]
    often = 4 if name in OFTEN else 1
    points: list[dict[str, object]] = [
        {"point": f"{name}:{when}:{chance.randint(1, often)}"} for when in WHEN
    ]
    bytes_: dict[str, object] = {"bytes_": chance.randint(150, 600)}
    return [*points, bytes_] if name in AT_FIRST else [bytes_, *points]


def killed_and_made(shop: Workshop, seed: int) -> None:
    """Kill it as often as the seed says, and let it be made; a kill that never came is no test."""
    for how in kills(seed):
        assert shop.run(**how), (seed, how)  # type: ignore[arg-type]
        shop.check_ledger()
    assert not shop.run()
    assert shop.killed == KILLS
    shop.check_ledger()


def test_the_kills_of_a_soak_are_at_every_named_point_and_at_many_bytes() -> None:
    every = [how for seed in range(WHOLE // KILLS) for how in kills(seed)]
    named = {str(how["point"]).rpartition(":")[0] for how in every if "point" in how}
    assert named == {f"{name}:{when}" for name in POINTS for when in WHEN}
    assert len(named) >= 20
    assert len({how["bytes_"] for how in every if "bytes_" in how}) >= 20


@pytest.mark.parametrize("blind", [False, True], ids=["asks", "blind"])
def test_a_sheet_is_cut_as_planned_however_often_the_service_is_killed(
    tmp_path: Path, soak: Soak, blind: bool
) -> None:
    """With a machine that says where it is, exactly so; else but for what the person chose."""
    count = soak.size(1, WHOLE // KILLS)
    name = f"killed_jobs_{'blind' if blind else 'asking'}"
    with soak.part(name, 0, count * KILLS, "kills") as progress:
        for k in range(progress.before, count):
            seed = k + FIRST[name]
            with workshop(tmp_path / str(seed), blind=blind, seed=seed) as shop:
                killed_and_made(shop, seed)
                assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
                assert shop.difference() == (Counter(), Counter()), (seed, shop.log())
            progress.reached(k + 1)


def test_without_the_guard_a_killed_service_cuts_twice_by_itself(tmp_path: Path) -> None:
    """Were what is under way not fenced, this suite would see it."""
    with workshop(tmp_path, careless=True) as shop:
        assert shop.run(bytes_=400)
        assert shop.run(point="end:before:1")
        asked = [one.what for one in shop.at.history(shop.job)]
        assert "asks: decide" not in asked, "nobody was asked"
        twice = shop.difference()[1]
        assert twice != Counter()
        assert twice.keys() <= shop.truth.keys(), "what is too much are lines of the plan, again"


@pytest.mark.long
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


@pytest.mark.long
def test_when_the_machine_fails_the_job_asks_and_is_finished_on_a_word(
    tmp_path: Path, soak: Soak
) -> None:
    """The cable is out, its mains fail, it hangs: no job ends by that, and nothing is left out."""
    for number, fault in enumerate(FAULTS[: soak.size(1, len(FAULTS))]):
        with workshop(tmp_path / str(number)) as shop:
            shop.simulator.fail(faults.parse(fault))
            shop.run()
            shop.check_ledger()
            assert shop.at.job(shop.job).state is JobState.DONE, shop.log()
            missing, _ = shop.difference()
            assert missing == Counter()
            asked = [one.what for one in shop.at.history(shop.job)]
            assert {"asks: decide", "asks: trouble"} & {*asked}
