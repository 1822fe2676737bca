"""A machine that stands still for want of bytes is told of; one that is busy or paused is not."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.link import clock_of, open_port
from foldmill_fabricate.plotter.sender import Delivery, Progress, send
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.trial import fine_lines
from foldmill_fabricate.plotter.wish import Wish

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]
SLOW = fine_lines(9_000, 80)
"""Motion that takes longer than the line."""
FINE = fine_lines(9_000, 4)
"""Motion that takes less time than its bytes on a slow line."""
HANDSHAKES = ("esc-b", "xon-xoff", "none", "enq-ack", "rts-cts")


def delivered(
    cutter: Machine, plugged: Plug, program: bytes, faults: str = "", **more: Any
) -> Delivery:
    url = plugged(Simulator(cutter, faults=parse(faults) if faults else ()))
    with open_port(url, cutter) as port:
        return send(program, port, cutter, **more)


@pytest.mark.parametrize("handshake", HANDSHAKES)
@pytest.mark.parametrize("baud", [1200, 9600])
def test_the_time_beyond_the_motion_is_the_time_that_the_machine_starved(
    handshake: str, baud: int, machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake=handshake, baud=baud)
    done = delivered(cutter, plugged, FINE)
    beyond = done.seconds - done.modelled
    least = len(FINE) * 10 / baud - done.modelled
    assert done.flow.starved == pytest.approx(beyond, abs=2.5)
    assert done.flow.starved > 0.9 * least - 0.5
    assert done.flow.gap <= done.flow.starved


@pytest.mark.parametrize("handshake", [each for each in HANDSHAKES if each != "none"])
def test_a_machine_that_is_never_left_without_work_does_not_starve(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    done = delivered(machine(handshake=handshake, baud=38400), plugged, SLOW)
    assert done.flow.gap < 0.2
    assert done.flow.starved < 0.02 * done.seconds


@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff"])
@pytest.mark.parametrize("fault", ["stall@4000:20s", "slow@4000x2.5"])
def test_a_machine_that_is_slower_than_its_profile_does_not_starve(
    handshake: str, fault: str, machine: Make, plugged: Plug
) -> None:
    done = delivered(machine(handshake=handshake, baud=38400), plugged, SLOW, fault)
    assert done.seconds > done.modelled + 15
    assert done.flow.gap < 3


@pytest.mark.parametrize("handshake", HANDSHAKES)
def test_a_computer_that_is_busy_with_something_else_leaves_a_gap(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake=handshake, baud=38400)
    url = plugged(Simulator(cutter))
    with open_port(url, cutter) as port:
        clock = clock_of(port)

        def busy(progress: Progress) -> None:
            if progress.instructions == progress.of_instructions // 2:
                clock.sleep(12.0)

        done = send(SLOW, port, cutter, progress=busy)
    beyond = done.seconds - done.modelled
    assert 3 < done.flow.gap < 12
    assert beyond == pytest.approx(done.flow.starved, abs=0.5)
    assert done.flow.gap > 0.95 * done.flow.starved or handshake == "none"


def test_a_sender_that_wakes_late_says_by_how_much(machine: Make, plugged: Plug) -> None:
    cutter = machine(handshake="esc-b", baud=38400)
    simulator = Simulator(cutter)
    with open_port(plugged(simulator), cutter) as port:
        clock = clock_of(port)
        punctual = clock.sleep_until

        def late(moment: float) -> None:
            punctual(moment)
            clock.sleep(0.25)

        clock.sleep_until = late  # type: ignore[method-assign]
        done = send(SLOW, port, cutter, clock=clock)
    assert done.flow.late == pytest.approx(0.25)


def test_a_pause_that_a_person_wants_is_no_gap(machine: Make, plugged: Plug) -> None:
    cutter, wish = machine(handshake="esc-b", baud=38400), Wish()

    def pausing(progress: Progress) -> None:
        if progress.instructions == progress.of_instructions // 2:
            wish.pause()
            threading.Timer(0.2, wish.go_on).start()

    done = delivered(cutter, plugged, SLOW, progress=pausing, wish=wish)
    assert done.flow.paused > 1
    assert done.flow.gap < 0.2
    assert done.seconds - done.flow.paused < done.modelled + 5


def test_what_is_in_flight_is_never_more_than_was_sent_and_little_at_the_end(
    machine: Make, plugged: Plug
) -> None:
    cutter, seen = machine(handshake="esc-b", baud=38400), list[Progress]()
    done = delivered(cutter, plugged, SLOW, progress=seen.append)
    assert max(each.flow.in_flight for each in seen) > 100
    assert all(0 <= each.flow.in_flight <= 1.2 * each.bytes for each in seen)
    assert done.flow.in_flight < 300
