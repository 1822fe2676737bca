"""Every fault at every handshake at three places: what happens, and what must.

A cell ends in one of four ways. (A) recovered: executed, and what was drawn is what was planned.
(B) stopped, or not confirmed by a machine that can confirm: what was drawn holds all that the book
calls certain and nothing that was not sent, and what is in doubt is short. (C) undetectable, for
this handshake hears nothing of it: "sent, not confirmed", or "at its end" with the statement that
nobody asked whether all was received; never "executed". (D) a digit of a vertex became another on a
line without parity: no machine can know, and what it says is true of the program that it received.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from foldmill import installed
from foldmill_fabricate.hooks import MACHINES
from foldmill_fabricate.machines import Machine
from foldmill_fabricate.passes import Face
from foldmill_fabricate.plotter.endings import Status
from foldmill_fabricate.plotter.errors import PlotterError
from foldmill_fabricate.plotter.handshakes import choice
from foldmill_fabricate.plotter.handshakes.feed import IN_FLIGHT
from foldmill_fabricate.plotter.languages import made_ready
from foldmill_fabricate.plotter.link import open_port
from foldmill_fabricate.plotter.program import Instruction
from foldmill_fabricate.plotter.sender import send
from foldmill_fabricate.plotter.simulator import devices
from foldmill_fabricate.plotter.simulator.drawing import Drawn
from foldmill_fabricate.plotter.simulator.faults import parse
from foldmill_fabricate.plotter.simulator.machine import Simulator
from foldmill_fabricate.plotter.witness import EVERY, LONG

STROKES = 14
_X = range(1000, 1000 + 200 * STROKES, 200)
HPGL = b"IN;SP1;VS10;" + b"".join(
    b"PU%d,1000;PD%d,%d;PD%d,1200;" % (x, x, 2500 + x // 8, x + 50) for x in _X
)
GCODE = b"G21G90\nG0Z5\n" + b"".join(
    b"G0X%d.5Y10\nG1Z-1F600\nG1X%d.5Y40F6000\nG1X%d.75Y12.25\nG0Z5\n" % (x, x, x)
    for x in range(10, 10 + STROKES)
)
GPGL = b"J1\x03!1\x03FX10\x03" + b"".join(
    b"M%d,1000\x03D%d,%d,%d,1200\x03" % (x, x, 1800 + x // 8, x + 50) for x in _X
)
PROGRAMS = {
    "hpgl": HPGL + b"PU;SP0;",
    "gcode": GCODE + b"G0X0Y0\n",
    "gp-gl": GPGL + b"M0,0\x03",
}

HANDSHAKES = {
    "none": ("generic-hpgl-600", {"answers": False}),
    "paced": ("generic-hpgl-600", {"answers": False}),
    "xon-xoff": ("generic-hpgl-600", {}),
    "rts-cts": ("generic-hpgl-600", {}),
    "dtr": ("generic-hpgl-600", {"reports_losses": True}),
    "esc-b": ("generic-hpgl-600", {}),
    "enq-ack": ("generic-hpgl-600", {}),
    "grbl": ("grbl-drag-knife", {}),
    "gp-gl": ("silhouette-like", {}),
}
PLACES = (0.2, 0.5, 0.8)
"""Shares of the program."""
FAULTS = {
    "silence": "silence@{strokes}strokes",
    "mute": "mute@{strokes}strokes",
    "stall, 1 s": "stall@{strokes}strokes:1s",
    "stall": "stall@{strokes}strokes",
    "wait, 1 s": "xoff@{strokes}strokes:1s",
    "wait": "xoff@{strokes}strokes",
    "garbage": "garbage@{bytes}x4",
    "noise": "noise@{bytes}x7",
    "framing": "framing@{bytes}x7",
    "overflow": "overflow@{bytes}x7",
    "vertex dropped": "overflow@{vertex}programx{length}",
    "digit": "noise@{digit}programx1",
    "disconnect": "disconnect@{strokes}strokes",
    "disconnect, 3 s": "disconnect@{strokes}strokes:3s",
    "lever": "lever@{strokes}strokes",
    "power": "power@{strokes}strokes",
    "power, 3 s": "power@{strokes}strokes:3s",
    "slow": "slow@{strokes}strokesx10",
    "slow, a little": "slow@{strokes}strokesx1.3",
}


ORDER = ["none", "paced", "xon-xoff", "rts-cts", "dtr", "esc-b", "enq-ack", "grbl", "gp-gl"]
EXPECTED = {
    # handshake:      none paced xon rts dtr esc-b enq grbl gp-gl
    "silence": "C C B B B B B B B",
    "mute": "C C B B B B B B B",
    "stall, 1 s": "C C A A A A A A C",
    "stall": "C C B B B B B B B",
    "wait, 1 s": "C C A A A A A A C",
    "wait": "C C B B B A B B B",
    "garbage": "C C B B B B B B B",
    "noise": "C C B B B B B B B",
    "framing": "C C B B B B B B B",
    "overflow": "C C B B B B B B C",
    "vertex dropped": "C C C C B B B B C",
    "digit": "C C C C D D D D C",
    "disconnect": "B B B B B B B B B",
    "disconnect, 3 s": "B B B B B B B B B",
    "lever": "C C B B B B B B B",
    "power": "C C B B B B B B B",
    "power, 3 s": "C C B B B B B B B",
    "slow": "C C B B B B B A B",
    "slow, a little": "C C A A A A A A C",
}
"""The end of every cell; it is the same at the three places."""
LINE = frozenset({"noise", "framing", "overflow", "vertex dropped", "digit"})
"""Faults that change what the machine receives, so that it may see an instruction divided."""
STRAYS = frozenset({"power, 3 s"})
"""Faults after which a machine may draw a line from its origin: its power was away and came back
while bytes were on their way, which only its next answer tells, and some machines never."""
DROPPED = frozenset({"overflow", "vertex dropped"})
"""Faults that drop bytes at the machine, whatever its room."""
_ERROR_ASKED = 1.05
"""s between two ESC.E at most: 0.8 s, and the longest nap between two questions."""
WINDOW = {
    **dict.fromkeys(("xon-xoff", "rts-cts"), IN_FLIGHT + LONG),
    **dict.fromkeys(("dtr", "enq-ack"), IN_FLIGHT + LONG + EVERY),
    "esc-b": IN_FLIGHT + LONG + _ERROR_ASKED,
    **dict.fromkeys(("grbl", "gp-gl"), IN_FLIGHT),
}
"""Motion that may be sent and not certain, s, besides one stroke, which counts as soon as its first
byte leaves. Three seconds are in flight by the model. Proofs stand between strokes, so that up to
LONG is executed and not yet proved; where ESC.E must also say that nothing was lost, what was
executed since it was last asked comes on top. GRBL and GP-GL count what is in flight from the last
proof on, and need no more. Handshakes without answers are certain of nothing."""


def expected(cell: Cell) -> str:
    """Return the end that a cell must have."""
    return EXPECTED[cell.fault].split()[ORDER.index(cell.handshake)]


@dataclass(frozen=True)
class Cell:
    """One fault, one handshake, one place."""

    fault: str
    handshake: str
    place: float


@dataclass
class Outcome:
    """What happened in a cell."""

    end: str
    """A, B, C or D"""
    words: str
    """the sentence"""
    drawn: list[Drawn]
    planned: list[Drawn]
    sent: int
    acked: int
    doubt: float
    """s of motion of the strokes that are sent and not certain"""
    longest: float
    """s of the longest stroke"""
    after: float
    """s of motion after the delivery ended"""
    split: int
    overruns: int


class Book:
    """Keeps what it is told."""

    sent = acked = 0

    def advance(self, sent: int, acked: int) -> None:
        assert sent >= self.sent
        assert acked >= self.acked
        self.sent, self.acked = sent, acked


def cells() -> list[Cell]:
    """All of them."""
    return [Cell(f, h, p) for f in FAULTS for h in HANDSHAKES for p in PLACES]


def machine_of(handshake: str) -> Machine:
    """A machine of that handshake."""
    slug, changed = HANDSHAKES[handshake]
    base: Machine = installed().get(MACHINES, "machine", slug)
    serial = base.serial.model_copy(update={"handshake": handshake, **changed})
    return base.model_copy(update={"serial": serial})


_CUTS = re.compile(rb"(?:PD\d+,\d|G1X[\d.]+Y|D\d+,\d)[89]*([0-7])")
"""An instruction that cuts, up to a digit that can become another without a sign."""
_planned: dict[str, list[Drawn]] = {}


def planned(handshake: str) -> list[Drawn]:
    """What is drawn where nothing goes wrong."""
    if handshake not in _planned:
        _planned[handshake] = _run(handshake, "")[1].sheet.strokes[Face.FRONT]
    return _planned[handshake]


def _run(handshake: str, faults: str) -> tuple[str, Simulator, Book, str]:
    machine, book = machine_of(handshake), Book()
    program = PROGRAMS[machine.language]
    simulator = Simulator(machine, faults=parse(faults))
    url, words = devices.plug("matrix", simulator), ""
    try:
        with open_port(url, machine) as port:
            try:
                delivery = send(program, port, machine, book=book)
                status, words = str(delivery.status), delivery.fault
            except PlotterError as error:
                status, words = "stopped", str(error)
    finally:
        devices.unplug(url)
    return status, simulator, book, words


def _end(status: str, as_planned: bool, answers: bool) -> str:
    if status == Status.EXECUTED:
        return "A" if as_planned else "D"
    if status == Status.ENDED:
        return "A" if as_planned else "C"
    return "C" if status == Status.UNCONFIRMED and not answers else "B"


def _vertex(machine: Machine, place: float) -> tuple[int, Instruction]:
    """Return the first instruction that cuts within a stroke, and the program's bytes before it."""
    parts = choice.prepared(made_ready(PROGRAMS[machine.language], machine), machine).parts
    before = len(b"$I\n") if machine.language == "gcode" else 0
    for part in parts:
        if part.stroke == int(STROKES * place) and _CUTS.match(part.data):
            return before, part
        before += len(part.data)
    raise AssertionError(place)


