"""Habits of real machines, switched on one by one."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from foldmill import FoldmillError
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.quirks import Quirk, parse

Make = Callable[..., Machine]
Told = Callable[..., bytes]


@pytest.mark.parametrize(
    ("quirk", "program", "without", "with_it"),
    [
        (Quirk.NEEDS_IN, b"PU40,40;OA;IN;PU80,80;OA;", b"40,40,0\r80,80,0\r", b"0,0,0\r80,80,0\r"),
        (Quirk.NEGATIVES_CLAMPED, b"PU-40,9;OE;OA;", b"3\r0,0,0\r", b"0\r0,9,0\r"),
        (Quirk.WRAPS, b"PU65540,40000;OE;OA;", b"3\r0,0,0\r", b"3\r0,0,0\r"),
        (Quirk.WRAPS, b"PU65540,4;OE;OA;", b"3\r0,0,0\r", b"0\r4,4,0\r"),
        (Quirk.ODD_DROPPED, b"PD10,20,30;OE;OA;", b"2\r10,20,1\r", b"0\r10,20,1\r"),
        (
            Quirk.SPLIT_GARBLES,
            b"PU1\x1b.B23,45;OE;OA;",
            b"1021\r0\r123,45,0\r",
            b"1021\r0\r13,45,0\r",
        ),
        (Quirk.SPLIT_GARBLES, b"PU12\x1b.B,45;OE;OA;", b"1020\r0\r12,45,0\r", b"1020\r2\r0,0,0\r"),
    ],
)
def test_a_quirk_changes_just_that(
    quirk: Quirk, program: bytes, without: bytes, with_it: bytes, machine: Make, told: Told
) -> None:
    for quirks, answer in (((), without), ((quirk,), with_it)):
        assert told(Simulator(machine(), quirks=quirks), program) == answer


@pytest.mark.parametrize("by_profile", [True, False])
def test_a_second_in_cancels_what_waits(by_profile: bool, machine: Make) -> None:
    base = machine()
    if by_profile:
        dialect = base.dialect.model_copy(update={"second_in_cancels": True})
        base = base.model_copy(update={"dialect": dialect})
    simulator = Simulator(base, quirks=() if by_profile else parse("second-in-cancels"))
    simulator.write(b"IN;VS1;SP1;PD400,0,800,0;PU;PD800,800;PU;IN;PD0,0;PU;")
    simulator.rest()
    drawn = [stroke.points for stroke in simulator.sheet.strokes[Face.FRONT]]
    assert drawn == [((0, 0), (400, 0)), ((400, 0), (0, 0))]
    assert simulator.device.carriage.tally.second_in == 1
    assert simulator.device.traffic.discarded > 0


def test_a_machine_that_answers_nothing_answers_nothing(machine: Make, told: Told) -> None:
    silent = Simulator(machine(answers=False))
    assert told(silent, b"PU40,40;OA;OE;\x1b.B\x1b.E") == b""
    assert silent.device.carriage.at == (40, 40)


def test_an_address_names_quirks_and_faults_and_wiring() -> None:
    simulator = devices.made(
        "generic-hpgl-600",
        {"quirk": "needs-in,odd-dropped", "fault": "stall@9", "wiring": "three-wires"},
    )
    assert simulator.device.schedule.waiting
    assert not simulator.modem.cts


@pytest.mark.parametrize("options", [{"quirk": "shy"}, {"wiring": "two"}, {"fault": "x"}])
def test_an_option_that_there_is_not_is_refused_in_words(options: dict[str, str]) -> None:
    with pytest.raises(FoldmillError):
        devices.made("generic-hpgl-600", options)


def test_an_instruction_that_no_buffer_holds_is_an_error_and_not_the_end(
    machine: Make, told: Told
) -> None:
    simulator = Simulator(machine(buffer=64))
    told(simulator, b"SP" + b"1" * 100)
    assert told(simulator, b";OE;PU40,40;OA;").endswith(b"40,40,0\r")
    assert simulator.device.carriage.tally.errors > 0
