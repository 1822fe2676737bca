"""Deliver a program to a machine: whole instructions only, never more than it can hold.

"Executed" is said only when the machine has answered a question that it answers in order. Bytes
that a port has accepted prove nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Protocol

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.errors import (
    PlotterError,
    ProgramRefused,
    Stopped,
)
from foldmill_fabricate.plotter.link import clock_of
from foldmill_fabricate.plotter.pacing import SLACK, Pace, pace
from foldmill_fabricate.plotter.program import XY, Job, checked, ready, rechunk
from foldmill_fabricate.plotter.resume import Start, rest
from foldmill_fabricate.plotter.session import PATIENCE, Session, longest
from foldmill_fabricate.plotter.witness import Witness, is_off, position, watched

_OE = {
    1: "an instruction it does not know",
    2: "a wrong number of parameters",
    3: "a parameter out of range",
    5: "an unknown character set",
    6: "a position beyond its limits",
    8: "its pinch wheels up",
}
FROM_THE_START = Start()


class Status(StrEnum):
    """How a delivery ended."""

    EXECUTED = "executed"
    """the machine has answered, in order, that all of it is done"""
    UNCONFIRMED = "sent, not confirmed"
    """all bytes are sent; nobody knows whether they were executed"""
    FAULT = "executed with a fault"
    """the machine has answered, and reports an error or another place than the program's end"""


@dataclass(frozen=True)
class Progress:
    """How far a delivery is: given to the callback after each instruction."""

    bytes: int
    of_bytes: int
    instructions: int
    of_instructions: int


@dataclass(frozen=True)
class Delivery:
    """How a delivery ended, and what it took."""

    status: Status
    bytes: int
    """of HP-GL sent"""
    instructions: int
    seconds: float
    """by the clock, from opening to the last answer"""
    position: XY | None = None
    """where the machine says its tool is, steps"""
    error: int | None = None
    """what OE answered; 0 for none"""
    fault: str = ""
    """what is wrong, a sentence; empty for nothing"""


class Book(Protocol):
    """Where it is written down how far a delivery is."""

    def advance(self, sent: int, acked: int) -> None:
        """Strokes before ``sent`` may be cut, strokes before ``acked`` are."""
        ...


class NoBook:
    """A delivery of which nothing is kept: of a test, or a trial."""

    def advance(self, sent: int, acked: int) -> None:
        """Keep nothing."""


def as_sent(program: bytes, machine: Machine, buffer: int | None = None) -> bytes:
    """Return the bytes that reach the machine: the same path, in instructions it can hold.

    buffer : bytes; the profile's where not given. Raises ProgramRefused.
    """
    limit = longest(buffer or machine.serial.buffer, machine)
    return rechunk(checked(program, machine), limit)


def send(
    program: bytes,
    port: Any,
    machine: Machine,
    clock: Clock | None = None,
    progress: Callable[[Progress], None] | None = None,
    start: Start = FROM_THE_START,
    book: Book | None = None,
) -> Delivery:
    """Send a program and wait until the machine says it is executed, or cannot say.

    port : an open port of ``open_port``; clock : the port's own where not given; start : where it
    is taken up again; book : is told of every stroke before a byte of it leaves. On any exception
    the machine is stopped first, as far as its profile allows. Raises ProgramRefused before
    anything is sent, Stopped on Ctrl-C, NoAnswer for a machine that has gone silent, PlotterError
    for a port that fails; their text says what the operator has to do.
    """
    if machine.serial.handshake == "esc-b" and not machine.serial.answers:
        raise ProgramRefused(
            f"{machine.slug} is to be asked for its free bytes (handshake esc-b), but does not "
            'answer (answers = false). Use the handshake "xon-xoff" or "none".'
        )
    ready(as_sent(program, machine), machine)  # refused before a byte leaves
    session = Session(port, machine, clock or clock_of(port))
    try:
        return _Delivery(session, book or NoBook()).run(
            program, start, progress or (lambda _: None)
        )
    except KeyboardInterrupt:
        raise Stopped(f"Stopped. {session.stop()}") from None
    except OSError as error:
        kind = type(error) if isinstance(error, PlotterError) else PlotterError
        words = str(error) if isinstance(error, PlotterError) else f"The port failed: {error}."
        raise kind(f"{words} {session.stop()}") from error
    except BaseException as error:
        error.add_note(session.stop())
        raise


