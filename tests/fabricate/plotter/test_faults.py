"""Each fault happens where it is placed, and does to the machine what it does to a real one."""

from __future__ import annotations

from collections.abc import Callable

import pytest
import serial
from hypothesis import given
from hypothesis import strategies as st

from foldmill import FoldmillError, installed
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.simulator.faults import LASTING, Fault, Trouble, Unit, parse
from foldmill_fabricate.plotter.simulator.machine import Simulator

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]
Told = Callable[..., bytes]
STROKES = b"VS1;PU0,0;PD400,0;PU;PU0,400;PD400,400,400,800;PU;PU0,800;PD400,800;PU;"
"""Three strokes of lines that take one second each."""


def ready(machine: Machine, faults: str, program: bytes = STROKES) -> Simulator:
    """A machine that has been given a program, some seconds later."""
    simulator = Simulator(machine, faults=parse(faults))
    simulator.write(program)
    simulator.clock.sleep(30)
    simulator.advance()
    return simulator


def ends(simulator: Simulator) -> list[tuple[int, int]]:
    """Where each stroke that can be seen ends, steps."""
    return [stroke.points[-1] for stroke in simulator.sheet.seen(Face.FRONT)]


FAULTS = st.builds(
    lambda trouble, at, unit, amount, lasting: Fault(
        trouble,
        at / 4,
        unit,
        amount if trouble not in LASTING or trouble is Trouble.SLOW else 0,
        lasting if trouble in LASTING else float("inf"),
    ),
    st.sampled_from(list(Trouble)),
    st.integers(0, 40000),
    st.sampled_from(list(Unit)),
    st.integers(0, 99),
    st.integers(1, 99) | st.just(float("inf")),
)


@given(st.lists(FAULTS, max_size=4))
def test_faults_are_written_as_they_are_read(faults: list[Fault]) -> None:
    assert list(parse(",".join(map(str, faults)))) == faults


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("flood@12", "'flood@12' is no fault"),
        ("stall", "Write NAME@PLACE"),
        ("stall@9x4", "no amount of stall"),
        ("framing@9:4s", "happens to a number of bytes"),
    ],
)
def test_what_is_no_fault_is_refused_in_words(text: str, words: str) -> None:
    with pytest.raises(FoldmillError, match=words):
        parse(text)


def test_a_jam_stops_the_carriage_within_its_line_and_then_it_goes_on(machine: Make) -> None:
    simulator = ready(machine(), "stall@1.5strokes")
    assert simulator.sheet.strokes[Face.FRONT][0].points[-1] == (400, 0)
    (x, y) = ends(simulator)[1]
    assert 195 <= x <= 205
    assert y == 400
    assert simulator.device.firmware.ready
    with pytest.raises(PlotterError, match="halted within a line"):
        simulator.flip()
    assert ends(ready(machine(), "stall@1.5strokes:7s")) == ends(ready(machine(), ""))


def test_a_jam_takes_as_long_as_it_lasts(machine: Make) -> None:
    times = []
    for faults in ("", "stall@1.5strokes:7s"):
        simulator = Simulator(machine(), faults=parse(faults))
        simulator.write(STROKES)
        simulator.rest()
        times.append(simulator.clock.now())
    assert times[1] - times[0] == pytest.approx(7, abs=1e-6)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_power_fails_in_the_middle_of_a_line(share: float, machine: Make, told: Told) -> None:
    simulator = ready(machine(acceleration=1e9), f"power@{1 + share}strokes")
    assert ends(simulator)[1][0] == pytest.approx(400 * share, abs=2)
    assert len(ends(simulator)) == 2
    assert told(simulator, b"OA;\x1b.B") == b""
    assert not simulator.modem.cts
    assert not simulator.modem.dsr


def test_after_the_power_came_back_nothing_is_known_any_more(machine: Make, told: Told) -> None:
    simulator = ready(machine(), "power@1.5strokes:5s")
    assert told(simulator, b"OA;OE;OS;") == b"0,0,0\r0\r24\r"
    assert told(simulator, b"\x1b.B") == b"1024\r"
    assert len(ends(simulator)) == 2
    assert simulator.device.traffic.discarded > 0


def test_a_lifted_lever_lets_the_line_end_and_says_so(machine: Make, told: Told) -> None:
    simulator = ready(machine(), "lever@1strokes:40s")
    assert ends(simulator) == [(400, 0)]
    assert told(simulator, b"\x1b.O", 1.0) == b"32\r"
    simulator.clock.sleep(60)
    simulator.advance()
    assert len(ends(simulator)) == 3
    assert told(simulator, b"\x1b.OOE;OE;") == b"8\r8\r0\r"


