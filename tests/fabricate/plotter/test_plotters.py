"""Who is there: ports are listed unopened, and asked on a person's word only."""

from __future__ import annotations

import os
import pty
from collections.abc import Callable

import pytest
import serial

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter import ports
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]


@pytest.mark.parametrize(
    ("slug", "answer"),
    [
        ("generic-hpgl-600", "generic-hpgl-600"),
        ("grbl-laser", "Grbl 1.1f"),
        ("silhouette-like", "silhouette-like V1.00"),
    ],
)
def test_a_machine_that_is_asked_says_what_it_is_and_does_not_move(
    slug: str, answer: str, machine: Make, plugged: Plug
) -> None:
    simulator = Simulator(machine(slug))
    found = ports.asked(plugged(simulator), machine(slug))
    assert found.state == "answers"
    assert found.answer.startswith(answer)
    assert simulator.device.carriage.tally.moving == 0


def test_silence_within_two_seconds_is_told_as_silence(machine: Make, plugged: Plug) -> None:
    simulator = Simulator(machine(), faults=parse("silence@0"))
    found = ports.asked(plugged(simulator), machine())
    assert found.state.startswith("silent at 9600 baud")
    assert simulator.clock.now() < 2


def test_a_port_that_is_not_there_is_explained(machine: Make) -> None:
    found = ports.asked("/dev/no-such-port", machine())
    assert found.state.startswith("There is no port /dev/no-such-port")


def test_a_busy_port_is_explained(machine: Make) -> None:
    master, slave = pty.openpty()
    try:
        name = os.ttyname(slave)
        with open_port(name, machine(handshake="none")):
            found = ports.asked(name, machine(handshake="none"))
        assert "in use by another program" in found.state
    finally:
        os.close(master)
        os.close(slave)


def test_listing_opens_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def opened(*_: object, **__: object) -> None:
        raise AssertionError("a port was opened")

    monkeypatch.setattr(serial, "serial_for_url", opened)
    assert all(port.address and port.state for port in ports.listed())