def whereabouts(port: Any, machine: Machine, clock: Clock | None = None) -> XY | None:
    """Have a machine drop what it holds, and say where its tool stands, steps.

    None where it cannot drop a half-sent instruction, or does not answer: then nothing is sent.
    """
    if machine.serial.handshake != "esc-b":
        return None
    session = Session(port, machine, clock or clock_of(port))
    session.open()
    session.write(b"OA;")
    answer = session.place(session.clock.now() + PATIENCE)
    return position(answer) if answer else None


class _Delivery:
    """One program on its way."""

    def __init__(self, session: Session, book: Book) -> None:
        self._session, self._book = session, book

    def run(self, program: bytes, start: Start, tell: Callable[[Progress], None]) -> Delivery:
        session, began = self._session, self._session.clock.now()
        session.open()
        machine = session.machine
        job = ready(as_sent(program, machine, session.buffer), machine)
        if not start.is_fresh:
            job = rest(job, machine, longest(session.buffer, machine), start)
        if machine.serial.answers:
            job = watched(job)
        feed, witness = pace(session, job), Witness(session, job)
        self._stream(job, feed, witness, tell)
        feed.finish()
        status, place, error, fault = self._confirm(job, feed, witness)
        if status is Status.EXECUTED:
            self._book.advance(job.strokes, job.strokes)
        count = sum(not part.asks for part in job.parts)
        seconds = session.clock.now() - began
        return Delivery(status, len(job.data), count, seconds, place, error, fault)

    def _stream(
        self, job: Job, feed: Pace, witness: Witness, tell: Callable[[Progress], None]
    ) -> None:
        total, count = len(job.data), sum(not part.asks for part in job.parts)
        sent = done = 0
        for number, part in enumerate(job.parts):
            feed.wait_for(number)
            self._book.advance(min(part.stroke + 1, job.strokes), witness.acked)
            self._session.write(part.data)
            feed.written(number)
            witness.written(number)
            if not part.asks:
                sent, done = sent + len(part.data), done + 1
                tell(Progress(sent, total, done, count))

    def _confirm(
        self, job: Job, feed: Pace, witness: Witness
    ) -> tuple[Status, XY | None, int | None, str]:
        """Ask what is answered in order: where the tool is, and whether anything went wrong."""
        session = self._session
        if not session.machine.serial.answers:
            return Status.UNCONFIRMED, None, None, ""
        session.write(b"OA;")
        deadline = session.clock.now() + PATIENCE + SLACK * feed.ahead
        heard = witness.finish(deadline)
        self._book.advance(job.strokes, witness.acked)
        place = session.place(deadline) if heard else None
        if place is None:
            return Status.UNCONFIRMED, None, None, ""
        session.write(b"OE;")
        found = session.answer(session.clock.now() + PATIENCE)
        if found is None:
            return Status.UNCONFIRMED, position(place), None, ""
        error = int(found) if found.isdigit() else None
        lost = session.io_error() if session.controls else 0
        fault = _fault(job, place, found, lost)
        return Status.FAULT if fault else Status.EXECUTED, position(place), error, fault


def _fault(job: Job, place: str, error: str, lost: int | None) -> str:
    if error != "0":
        meaning = _OE.get(int(error), "an error") if error.isdigit() else "something else"
        return f"The machine reports error {error}: {meaning}."
    if lost:
        return f"The machine reports that bytes were lost or garbled on the line (error {lost})."
    at = position(place)
    if at is None:
        return f"The machine answered {place!r} where it should have told its position."
    if job.end and is_off(at, job.end):
        return (
            f"The tool stands at {at[0]:g}, {at[1]:g} steps, but the program ends at "
            f"{job.end[0]:g}, {job.end[1]:g}."
        )
    return ""
