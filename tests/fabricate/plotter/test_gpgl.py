"""A GP-GL cutter: commands end with ETX, and its status says whether it is ready."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import send
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
Told = Callable[..., bytes]
Plug = Callable[..., str]
SQUARE = b"M100,100\x03D300,100,300,300\x03E-200,0\x03D100,100\x03"


def cutter(machine: Make, faults: str = "") -> Simulator:
    return Simulator(machine("silhouette-like"), faults=parse(faults))


def test_strokes_are_drawn_with_the_speed_and_force_that_were_set(machine: Make) -> None:
    simulator = cutter(machine)
    simulator.write(b"\x1b\x04TT\x03J1\x03!3\x03FX10\x03FC18\x03" + SQUARE + b"O10,0\x03H\x03")
    simulator.rest()
    (stroke,) = simulator.sheet.strokes[Face.FRONT]
    assert stroke.points == ((100, 100), (300, 100), (300, 300), (100, 300), (100, 100))
    assert (stroke.tool, stroke.speed, stroke.force) == (1, 300.0, 64.0)
    assert simulator.device.carriage.at == (0, 0)
    assert simulator.device.carriage.tally.errors == 0


def test_the_status_is_moving_until_all_is_done(machine: Make, told: Told) -> None:
    simulator = cutter(machine)
    assert told(simulator, b"\x1b\x05", 1.0) == b"0\x03"
    simulator.write(SQUARE * 5)
    assert told(simulator, b"\x1b\x05", 0.4) == b"1\x03"
    simulator.write(b"M0,0\x03")
    simulator.rest()
    assert told(simulator, b"\x1b\x05", 1.0) == b"0\x03"


def test_nothing_loaded_is_told(machine: Make, told: Told) -> None:
    assert told(cutter(machine, "lever@0"), b"\x1b\x05", 1.0) == b"2\x03"


def test_its_name_is_answered_in_order(machine: Make, told: Told) -> None:
    simulator = cutter(machine)
    assert told(simulator, b"D2000,0\x03FG\x03", 0.1) == b""
    assert told(simulator, b"") == b"silhouette-like V1.00\x03"


def test_esc_eot_drops_what_waits_and_lifts_the_tool(machine: Make) -> None:
    simulator = cutter(machine)
    simulator.write(b"!1\x03D2000,0\x03D2000,2000\x03D0,0\x03\x1b\x04")
    simulator.rest()
    assert [stroke.points for stroke in simulator.sheet.strokes[Face.FRONT]] == [
        ((0, 0), (2000, 0))
    ]


def test_a_command_longer_than_the_buffer_is_drawn_all_the_same(machine: Make) -> None:
    simulator = cutter(machine)
    points = [(n, n % 7) for n in range(1, 600)]
    simulator.write(b"D" + b",".join(b"%d,%d" % each for each in points) + b"\x03")
    simulator.clock.sleep(600)
    simulator.advance()
    assert simulator.sheet.seen(Face.FRONT)[0].points == ((0, 0), *points)


@pytest.mark.parametrize(
    ("wrong", "error"), [(b"D1\x03", 2), (b"D1,x\x03", 2), (b"M-5,1\x03", 3), (b"3\x03", 1)]
)
def test_a_wrong_command_is_counted_and_moves_nothing(
    wrong: bytes, error: int, machine: Make, told: Told
) -> None:
    simulator = cutter(machine)
    told(simulator, wrong)
    assert simulator.device.carriage.error == error
    assert simulator.device.carriage.at == (0, 0)


def test_half_a_command_is_dropped_and_never_ended_as_a_line_to_elsewhere(
    machine: Make, plugged: Plug, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulator = cutter(machine)
    with open_port(plugged(simulator), simulator.machine) as port:
        write = port.write

        def half(data: bytes) -> int:
            if not data.startswith(b"D4000"):
                return int(write(data))
            write(data[: len("D4000,4")])  # what was to be 4000,400 ends as 4000,4
            port.clock.sleep(30)
            raise OSError("the adapter is gone")

        monkeypatch.setattr(port, "write", half)
        with pytest.raises(PlotterError, match="Stop the machine by hand"):
            send(b"J1\x03M100,100\x03D400,4000\x03D4000,400\x03M0,0\x03", port, simulator.machine)
        port.clock.sleep(60)
        simulator.advance()
    assert bytes(simulator.device.traffic.received).endswith(b"D4000,4\x1b\x04")
    assert [one.points for one in simulator.sheet.strokes[Face.FRONT]] == [
        ((100, 100), (400, 4000))
    ]
    assert not simulator.device.carriage.down
