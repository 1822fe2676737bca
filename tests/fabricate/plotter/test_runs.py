"""Bytes that a simulated machine takes in one go leave what they leave one by one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from foldmill import installed
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter import sender
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.simulator.faults import parse as faults
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.quirks import Quirk
from foldmill_fabricate.plotter.simulator.trial import fine_lines


class Bytewise(Simulator):
    """Takes one byte after the other, whatever they are."""

    def _take_run(self, until: float, before: float) -> bool:
        return False


WORDS = [
    b"IN;", b"SP1;", b"PU;", b"PD;", b"PU120,400;", b"PD400,80,10,20;", b"PR5,5,-3,2;PA;", b"VS9;",
    b"PD", b"12", b"00,", b";", b"OA;OE;", b"OS;", b"LBa;b\x03", b"ZZ;", b"PD1,;", b"\x1b.B",
    b"\x1b.E", b"\x1b.L", b"\x1b.O", b"\x1b.K", b"\x1b.", b"\x05", b"\x1b.I20;5;6:", b"\n",
    b"pu 7,", b"\x1b.N9;19:", b"\x1b.P1:", b"\x1b.M5;65;10;13:", b"PA9" + b"0,1" * 30 + b";",
]  # fmt: skip
TROUBLE = [
    "",
    "",
    "stall@40:2s",
    "noise@30",
    "slow@1sx4",
    "overflow@20",
    "xoff@25:3s",
    "garbage@50",
]
STEPS = st.lists(
    st.tuples(
        st.lists(st.sampled_from(WORDS), max_size=12).map(b"".join),
        st.sampled_from([0.0, 1e-3, 0.0137, 0.1, 1.0, 7.0]),
    ),
    min_size=1,
    max_size=12,
)


def cutter(**serial: Any) -> Machine:
    base: Machine = installed().get(MACHINES, "machine", "generic-hpgl-600")
    return base.model_copy(update={"serial": base.serial.model_copy(update=serial)})


def seen(simulator: Simulator) -> dict[str, Any]:
    """Return all that can be known of a machine, but for the seconds of its line."""
    device = simulator.device
    return {
        "traffic": asdict(device.traffic),
        "tally": asdict(device.carriage.tally),
        "drawn": {face: simulator.sheet.seen(face) for face in Face},
        "at": (device.carriage.at, device.carriage.down, device.carriage.error),
        "waits": (bytes(device.buffer.data), device.holds, device.ready, device.idle),
        "status": simulator.status(),
        "next": simulator.next_event,
        "questions": (simulator.gauge.use.questions, simulator.gauge.use.program),
    }


def lived(simulator: Simulator, steps: list[tuple[bytes, float]]) -> list[Any]:
    """Write, wait and read, step by step; return what is known after each."""
    simulator.watch([b"PU120,400;"] * 200, 8)
    told = []
    for data, pause in steps:
        simulator.write(data)
        simulator.clock.sleep(pause)
        told.append((simulator.read(), seen(simulator)))
    use = simulator.gauge.use
    return [*told, pytest.approx([use.busy, use.missed], rel=1e-9, abs=1e-12)]


@example(  # asked within an instruction, and not
    steps=[(b"SP1;PD900,900;PD12", 0.1), (b"\x1b.B", 0.1), (b"00,7;", 0.1), (b"\x1b.B", 9.0)],
    handshake="esc-b",
    buffer=255,
    baud=9600,
    trouble="",
    habits=set(),
    honours=False,
)
@given(
    steps=STEPS,
    handshake=st.sampled_from(["none", "xon-xoff", "rts-cts", "dtr", "esc-b", "enq-ack"]),
    buffer=st.sampled_from([64, 90, 255, 4096]),
    baud=st.sampled_from([2400, 9600, 115200]),
    trouble=st.sampled_from(TROUBLE),
    habits=st.sets(st.sampled_from(list(Quirk)), max_size=2),
    honours=st.booleans(),
)
def test_a_run_of_bytes_leaves_what_its_bytes_leave_one_by_one(
    steps: list[tuple[bytes, float]],
    handshake: str,
    buffer: int,
    baud: int,
    trouble: str,
    habits: set[Quirk],
    honours: bool,
) -> None:
    machine = cutter(handshake=handshake, buffer=buffer, baud=baud)
    made = [kind(machine, faults=faults(trouble), quirks=habits) for kind in (Simulator, Bytewise)]
    for each in made:
        each.honours_cts = honours
    together, apart = (lived(each, steps) for each in made)
    assert together[:-1] == apart[:-1]
    use = made[1].gauge.use
    assert together[-1] == [use.busy, use.missed]


@pytest.mark.parametrize(
    ("handshake", "buffer"), [("esc-b", 255), ("esc-b", 65536), ("xon-xoff", 255), ("rts-cts", 255)]
)
def test_a_delivery_is_the_same_to_the_byte_and_to_the_moment(
    handshake: str, buffer: int, plugged: Callable[[Simulator], str]
) -> None:
    machine, program = cutter(handshake=handshake, buffer=buffer), fine_lines(6000, 30)
    ends = []
    for kind in (Simulator, Bytewise):
        simulator = kind(machine)
        with open_port(plugged(simulator), machine) as port:
            ends.append((sender.send(program, port, machine), seen(simulator)))
    assert ends[0] == ends[1]


def test_most_bytes_of_a_long_program_come_in_runs(
    plugged: Callable[[Simulator], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    machine, program = cutter(handshake="esc-b", buffer=65536), fine_lines(6000, 30)
    simulator = Simulator(machine)
    receive, one_by_one = simulator.device.receive, bytearray()

    def counted(byte: int, now: float) -> None:
        one_by_one.append(byte)
        receive(byte, now)

    monkeypatch.setattr(simulator.device, "receive", counted)
    with open_port(plugged(simulator), machine) as port:
        sender.send(program, port, machine)
    assert len(one_by_one) < 0.2 * len(simulator.device.traffic.received)
