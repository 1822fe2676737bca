"""Ports open by any address, fail in plain words, and sim:// behaves like a real one."""

from __future__ import annotations

import os
import socket
import tty
from collections.abc import Callable
from pathlib import Path

import pytest
import serial

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.errors import PortUnavailable
from foldmill_fabricate.plotter.link import clock_of, open_port
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]


def test_pyserial_opens_a_simulated_plotter_by_its_address() -> None:
    url = "sim://generic-hpgl-600?buffer=255&handshake=esc-b&baud=9600"
    with serial.serial_for_url(url, timeout=1) as port:
        port.write(b"\x1b.L\x1b.O")
        assert port.read_until(b"\r") == b"255\r"
        assert port.simulator.machine.serial.handshake == "esc-b"


def test_the_same_address_is_the_same_plotter(machine: Make) -> None:
    for expected in (b"0,0,0\r", b"40,80,0\r"):
        with open_port("sim://one-of-two?machine=generic-hpgl-600", machine()) as port:
            port.write(b"OA;PU40,80;")
            assert port.read_until(b"\r") == expected
    with open_port("sim://another?machine=generic-hpgl-600", machine()) as port:
        port.write(b"OA;")
        assert port.read_until(b"\r") == b"0,0,0\r"


def test_waiting_for_an_answer_takes_simulated_time(machine: Make, plugged: Plug) -> None:
    with open_port(plugged(Simulator(machine())), machine()) as port:
        port.timeout = 3600
        port.write(b"VS1;PD20000,0;PU;OA;")  # 500 mm at 1 cm/s
        assert port.read_until(b"\r") == b"20000,0,0\r"
        assert 50 < port.clock.now() < 51
        port.timeout = 5
        before = port.clock.now()
        assert port.read(1) == b""
        assert port.clock.now() - before == pytest.approx(5)


def test_reading_for_ever_from_a_plotter_that_will_never_answer_is_an_error(
    machine: Make, plugged: Plug
) -> None:
    with open_port(plugged(Simulator(machine())), machine()) as port:
        port.timeout = None
        with pytest.raises(serial.SerialException, match="for ever"):
            port.read(1)


def test_writing_blocks_when_the_driver_is_full_and_times_out(machine: Make, plugged: Plug) -> None:
    held = machine(handshake="xon-xoff", buffer=256)
    simulator = Simulator(held)
    simulator.pause()
    with open_port(plugged(simulator), held) as port:
        port.write(b"PU1,1;" * 600)
        port.clock.sleep(10)
        assert port.out_waiting > 3000
        with pytest.raises(serial.SerialTimeoutException):
            port.write(b"PU1,1;" * 300)
        port.set_output_flow_control(True)
        simulator.resume()
        port.flush()
        assert port.out_waiting == 0


def test_discarded_output_never_arrives(machine: Make, plugged: Plug) -> None:
    simulator = Simulator(machine())
    with open_port(plugged(simulator), machine()) as port:
        port.write(b"PU40,40;PU80,80;")
        port.clock.sleep(0.0093)
        port.reset_output_buffer()
        port.flush()
        simulator.rest()
    assert bytes(simulator.device.traffic.received) == b"PU40,40;P"


def test_a_port_whose_rate_differs_hears_nothing_sensible(machine: Make, plugged: Plug) -> None:
    with open_port(plugged(Simulator(machine())), machine(baud=19200)) as port:
        port.write(b"OA;")
        assert port.read(10) == b""


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("/dev/ttyNOBODY7", "There is no port /dev/ttyNOBODY7. Ports on this computer: "),
        ("parcel://x", "No port is addressed by parcel://"),
        ("sim://nothing-like-it", "There is no machine 'nothing-like-it'. There are: "),
        ("sim://generic-hpgl-600?colour=red", "no option 'colour'"),
        ("sim://generic-hpgl-600?speed_up=-1", "speed_up=-1 is no number above 0"),
        ("sim://generic-hpgl-600?buffer=3", "No plotter is like this: buffer=3"),
    ],
)
def test_a_port_that_cannot_be_opened_says_why(url: str, words: str, machine: Make) -> None:
    with pytest.raises(PortUnavailable) as caught:
        open_port(url, machine())
    assert words in str(caught.value)
    assert str(caught.value).count("\n") == 0


def test_a_port_in_use_says_so(machine: Make) -> None:
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    try:
        path = os.ttyname(theirs)
        with open_port(path, machine()), pytest.raises(PortUnavailable, match="in use by another"):
            open_port(path, machine())
    finally:
        os.close(ours)
        os.close(theirs)


def test_a_device_server_that_is_off_says_so(machine: Make) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(PortUnavailable, match="Nobody answers"):
        open_port(f"socket://127.0.0.1:{port}", machine())


def test_a_file_is_no_port(machine: Make, tmp_path: Path) -> None:
    (tmp_path / "list.txt").write_text("x")
    with pytest.raises(PortUnavailable, match="cannot be opened"):
        open_port(str(tmp_path / "list.txt"), machine())


def test_a_real_port_waits_by_the_clock_on_the_wall(machine: Make) -> None:
    with open_port("loop://", machine()) as port:
        assert isinstance(clock_of(port), RealClock)
