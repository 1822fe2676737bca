"""Answers that come late are never taken for those to later questions.

The machine answers in order; a wire that holds its answers back for a while, as a network does, or
a busy computer, changes neither their order nor what they mean.
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from typing import Any

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.sender import Delivery, as_sent, send
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.firmware import FRAMING, OVERLAP
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.simulator.trial import fine_lines, without_questions
from foldmill_fabricate.plotter.standing import stand

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]

_SLICE = 0.002
"""s between two looks at the machine while its answers are held back."""
STROKES = 60
TEETH = b"IN;SP1;VS10;" + b"".join(
    b"PU%d,0;PD%d,%d;PD%d,0;" % (x, x, 500 + x // 4, x) for x in range(0, 100 * STROKES, 100)
)
TEETH += b"PU;SP0;"


class Slow:
    """A wire on which what a machine says is held back now and then, and stays in order.

    lag : how long a byte said at a time is held back, s.
    """

    timeout: float | None = 0.02

    def __init__(self, port: Any, lag: Callable[[float], float]) -> None:
        self._port, self._lag, self.clock = port, lag, port.clock
        self._held: deque[tuple[float, bytes]] = deque()
        self._port.timeout = 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._port, name)

    @property
    def in_waiting(self) -> int:
        self._take()
        now = self.clock.now()
        return sum(moment <= now for moment, _ in self._held)

    def read(self, size: int = 1) -> bytes:
        end = self.clock.now() + (self.timeout or 0)
        while self.in_waiting < size and self.clock.now() < end:
            self.clock.sleep(_SLICE)
        return b"".join(self._held.popleft()[1] for _ in range(min(size, self.in_waiting)))

    def write(self, data: bytes) -> int:
        self._take()
        return int(self._port.write(data))

    def reset_input_buffer(self) -> None:
        """Drop what has come; what is held back on its way is still to come."""
        self.read(self.in_waiting)

    def answered_before(self, data: bytes) -> None:
        """Let what the machine has said to somebody else arrive in a moment."""
        soon = self.clock.now() + _SLICE
        self._held += ((soon, bytes((byte,))) for byte in data)

    def _take(self) -> None:
        now = self.clock.now()
        for byte in self._port.read(self._port.in_waiting):
            last = self._held[-1][0] if self._held else now
            self._held.append((max(last, now + self._lag(now)), bytes((byte,))))


def now_and_then(seed: int, most: float) -> Callable[[float], float]:
    """Return a lag: in one of three spans of time answers are held back, ``most`` s at most."""
    chance = random.Random(seed)
    spans = [chance.choice([0.0, 0.0, chance.uniform(0, most)]) for _ in range(997)]
    return lambda now: spans[int(now / 0.15) % len(spans)]


class Truth:
    """Compares what a delivery writes down with what the simulator has drawn by then."""

    def __init__(self, simulator: Simulator) -> None:
        self.simulator, self.sent, self.acked = simulator, 0, 0

    def advance(self, sent: int, acked: int) -> None:
        drawn = len(self.simulator.sheet.strokes[Face.FRONT])
        assert acked <= drawn <= max(self.sent, sent)
        self.sent, self.acked = sent, acked


def delivered(
    program: bytes, cutter: Machine, plugged: Plug, lag: Callable[[float], float], **more: Any
) -> tuple[Simulator, Truth, Delivery | PlotterError]:
    simulator = Simulator(cutter, **more)
    book = Truth(simulator)
    with open_port(plugged(simulator), cutter) as port:
        try:
            return simulator, book, send(program, Slow(port, lag), cutter, book=book)
        except PlotterError as error:
            return simulator, book, error


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("buffer", "baud"), [(1024, 115200), (1024, 9600), (255, 9600)])
def test_a_program_arrives_whole_however_late_its_answers_are(
    buffer: int, baud: int, seed: int, machine: Make, plugged: Plug
) -> None:
    cutter = machine(buffer=buffer, baud=baud)
    simulator, book, end = delivered(TEETH, cutter, plugged, now_and_then(seed, 0.6))
    assert isinstance(end, Delivery), end
    assert end.status.is_done, end
    assert book.acked == STROKES
    assert {*simulator.device.traffic.errors} <= {OVERLAP}


@pytest.mark.parametrize("seed", range(4))
def test_a_late_answer_never_promises_room_that_there_is_not(
    seed: int, machine: Make, plugged: Plug
) -> None:
    cutter = machine(buffer=255, baud=9600, acceleration=1000.0)
    program = fine_lines(15_000, 8)
    simulator, _, end = delivered(program, cutter, plugged, now_and_then(seed, 0.9))
    traffic = simulator.device.traffic
    assert isinstance(end, Delivery), end
    assert traffic.overruns == 0
    assert traffic.fullest <= 255 - (63 - 2 * 15)


@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff"])
@pytest.mark.parametrize("seed", range(8))
def test_late_answers_never_make_a_stroke_certain_before_which_bytes_were_lost(
    handshake: str, seed: int, machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake=handshake, reports_losses=True)
    place = random.Random(seed).randrange(300, 2000)
    lag = now_and_then(seed, 0.9)
    faults = parse(f"framing@{place}x1")
    simulator, book, end = delivered(TEETH, cutter, plugged, lag, faults=faults)
    if FRAMING not in simulator.device.traffic.errors:
        return  # it met device control, which was asked again
    came, sent = without_questions(bytes(simulator.device.traffic.program)), as_sent(TEETH, cutter)
    whole = next((k for k in range(len(came)) if came[k] != sent[k]), len(came))
    assert not isinstance(end, Delivery) or not end.status.is_done
    assert book.acked < sent[:whole].count(b"PU")


def test_a_cutter_is_not_taken_for_ready_by_what_it_told_somebody_else(
    machine: Make, plugged: Plug
) -> None:
    cutter = machine("silhouette-like", lift_time=0.2)
    program = b"".join(
        b"M%d,100\x03D%d,3000,%d,100\x03" % (x, x, x + 20) for x in range(100, 2500, 40)
    )
    simulator = Simulator(cutter)
    early: list[int] = []

    class Certain:
        def advance(self, _sent: int, acked: int) -> None:
            ended = simulator.device.idle and simulator.sheet.under_way  # its tool is still down
            early.append(acked - len(simulator.sheet.strokes[Face.FRONT]) - ended)

    with open_port(plugged(simulator), cutter) as port:
        wire = Slow(port, lambda _: 0.0)
        wire.answered_before(b"0\x03")
        send(program, wire, cutter, book=Certain())
    assert len(early) > 60
    assert max(early) <= 0


@pytest.mark.parametrize(
    "stale", [b"1000\r", b"0\r", b"16\r", b"7,7,0\r", b"7,7,0\r0\r", b"7,7,0\r0\r0\r"]
)
def test_what_a_killed_sender_had_asked_is_answered_before_the_next_ones_questions(
    stale: bytes, machine: Make, plugged: Plug
) -> None:
    cutter = machine(buffer=255, baud=9600, acceleration=1000.0)
    simulator = Simulator(cutter)
    with open_port(plugged(simulator), cutter) as port:
        port.write(b"IN;SP1;PU300,0;")
        simulator.rest()
        wire = Slow(port, lambda _: 0.0)
        wire.answered_before(stale)
        found = stand(wire, cutter)
        assert found is not None
        assert found.at == (300, 0)
        wire.answered_before(stale)
        assert send(fine_lines(6_000, 8), wire, cutter).status.is_done
    assert simulator.device.traffic.overruns == 0
    assert simulator.device.traffic.fullest <= 255 - (63 - 2 * 15)
