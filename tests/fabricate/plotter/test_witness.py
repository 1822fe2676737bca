"""What a delivery writes down while it works encloses what the machine has really done."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.errors import NoAnswer, PlotterError
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.program import ready
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.sender import Status, send
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.witness import LONG, watched

Make = Callable[..., Machine]
Plug = Callable[[Simulator], str]

STROKES = 60
PROGRAM = b"IN;SP1;VS10;" + b"".join(
    b"PU%d,0;PD%d,%d;PD%d,0;" % (x, x, 500 + x // 4, x) for x in range(0, 100 * STROKES, 100)
)
PROGRAM += b"PU;SP0;"


class Book:
    """Keeps what it is told, and compares it with what the simulator has drawn by then."""

    def __init__(self, simulator: Simulator) -> None:
        self.simulator = simulator
        self.sent = self.acked = 0
        self.steps: list[tuple[int, int]] = []

    def advance(self, sent: int, acked: int) -> None:
        drawn = len(self.simulator.sheet.strokes[Face.FRONT])
        assert acked <= drawn
        assert drawn <= max(self.sent, sent)
        assert sent >= self.sent
        assert acked >= self.acked
        self.sent, self.acked = sent, acked
        self.steps.append((sent, acked))


@pytest.mark.parametrize("buffer", [128, 1024])
@pytest.mark.parametrize("handshake", ["esc-b", "xon-xoff", "none"])
def test_certain_strokes_are_drawn_and_drawn_strokes_were_written_down(
    handshake: str, buffer: int, machine: Make, plugged: Plug
) -> None:
    cutter = machine(handshake=handshake, buffer=buffer)
    simulator = Simulator(cutter)
    book = Book(simulator)
    with open_port(plugged(simulator), cutter) as port:
        assert send(PROGRAM, port, cutter, book=book).status.is_done
    assert (book.sent, book.acked) == (STROKES, STROKES)
    doubtful = max(sent - acked for sent, acked in book.steps)
    assert doubtful < STROKES / 3
    assert len({acked for _, acked in book.steps}) > 10


@pytest.mark.parametrize("handshake", ["xon-xoff", "none"])
def test_a_machine_that_never_answers_confirms_nothing(
    handshake: str, machine: Make, plugged: Plug
) -> None:
    mute = machine(handshake=handshake, answers=False)
    simulator = Simulator(mute)
    book = Book(simulator)
    with open_port(plugged(simulator), mute) as port:
        assert send(PROGRAM, port, mute, book=book).status is Status.UNCONFIRMED
    assert book.acked == 0
    assert b"OA" not in simulator.device.traffic.program


@pytest.mark.parametrize("dead_after", [200, 700, 1100])
def test_when_a_machine_falls_silent_the_truth_lies_between_the_books_two_numbers(
    dead_after: int, machine: Make, plugged: Plug
) -> None:
    simulator = Simulator(machine(), faults=parse(f"silence@{dead_after}"))
    book = Book(simulator)
    with open_port(plugged(simulator), machine()) as port, pytest.raises(NoAnswer):
        send(PROGRAM, port, machine(), book=book)
    assert book.acked <= len(simulator.sheet.strokes[Face.FRONT]) <= book.sent


@pytest.mark.parametrize("stroke", [0, 1, 30, STROKES - 1])
def test_a_delivery_that_is_taken_up_again_cuts_what_is_left(
    stroke: int, machine: Make, plugged: Plug
) -> None:
    whole, part = Simulator(machine()), Simulator(machine())
    for simulator, start in ((whole, Start()), (part, Start(stroke))):
        with open_port(plugged(simulator), machine()) as port:
            send(PROGRAM, port, machine(), start=start)
    drawn = whole.sheet.strokes[Face.FRONT]
    assert part.sheet.strokes[Face.FRONT] == drawn[stroke:]


def test_a_tool_that_was_pushed_is_noticed_at_the_next_question(
    machine: Make, plugged: Plug
) -> None:
    class Lossy:
        """Loses the second half of a stroke."""

        def __init__(self, port: Any) -> None:
            self.__dict__.update(port=port)

        def __getattr__(self, name: str) -> Any:
            return getattr(self.port, name)

        def write(self, data: bytes) -> int:
            return len(data) if data == b"PD2000,0;" else int(self.port.write(data))

    simulator = Simulator(machine())
    with (
        open_port(plugged(simulator), machine()) as port,
        pytest.raises(PlotterError, match=r"After stroke 21 the tool stands at 2000, 1000 steps"),
    ):
        send(PROGRAM, Lossy(port), machine())
    assert len(simulator.sheet.strokes[Face.FRONT]) < STROKES


def test_questions_stand_between_strokes_and_never_far_apart(machine: Make) -> None:
    job = ready(PROGRAM, machine())
    parts = watched(job).parts
    assert b"".join(part.data for part in parts if not part.asks) == job.data
    since = 0.0
    stroke = -1
    for part, after in pairwise(parts):
        since += part.seconds
        if part.asks:
            assert after.stroke == part.stroke + 1
            assert since <= LONG or part.stroke == stroke + 1
            since, stroke = 0.0, part.stroke
    assert sum(part.asks for part in parts) > 10
