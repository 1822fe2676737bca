"""Each way in which a machine says that it has room, as the manuals tell it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.modem import Wiring

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]
Told = Callable[..., bytes]


def test_an_enquiry_is_acknowledged_when_a_block_fits(machine: Make, told: Told) -> None:
    simulator = Simulator(machine(buffer=255))
    simulator.pause()
    assert told(simulator, b"\x1b.I81;5;6:\x05") == b"\x06"
    assert told(simulator, b"PU1,1;" * 30 + b"\x05") == b""
    simulator.resume()
    assert told(simulator, b"") == b"\x06"
    assert b"\x05" not in simulator.device.traffic.program


def test_by_default_every_enquiry_is_acknowledged_whatever_the_room(
    machine: Make, told: Told
) -> None:
    simulator = Simulator(machine(buffer=255))
    simulator.pause()
    assert told(simulator, b"PU1,1;" * 42 + b"\x05") == b"\x06"


def test_a_machine_built_for_enq_ack_needs_no_telling(machine: Make, told: Told) -> None:
    simulator = Simulator(machine(buffer=255, handshake="enq-ack"))
    simulator.pause()
    assert told(simulator, b"PU1,1;" * 42 + b"\x05") == b""
    simulator.resume()
    assert told(simulator, b"") == b"\x06"


def test_in_mode_2_an_enquiry_without_room_gets_the_immediate_answer(
    machine: Make, told: Told
) -> None:
    simulator = Simulator(machine(buffer=255))
    simulator.pause()
    told(simulator, b"\x1b.N;42:\x1b.I81;5;6:" + b"PU1,1;" * 40)
    assert told(simulator, b"\x05") == b"*"
    simulator.resume()
    assert told(simulator, b"") == b"\x06"


def test_esc_m_dresses_an_answer(machine: Make, told: Told) -> None:
    simulator = Simulator(machine())
    assert told(simulator, b"\x1b.M;;;10;13;62:\x1b.B") == b">1024\n\r"
    assert told(simulator, b"\x1b.R\x1b.B") == b"1024\r"
    simulator.write(b"\x1b.M500:\x1b.B")
    simulator.clock.sleep(0.4)
    assert simulator.read() == b""
    simulator.clock.sleep(0.2)
    assert simulator.read() == b"1024\r"


def test_an_answer_waits_for_the_trigger(machine: Make, told: Told) -> None:
    simulator = Simulator(machine())
    assert told(simulator, b"\x1b.M;17:OA;OE;") == b""
    assert told(simulator, b"\x11") == b"0,0,0\r"
    assert told(simulator, b"\x11") == b"0\r"


def test_esc_n_spaces_the_bytes_of_an_answer(machine: Make) -> None:
    simulator = Simulator(machine(baud=115200))
    simulator.write(b"\x1b.N100:OA;")
    came: list[float] = []
    while len(came) < 6:
        simulator.clock.sleep(0.001)
        came += [simulator.clock.now()] * len(simulator.read())
    assert all(
        later - earlier == pytest.approx(0.1, abs=0.003) for earlier, later in pairwise(came)
    )


@pytest.mark.parametrize(
    ("question", "answer"), [(b"\x1b.A", b"hp-7550a\r"), (b"\x1b.S0:", b"12800\r")]
)
def test_only_the_hp_7550a_knows_its_own_letters(
    question: bytes, answer: bytes, machine: Make, told: Told
) -> None:
    assert told(Simulator(machine("hp-7550a")), question) == answer
    assert told(Simulator(machine("hp-7475a")), question + b"\x1b.E")[-3:] == b"11\r"


def test_esc_p_sets_a_standard_handshake_on_the_hp_7550a(machine: Make, told: Told) -> None:
    simulator = Simulator(machine("hp-7550a", buffer=255))
    simulator.honours_xoff = False
    simulator.pause()
    assert told(simulator, b"\x1b.P1:" + b"PU1,1;" * 40) == b"\x13"
    assert told(simulator, b"\x1b.P3:") == b""
    assert not simulator.modem.dsr
    assert simulator.modem.cts


@pytest.mark.parametrize(("handshake", "line"), [("rts-cts", "cts"), ("dtr", "dsr")])
def test_the_ready_line_falls_before_the_buffer_is_full_and_rises_again(
    handshake: str, line: str, machine: Make
) -> None:
    simulator = Simulator(machine(buffer=256, handshake=handshake))
    simulator.pause()
    assert simulator.modem.cts
    assert simulator.modem.dsr
    simulator.write(b"PU1,1;" * 34)
    simulator.clock.sleep(5)
    simulator.advance()
    assert not getattr(simulator.modem, line)
    assert simulator.device.free > 0
    simulator.resume()
    simulator.rest()
    assert getattr(simulator.modem, line)


def test_esc_at_switches_the_hardwire_handshake_on_and_off(machine: Make, told: Told) -> None:
    simulator = Simulator(machine(buffer=255))
    simulator.pause()
    told(simulator, b"PU1,1;" * 40)
    assert simulator.modem.dsr
    told(simulator, b"\x1b.@;1:")
    assert not simulator.modem.dsr
    told(simulator, b"\x1b.@;0:")
    told(simulator, b"\x1b.@:")
    assert not simulator.modem.dsr


def test_a_host_that_obeys_cts_never_overruns_the_buffer(machine: Make, plugged: Plug) -> None:
    cutter = machine(buffer=255, handshake="rts-cts")
    for obeys in (True, False):
        simulator = Simulator(cutter)
        with open_port(plugged(simulator), cutter) as port:
            port.rtscts = obeys
            port.write(b"VS1;" + b"PD400,0,0,400;" * 100)
            port.flush()
            assert (simulator.device.traffic.overruns == 0) is obeys


def test_a_cable_of_three_wires_carries_no_handshake(machine: Make, plugged: Plug) -> None:
    cutter = machine(handshake="rts-cts")
    simulator = Simulator(cutter, wiring=Wiring.THREE_WIRES)
    with open_port(plugged(simulator), cutter) as port:
        assert [port.cts, port.dsr, port.cd, port.ri] == [False] * 4
        port.rtscts = True
        port.write(b"OA;")
        assert port.read(1) == b""
        assert len(simulator.device.traffic.received) < 3


def test_a_machine_with_rts_cts_says_nothing_while_the_host_does_not_listen(
    machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake="rts-cts")
    simulator = Simulator(cutter)
    with open_port(plugged(simulator), cutter) as port:
        assert simulator.modem.changes == []
        port.rts = False
        port.write(b"OA;")
        assert port.read(1) == b""
        port.rts = True
        assert port.read_until(b"\r") == b"0,0,0\r"
    assert [(line, level) for _, line, level in simulator.modem.changes] == [
        ("rts", False),
        ("rts", True),
    ]
