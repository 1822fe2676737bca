"""What went over the wire can be read later, and played back to the same delivery."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.link import clock_of, open_port
from foldmill_fabricate.plotter.sender import send
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.transcript import Recorded, Replayed, recorded

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]
PROGRAM = b"IN;SP1;VS10;" + b"".join(
    b"PU%d,0;PD%d,800;PD%d,0;" % (x, x, x) for x in range(0, 2000, 100)
)


FULL = Path("/dev/full")
"""A file of Linux to which nothing can be written, for want of room."""


@pytest.mark.skipif(not FULL.exists(), reason="this system has no /dev/full")
def test_where_a_transcript_has_no_room_the_machine_is_stopped_and_says_why(
    machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake="esc-b")
    simulator = Simulator(cutter)
    with (
        open_port(plugged(simulator), cutter) as port,
        recorded(port, clock_of(port), FULL) as written,
        pytest.raises(PlotterError, match=r"The disk of /dev is full.*Make room"),
    ):
        send(PROGRAM, written, cutter)
    received = bytes(simulator.device.traffic.received)
    assert b"PD" not in received
    assert b"\x1b.K" in received, "the stop itself goes out, though it cannot be written down"


@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff", "enq-ack"])
def test_a_transcript_holds_every_byte_and_plays_the_same_delivery(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    cutter, paper = machine(handshake=handshake), io.StringIO()
    simulator = Simulator(cutter)
    with open_port(plugged(simulator), cutter) as port:
        first = send(PROGRAM, Recorded(port, clock_of(port), paper), cutter)
    rows = [json.loads(line) for line in paper.getvalue().splitlines()]
    written = b"".join(bytes.fromhex(row["data"]) for row in rows if row["to"] == "machine")
    assert written == bytes(simulator.device.traffic.received)
    assert [row["t"] for row in rows] == sorted(row["t"] for row in rows)
    again = Replayed(paper.getvalue().splitlines())
    second = send(PROGRAM, again, cutter)
    assert again.is_over
    assert (second.status, second.position, second.bytes) == (
        first.status,
        first.position,
        first.bytes,
    )


def test_playing_back_refuses_another_program(machine: Make, plugged: Plug) -> None:
    cutter, paper = machine(handshake="xon-xoff"), io.StringIO()
    with open_port(plugged(Simulator(cutter)), cutter) as port:
        send(PROGRAM, Recorded(port, clock_of(port), paper), cutter)
    with pytest.raises(PlotterError, match=r"of the transcript: .* was written then"):
        send(PROGRAM.replace(b"800", b"900"), Replayed(paper.getvalue().splitlines()), cutter)
