"""On real wires: a port that vanishes, a socket that is closed and silence are noticed in time."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from threading import Thread, Timer
from typing import Any

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import RealClock
from foldmill_fabricate.plotter.errors import PlotterError, Stopped
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import Progress, send
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.rfc2217 import serve_rfc2217
from foldmill_fabricate.plotter.simulator.servers import serve_pty, serve_tcp
from foldmill_fabricate.plotter.wish import Wish

Make = Callable[..., Machine]
LONG = b"IN;SP1;VS10;PU0,0;" + b"".join(
    b"PU%d,0;PD%d,4000;PD%d,0;" % (x, x, x) for x in range(0, 20000, 100)
)
"""200 strokes of 2.4 s: it never ends by itself here."""
WITHIN = 2.0
"""s in which it must be noticed."""
SHUT = pytest.mark.filterwarnings("ignore:.*socket:pytest.PytestUnraisableExceptionWarning")
"""pyserial leaves a socket to the garbage collector whose other end has gone."""
DAEMON = pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")
LATE = 0.8
"""s besides, for a machine with much else to do."""


def ended(port: Any, machine: Machine, seconds: float, happens: Callable[[], object]) -> float:
    """Send, let something happen after so long, and return how long it took to be noticed, s."""
    when: list[float] = []

    def later() -> None:
        time.sleep(seconds)
        when.append(time.monotonic())
        happens()

    Thread(target=later, daemon=True).start()
    with pytest.raises(PlotterError, match="Stop the machine by hand"):
        send(LONG, port, machine)  # nothing that is told to it now is known to arrive
    return time.monotonic() - when[0]


@pytest.mark.long
@SHUT
@DAEMON
@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff", "enq-ack", "none"])
@pytest.mark.parametrize(
    "serve", [serve_pty, serve_tcp, serve_rfc2217], ids=["pty", "tcp", "rfc2217"]
)
def test_a_cable_that_is_pulled_is_noticed_within_two_seconds(
    serve: Callable[..., Any], handshake: str, machine: Make
) -> None:
    cutter = machine(handshake=handshake, baud=57600)
    simulator = Simulator(cutter, clock=RealClock())
    with serve(simulator) as url, open_port(url, cutter) as port:
        took = ended(port, cutter, 0.7, lambda: simulator.fail(parse("disconnect@0")))
    assert took < WITHIN + LATE


@pytest.mark.parametrize("slug", ["generic-hpgl-600", "grbl-drag-knife", "silhouette-like"])
def test_a_machine_that_answers_and_falls_silent_is_noticed_within_two_seconds(
    slug: str, machine: Make, programs: dict[str, bytes], tmp_path: Path
) -> None:
    cutter = machine(slug, baud=57600)
    simulator = Simulator(cutter, clock=RealClock())
    with serve_pty(simulator, tmp_path / "port") as url, open_port(url, cutter) as port:
        simulator.fail(parse(f"silence@{simulator.clock.now() + 0.8}s"))
        began = time.monotonic()
        with pytest.raises(PlotterError):
            send(programs[cutter.language], port, cutter)
        took = time.monotonic() - began
    assert 0.7 < took < 0.8 + WITHIN + LATE


@pytest.mark.parametrize("slug", ["generic-hpgl-600", "grbl-drag-knife", "silhouette-like"])
def test_a_stop_from_another_thread_is_heard_at_once(
    slug: str, machine: Make, programs: dict[str, bytes]
) -> None:
    cutter, wish = machine(slug, baud=57600), Wish()
    simulator = Simulator(cutter, clock=RealClock())
    seen: list[Progress] = []
    with serve_tcp(simulator) as url, open_port(url, cutter) as port:
        began = time.monotonic()
        Timer(0.8, wish.stop).start()
        with pytest.raises(Stopped, match="The machine was told"):
            send(programs[cutter.language], port, cutter, progress=seen.append, wish=wish)
        took = time.monotonic() - began
    assert 0.7 < took < 0.8 + WITHIN + LATE
    assert seen
    assert seen[-1].bytes < seen[-1].of_bytes