def test_a_slow_machine_does_the_same_later(machine: Make) -> None:
    simulator = ready(machine(), "slow@0x10")
    assert len(ends(simulator)) == 2
    simulator.rest()
    assert ends(simulator) == ends(ready(machine(), ""))


def test_a_silent_machine_ends_its_line_and_hears_again_afterwards(
    machine: Make, told: Told
) -> None:
    simulator = ready(machine(), "silence@1.2strokes:60s")
    assert told(simulator, b"\x1b.B", 1.0) == b""
    simulator.clock.sleep(60)
    assert told(simulator, b"OA;") == b"400,800,0\r"


def test_a_mute_machine_cuts_everything_and_says_nothing(machine: Make, told: Told) -> None:
    simulator = ready(machine(), "mute@0")
    assert told(simulator, b"OA;\x1b.B") == b""
    assert len(ends(simulator)) == 3


@pytest.mark.parametrize(
    ("handshake", "sign"), [("xon-xoff", b"\x13"), ("rts-cts", b""), ("dtr", b""), ("enq-ack", b"")]
)
def test_a_machine_that_says_wait_for_ever_executes_what_it_has(
    handshake: str, sign: bytes, machine: Make, told: Told
) -> None:
    simulator = Simulator(machine(handshake=handshake), faults=parse("xoff@20"))
    simulator.honours_xoff = False
    assert told(simulator, STROKES) == b"\x13"
    assert len(ends(simulator)) == 3
    assert told(simulator, b"\x05") == (b"" if handshake == "enq-ack" else b"\x06")
    assert not (simulator.modem.cts and simulator.modem.dsr)


def test_after_an_xoff_that_ends_the_host_may_send_again(machine: Make) -> None:
    cutter = machine(handshake="xon-xoff")
    simulator = ready(cutter, "xoff@20:5s")
    assert len(ends(simulator)) == 3
    assert bytes(simulator.device.traffic.program) == STROKES


@pytest.mark.parametrize(
    ("fault", "answer"),
    [
        ("noise@2x1", b"0\r5240,40,0\r"),  # the 1 has become a 5
        ("framing@2x2", b"15\r40,40,0\r"),
        ("overflow@2x2", b"16\r40,40,0\r"),
    ],
)
def test_a_bad_line_changes_or_loses_bytes(
    fault: str, answer: bytes, machine: Make, told: Told
) -> None:
    simulator = Simulator(machine(), faults=parse(fault))
    said = told(simulator, b"PU1240,40;") + told(simulator, b"\x1b.E") + told(simulator, b"OA;")
    assert said == answer
    assert simulator.device.traffic.overruns == 2 * fault.startswith("overflow")


def test_garbage_is_the_same_every_time(machine: Make) -> None:
    first, second = (ready(machine(), "garbage@5x64").read() for _ in range(2))
    assert first == second
    assert len(first) > 60  # XON and XOFF among it are for the driver


def test_a_pulled_cable_kills_the_port_and_not_the_machine(machine: Make, plugged: Plug) -> None:
    cutter = machine()
    simulator = Simulator(cutter, faults=parse("disconnect@0.5s:10s"))
    url = plugged(simulator)
    with open_port(url, cutter) as port:
        port.timeout = 3
        port.write(STROKES)
        with pytest.raises(serial.SerialException, match="disconnected"):
            port.read(1)
        with pytest.raises(serial.SerialException, match="disconnected"):
            port.write(b"PU;")
        with pytest.raises(serial.SerialException, match="disconnected"):
            _ = port.in_waiting
        assert simulator.clock.now() < 0.7
        with pytest.raises(FoldmillError, match="There is no port"):
            open_port(url, cutter)
        simulator.clock.sleep(20)
        simulator.advance()
        assert len(ends(simulator)) == 3
        with pytest.raises(serial.SerialException, match="disconnected"):
            port.read(1)
    with open_port(url, cutter) as port:
        port.write(b"OA;")
        assert port.read_until(b"\r") == b"400,800,0\r"


@given(st.integers(0, 90), st.sampled_from([t for t in Trouble if t is not Trouble.DISCONNECT]))
def test_the_same_fault_does_the_same_to_the_same_bytes(at: int, trouble: Trouble) -> None:
    base: Machine = installed().get(MACHINES, "machine", "generic-hpgl-600")
    outcomes = []
    for _ in range(2):
        simulator = ready(base, f"{trouble}@{at}")
        outcomes.append((ends(simulator), simulator.read(), simulator.status()))
    assert outcomes[0] == outcomes[1]
