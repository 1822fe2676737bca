"""A long program reaches a small buffer whole, and the line is hardly ever idle."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.link import clock_of
from foldmill_fabricate.plotter.program import instructions
from foldmill_fabricate.plotter.sender import Delivery, Status
from foldmill_fabricate.plotter.simulator.firmware import OVERLAP
from foldmill_fabricate.plotter.simulator.trial import Trial, fine_lines, stream

Make = Callable[..., Machine]
LONG = fine_lines(200_000, 8)
FAST = {"travel_speed": 1000.0, "lift_time": 0.01}


def assert_whole(trial: Trial) -> None:
    assert trial.delivery.status.is_done
    assert trial.traffic.overruns == 0
    assert trial.identical
    assert trial.traffic.split == 0
    assert {*trial.traffic.errors} <= {OVERLAP}, "a question that met an answer is asked again"
    assert trial.traffic.errors[OVERLAP] <= 10


@pytest.mark.long
@pytest.mark.parametrize(
    ("handshake", "baud", "buffer", "acceleration"),
    [
        ("esc-b", 9600, 255, 8e4),
        ("esc-b", 115200, 1024, 1e7),
        ("xon-xoff", 9600, 255, 8e4),
        ("none", 9600, 255, 8e4),
    ],
)
def test_the_line_is_busy_at_least_98_percent_of_the_time_in_which_there_is_room(
    handshake: str, baud: int, buffer: int, acceleration: float, machine: Make
) -> None:
    cutter = machine(
        handshake=handshake, baud=baud, buffer=buffer, acceleration=acceleration, **FAST
    )
    trial = stream(LONG, cutter)
    assert_whole(trial)
    assert trial.delivery.bytes >= 200_000
    assert trial.use.utilisation >= 0.98
    assert trial.use.payload >= 0.97
    assert trial.use.busy == pytest.approx(trial.delivery.seconds, rel=0.02)


@pytest.mark.parametrize(("baud", "buffer"), [(115200, 1024), (9600, 15358), (115200, 15358)])
def test_what_fits_buffer_and_window_goes_at_once_where_motion_is_the_limit(
    baud: int, buffer: int, machine: Make
) -> None:
    pair = 3 * 11 * 10 / baud  # s: three times what it takes on the line
    tooth = 8 * 2**0.5 / 40  # mm
    cutter = machine(baud=baud, buffer=buffer, acceleration=4 * tooth / pair**2, **FAST)
    trial = stream(fine_lines(50_000, 8), cutter)
    assert_whole(trial)
    assert trial.use.utilisation >= 0.98
    assert trial.use.filling <= trial.use.utilisation
    assert trial.moving / trial.delivery.seconds > 0.99


@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff"])
def test_a_machine_that_is_slower_than_the_line_never_waits_for_it(
    handshake: str, machine: Make
) -> None:
    cutter = machine(handshake=handshake, buffer=255, acceleration=1000.0, **FAST)
    trial = stream(fine_lines(40_000, 8), cutter)
    assert_whole(trial)
    assert trial.moving / trial.delivery.seconds > 0.995
    assert trial.traffic.fullest > 255 / 2
    assert trial.use.utilisation >= 0.98


def test_a_machine_that_is_slower_than_its_model_is_not_overrun_when_it_can_answer(
    machine: Make,
) -> None:
    cutter = machine(buffer=255, acceleration=8e4, **FAST)
    assert_whole(stream(fine_lines(20_000, 8), cutter, speed_up=0.2))


def test_half_the_reserve_stays_free_whatever_the_machine_does(machine: Make) -> None:
    cutter = machine(buffer=255, acceleration=8e4, **FAST)
    trial = stream(fine_lines(20_000, 8), cutter, speed_up=0.05)
    assert_whole(trial)
    assert trial.traffic.fullest <= 255 - (63 - 2 * 15)


def careless(program: bytes, port: Any, machine: Machine) -> Delivery:
    """Write as fast as the port takes it, which is what a sender does that never asks."""
    port.write_timeout = None
    for instruction in instructions(program):
        port.write(instruction)
    port.flush()
    return Delivery(Status.UNCONFIRMED, len(program), 0, clock_of(port).now())


def test_a_sender_that_ignores_the_free_space_overruns_the_buffer(machine: Make) -> None:
    cutter = machine(buffer=255, acceleration=1000.0, **FAST)
    trial = stream(fine_lines(20_000, 8), cutter, sender=careless)
    assert trial.traffic.overruns > 1000
    assert trial.traffic.errors[16] == trial.traffic.overruns
    assert trial.traffic.fullest == 255


def test_a_machine_with_a_large_buffer_is_asked_when_it_has_made_way_and_not_before(
    machine: Make,
) -> None:
    rows = [b"PU%d,2000;PD%d,2300;" % (x, x) for x in range(2000, 10000, 40)]
    program = b"IN;SP1;" + b"".join(rows) + b"PU;SP0;"
    trial = stream(program, machine(buffer=65536))
    assert_whole(trial)
    asked = bytes(trial.traffic.received).count(b"\x1b.")
    assert asked <= 1.5 * trial.delivery.instructions
    assert trial.moving / trial.delivery.seconds > 0.995
