"""Several simulated plotters in one process, over every kind of wire, and watched in a terminal."""

from __future__ import annotations

import io
import socket
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import serial
from rich.console import Console

from foldmill import FoldmillError
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import Status, as_sent, send
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.offers import Offer, offer, served
from foldmill_fabricate.plotter.simulator.rfc2217 import serve_rfc2217
from foldmill_fabricate.plotter.simulator.run import run
from foldmill_fabricate.plotter.simulator.servers import serve_pty, serve_tcp
from foldmill_fabricate.plotter.simulator.trial import fine_lines, without_questions
from foldmill_fabricate.plotter.simulator.view import table

Make = Callable[..., Machine]
PROGRAM = fine_lines(3_000, 8)
DAEMON = pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")  # pyserial's own
COMMON = {"machine": "generic-hpgl-600"}


def until(true: Callable[[], bool], seconds: float = 10.0) -> bool:
    """Wait in real time until something is true."""
    clock = RealClock()
    deadline = clock.now() + seconds
    while not true() and clock.now() < deadline:
        clock.sleep(0.02)
    return true()


def fails(port: Any) -> bool:
    """Whether a port is dead; pyserial has several errors that say so."""
    try:
        port.write(b"\x1b.B")
        port.read(1)
    except OSError:
        return True
    return False


@DAEMON
@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff"])
def test_a_program_arrives_byte_for_byte_over_a_network_serial_port(
    handshake: str, machine: Make
) -> None:
    cutter = machine(handshake=handshake, baud=57600, buffer=255, acceleration=1e6, lift_time=0.01)
    simulator = Simulator(cutter, clock=RealClock())
    with serve_rfc2217(simulator) as url, open_port(url, cutter) as port:
        delivery = send(PROGRAM, port, cutter)
    traffic = simulator.device.traffic
    assert delivery.status.is_done
    assert traffic.overruns == 0
    assert without_questions(bytes(traffic.program)) == as_sent(PROGRAM, cutter)


@DAEMON
def test_a_network_serial_port_carries_the_handshake_lines_and_the_rate(machine: Make) -> None:
    cutter = machine(handshake="dtr", buffer=255, baud=19200)
    simulator = Simulator(cutter, clock=RealClock(), speed_up=100)
    with serve_rfc2217(simulator) as url, serial.serial_for_url(url, baudrate=19200) as port:
        assert until(lambda: port.dsr)
        simulator.pause()
        port.write(b"PU1,1;" * 40)
        assert until(lambda: not port.dsr)
        assert port.cts
        simulator.resume()
        assert until(lambda: port.dsr)
        port.rts = False
        assert until(lambda: not simulator.modem.rts)
        port.baudrate = 9600
        assert until(lambda: simulator.baud == 9600)


def test_when_the_cable_is_pulled_a_serial_port_fails_and_comes_back(
    machine: Make, tmp_path: Path
) -> None:
    cutter, link = machine(baud=115200), tmp_path / "plotter"
    simulator = Simulator(cutter, clock=RealClock(), speed_up=50)
    with serve_pty(simulator, link) as path:
        with open_port(path, cutter) as port:
            simulator.fail(parse("disconnect@0:0.5s"))
            assert until(lambda: not link.is_symlink())
            assert until(lambda: fails(port))
        assert until(link.is_symlink)
        with open_port(path, cutter) as port:
            assert send(b"IN;SP1;PD40,40;PU;", port, cutter).status is Status.EXECUTED


def test_when_the_cable_is_pulled_a_tcp_user_is_sent_away(machine: Make) -> None:
    cutter = machine(baud=115200)
    simulator = Simulator(cutter, clock=RealClock(), speed_up=50)
    with serve_tcp(simulator) as url:
        host, number = url.removeprefix("socket://").split(":")
        with socket.create_connection((host, int(number)), timeout=10) as user:
            user.sendall(b"OA;")
            assert user.recv(1) == b"0"
            simulator.fail(parse("disconnect@0:0.3s"))
            while user.recv(100):
                pass
        assert until(lambda: not simulator.unplugged)
        with open_port(url, cutter) as port:
            assert send(b"IN;SP1;PD40,40;PU;", port, cutter).status is Status.EXECUTED


def test_several_plotters_in_one_process_do_not_know_each_other(
    machine: Make, tmp_path: Path
) -> None:
    offers = [
        offer("pty", f"{tmp_path}/a", COMMON),
        offer("pty", f"{tmp_path}/b?machine=hp-7475a&buffer=255", COMMON),
    ]
    with served(offers) as addresses:
        assert addresses == [f"{tmp_path}/a", f"{tmp_path}/b"]
        for address, answer in zip(addresses, (b"1024\r", b"255\r"), strict=True):
            with serial.Serial(address, timeout=5) as port:
                port.write(b"\x1b.L")
                assert port.read_until(b"\r") == answer


@pytest.mark.parametrize("text", ["", "x", "70000", "0"])
def test_a_port_that_is_no_number_is_refused(text: str) -> None:
    with pytest.raises(FoldmillError, match="is no port number"):
        offer("tcp", text, COMMON)


def test_commands_reach_all_plotters_or_the_one_that_is_named(machine: Make) -> None:
    simulators = [Simulator(machine(), clock=RealClock()) for _ in range(2)]
    said: list[str] = []

    def operator() -> Iterator[str]:
        yield from ("flip 2", "new", "fault 1", "fault", "fault lever@0", "status 7", "quit")

    run([Offer(each, "pty", "") for each in simulators], operator(), said.append)
    assert [each.sheets[0].up for each in simulators] == [Face.FRONT, Face.REVERSE]
    assert [len(each.sheets) for each in simulators] == [2, 2]
    assert all(each.device.lever_up for each in simulators)
    assert sum("fault (let something go wrong" in line for line in said) == 1


def test_the_table_tells_where_each_plotter_is_and_what_it_cut(machine: Make) -> None:
    simulators = {name: Simulator(machine()) for name in ("one", "two")}
    simulators["one"].write(b"SP1;PD400,800;PU;PD0,0;PU;")
    simulators["one"].rest()
    simulators["one"].flip()
    simulators["two"].fail(parse("lever@0"))
    shown = io.StringIO()
    Console(file=shown, width=120).print(table(simulators))
    rows = [" ".join(line.split()) for line in shown.getvalue().splitlines() if "hpgl" in line]
    assert rows == [
        "1 generic-hpgl-600 at rest 0.0, 0.0 1 up ····· 0/1024 0 2 0*",
        "2 generic-hpgl-600 waiting for its lever 0.0, 0.0 0 up ····· 0/1024 0 0* 0 lever",
    ]
