"""Deliver a program to a machine: whole instructions only, never more than it can hold.

"Executed" is said only when the machine has answered a question that it answers in order. Bytes
that a port has accepted prove nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.endings import Status as Status
from foldmill_fabricate.plotter.errors import PlotterError, Stopped
from foldmill_fabricate.plotter.flow import Flow as Flow
from foldmill_fabricate.plotter.flow import Gauge
from foldmill_fabricate.plotter.handshakes import choice
from foldmill_fabricate.plotter.handshakes.feed import Feed
from foldmill_fabricate.plotter.languages import longest, made_ready, spoken
from foldmill_fabricate.plotter.link import clock_of
from foldmill_fabricate.plotter.program import XY, Job
from foldmill_fabricate.plotter.resume import Start
from foldmill_fabricate.plotter.session import BY_HAND, Session
from foldmill_fabricate.plotter.wish import Wish

FROM_THE_START = Start()


@dataclass(frozen=True)
class Progress:
    """How far a delivery is: given to the callback after each instruction."""

    bytes: int
    of_bytes: int
    instructions: int
    of_instructions: int
    flow: Flow = field(default=Flow(), compare=False)
    """how evenly the machine was fed so far"""


@dataclass(frozen=True)
class Delivery:
    """How a delivery ended, and what it took."""

    status: Status
    bytes: int
    """of the program sent"""
    instructions: int
    seconds: float
    """by the clock, from opening to the last answer"""
    position: XY | None = None
    """where the machine says its tool is: steps, of GRBL mm"""
    error: int | None = None
    """the error it reports; 0 for none"""
    fault: str = ""
    """what is wrong, a sentence; empty for nothing"""
    proved: str = ""
    """what the machine's answers prove, and what they do not; empty for nothing"""
    flow: Flow = field(default=Flow(), compare=False)
    """how evenly the machine was fed"""
    modelled: float = 0.0
    """s of motion of what was sent, by the machine's figures"""


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
    return spoken(machine).as_sent(program, machine, limit)


def send(
    program: bytes,
    port: Any,
    machine: Machine,
    clock: Clock | None = None,
    progress: Callable[[Progress], None] | None = None,
    start: Start = FROM_THE_START,
    book: Book | None = None,
    wish: Wish | None = None,
) -> Delivery:
    """Send a program and wait until the machine says it is executed, or cannot say.

    port : an open port of ``open_port``; clock : the port's own where not given; start : where it
    is taken up again; book : is told of every stroke before a byte of it leaves; wish : by which
    another thread pauses or stops it. On any exception the machine is stopped first, as far as its
    profile allows. Raises ProgramRefused before anything is sent, Stopped on Ctrl-C, NoAnswer for a
    machine that has gone silent, PlotterError for a port that fails; their text says what the
    operator has to do.
    """
    job = made_ready(program, machine)  # refused before a byte leaves
    session = choice.session(port, machine, clock or clock_of(port), wish)
    try:
        return _Delivery(session, book or NoBook()).run(
            program, job, start, progress or (lambda _: None)
        )
    except KeyboardInterrupt:
        raise Stopped(f"Stopped. {session.stop()}") from None
    except PlotterError as error:
        raise type(error)(f"{error} {session.stop()}") from error
    except OSError as error:
        session.stop()  # whether it arrives nobody knows: a closed connection takes bytes, too
        raise PlotterError(f"The port failed: {error}. {BY_HAND}") from error
    except BaseException as error:
        error.add_note(session.stop())
        raise


class _Delivery:
    """One program on its way."""

    def __init__(self, session: Session, book: Book) -> None:
        self._session, self._book = session, book
        self._gauge = Gauge(session)

    def run(
        self, program: bytes, job: Job, start: Start, tell: Callable[[Progress], None]
    ) -> Delivery:
        session, began = self._session, self._session.clock.now()
        session.open()
        machine = session.machine
        if session.buffer != machine.serial.buffer:  # as the machine says
            job = made_ready(program, machine, session.buffer)
        if not start.is_fresh:
            limit = longest(session.buffer, machine)
            job = spoken(machine).rest(job, machine, limit, start)
        session.lift = job.lift
        job = choice.prepared(job, machine)
        feed = choice.feed(session, job)
        self._stream(job, feed, tell)
        self._book.advance(job.strokes, feed.acked)
        end = feed.confirm()
        certain = job.strokes if end.status.is_done else feed.acked
        self._book.advance(job.strokes, certain)
        count = sum(not part.asks for part in job.parts)
        seconds = session.clock.now() - began
        how = end.position, end.error, end.fault, end.proved
        so = self._gauge.flow, job.seconds
        return Delivery(end.status, len(job.data), count, seconds, *how, *so)

    def _stream(self, job: Job, feed: Feed, tell: Callable[[Progress], None]) -> None:
        total, count = len(job.data), sum(not part.asks for part in job.parts)
        sent = done = 0
        for number, part in enumerate(job.parts):
            if number == 0 or not job.parts[number - 1].down:
                self._pause(feed)
            feed.wait_for(number)
            self._book.advance(min(part.stroke + 1, job.strokes), feed.acked)
            self._session.write(part.data)
            self._gauge.written(part, feed.busy_until)
            feed.written(number)
            if not part.asks:
                sent, done = sent + len(part.data), done + 1
                tell(Progress(sent, total, done, count, self._gauge.flow))

    def _pause(self, feed: Feed) -> None:
        """Send nothing, tool up, for as long as a person wants that."""
        if not self._session.wish.paused:
            return
        began = self._session.clock.now()
        while self._session.wish.paused:
            feed.idle()
            self._session.heed()
        self._gauge.paused(self._session.clock.now() - began)
