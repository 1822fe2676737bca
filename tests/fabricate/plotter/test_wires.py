"""Over a real wire and in real time: a pseudo-terminal with the kernel's XON/XOFF, and TCP."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.errors import PortUnavailable
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import Status, as_sent, send
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.offers import Offer
from foldmill_fabricate.plotter.simulator.run import run
from foldmill_fabricate.plotter.simulator.servers import serve_pty, serve_tcp
from foldmill_fabricate.plotter.simulator.trial import fine_lines, without_questions

Make = Callable[..., Machine]
PROGRAM = fine_lines(5_000, 8)


@pytest.mark.long
@pytest.mark.parametrize("serve", [serve_pty, serve_tcp])
@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff"])
def test_a_program_arrives_byte_for_byte_over_a_real_wire(
    serve: Callable[[Simulator], Iterator[str]], handshake: str, machine: Make
) -> None:
    cutter = machine(handshake=handshake, baud=57600, buffer=255, acceleration=1e6, lift_time=0.01)
    simulator = Simulator(cutter, clock=RealClock(), speed_up=0.5)  # fills the buffer now and then
    with serve(simulator) as url, open_port(url, cutter) as port:  # type: ignore[attr-defined]
        delivery = send(PROGRAM, port, cutter)
    traffic = simulator.device.traffic
    assert delivery.status.is_done
    assert traffic.overruns == 0
    assert without_questions(bytes(traffic.program)) == as_sent(PROGRAM, cutter)
    assert len(simulator.sheet.strokes[Face.FRONT]) == PROGRAM.count(b"PU") - 1


def test_the_kernel_stops_at_xoff_and_goes_on_at_xon(machine: Make) -> None:
    cutter = machine(handshake="xon-xoff", baud=115200, buffer=255)
    simulator, clock = Simulator(cutter, clock=RealClock(), speed_up=50), RealClock()
    simulator.pause()
    with serve_pty(simulator) as path, open_port(path, cutter) as port:
        port.write_timeout = 10
        port.write(b"PU1,1;PU2,2;" * 100)
        clock.sleep(0.5)
        assert simulator.device.free > 0
        simulator.resume()
        deadline = clock.now() + 10
        while len(simulator.device.traffic.received) < 1200 and clock.now() < deadline:
            clock.sleep(0.05)
    assert len(simulator.device.traffic.received) == 1200
    assert simulator.device.traffic.overruns == 0


def test_a_host_that_does_not_obey_xoff_overruns_the_buffer(machine: Make) -> None:
    cutter = machine(handshake="xon-xoff", baud=115200, buffer=255)
    deaf = machine(handshake="none", baud=115200, buffer=255)
    simulator, clock = Simulator(cutter, clock=RealClock()), RealClock()
    simulator.pause()
    with serve_pty(simulator) as path, open_port(path, deaf) as port:
        port.write(b"PU1,1;PU2,2;" * 100)
        deadline = clock.now() + 10
        while len(simulator.device.traffic.received) < 1200 and clock.now() < deadline:
            clock.sleep(0.05)
    assert simulator.device.traffic.overruns == 1200 - 255


def test_the_machine_stays_when_its_user_leaves_and_another_comes(machine: Make) -> None:
    cutter = machine(baud=115200)
    simulator = Simulator(cutter, clock=RealClock(), speed_up=50)
    with serve_tcp(simulator) as url:
        for program, strokes in ((b"IN;SP1;PD40,40;PU;", 1), (b"IN;SP1;PD80,80;PU;", 2)):
            with open_port(url, cutter) as port:
                assert send(program, port, cutter).status is Status.EXECUTED
            assert len(simulator.sheet.strokes[Face.FRONT]) == strokes


def test_a_tcp_port_that_is_taken_says_so(machine: Make) -> None:
    simulator = Simulator(machine(), clock=RealClock())
    with serve_tcp(simulator) as url:
        number = int(url.rpartition(":")[2])
        with (
            pytest.raises(PortUnavailable, match="cannot be had"),
            serve_tcp(simulator, port=number),
        ):
            pass


def test_a_link_is_made_and_removed_and_never_replaces_a_file(
    machine: Make, tmp_path: Path
) -> None:
    simulator, link = Simulator(machine(), clock=RealClock()), tmp_path / "plotter"
    link.symlink_to("/nowhere")
    with serve_pty(simulator, link) as path:
        assert path == str(link)
        assert os.path.realpath(link).startswith("/dev/")
    assert not link.is_symlink()
    link.write_text("mine")
    with pytest.raises(PortUnavailable, match="No link can be made"), serve_pty(simulator, link):
        pass
    assert link.read_text() == "mine"


def test_the_tool_obeys_short_commands_and_leaves_pictures(machine: Make, tmp_path: Path) -> None:
    cutter, said = machine(baud=115200), list[str]()
    simulator = Simulator(cutter, clock=RealClock(), speed_up=50)

    def operator() -> Iterator[str]:
        path = said[0].split(" at ")[1]
        for program in (b"IN;SP1;PD400,400;PU;", b"IN;SP1;PD800,800;PU;PD0,0;PU;"):
            with open_port(path, cutter) as port:
                send(program, port, cutter)
            yield "flip\n"
        yield from ("dance", "status", "draw", "new", "quit", "flip")

    run([Offer(simulator, "pty", "")], operator(), said.append, tmp_path / "drawn")
    assert [len(simulator.sheets[0].strokes[face]) for face in Face] == [1, 2]
    assert len(simulator.sheets) == 2
    assert "flip (turn the sheet over)" in said[4]
    assert "strokes: 1 on the front, 2 on the reverse" in said[5]
    assert {path.name for path in (tmp_path / "drawn").iterdir()} == {
        "front.svg",
        "front.png",
        "reverse.svg",
        "reverse.png",
    }