def _spec(cell: Cell, machine: Machine) -> str:
    job = made_ready(PROGRAMS[machine.language], machine)
    before, part = _vertex(machine, cell.place)
    digit = _CUTS.match(part.data)
    assert digit
    return FAULTS[cell.fault].format(
        strokes=int(STROKES * cell.place) + 0.4,
        bytes=int(len(job.data) * cell.place),
        vertex=before,
        length=len(part.data),
        digit=before + digit.start(1),
    )


def run(cell: Cell) -> Outcome:
    """Let it happen."""
    machine = machine_of(cell.handshake)
    job, spec = made_ready(PROGRAMS[machine.language], machine), _spec(cell, machine)
    status, simulator, book, words = _run(cell.handshake, spec)
    wanted = planned(cell.handshake)
    simulator.advance()
    before = simulator.device.carriage.tally.moving
    simulator.clock.sleep(120)
    simulator.advance()
    drawn = simulator.sheet.seen(Face.FRONT)
    seconds = [0.0] * (job.strokes + 2)
    for part in job.parts:
        seconds[part.stroke] += part.seconds
    end = _end(status, drawn == wanted, machine.serial.answers)
    traffic = simulator.device.traffic
    return Outcome(
        end,
        words or status,
        drawn,
        wanted,
        book.sent,
        book.acked,
        sum(seconds[book.acked : book.sent]),
        max(seconds),
        simulator.device.carriage.tally.moving - before,
        traffic.split,
        0 if cell.fault in DROPPED else traffic.overruns,
    )
