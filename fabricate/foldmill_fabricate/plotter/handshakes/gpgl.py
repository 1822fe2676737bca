"""GP-GL: a window of motion, then a status that says whether all of it is done.

ESC ENQ is answered at once: 0 ready, 1 moving, 2 nothing loaded. Ready means that the machine has
done what it received; it has no word for errors, so that a delivery ends unconfirmed.
"""

from __future__ import annotations

from collections import deque
from math import inf

from foldmill_fabricate.plotter.endings import Ending, Status
from foldmill_fabricate.plotter.errors import LineDisturbed, NoAnswer, PlotterError
from foldmill_fabricate.plotter.handshakes.feed import NAP, SLACK, Sums
from foldmill_fabricate.plotter.languages import reserve
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import PATIENCE, SILENCE, Session

_ENQ, _ANEW = b"\x1b\x05", b"\x1b\x04"
_WELCOME = 2.0
_QUIET = 0.1
"""s in which an answer comes that was taken for late: what a killed sender had asked came first."""
_OFTEN = 0.4
"""s between two questions while a window is sent."""


class GpglSession(Session):
    """What a GP-GL machine is asked, and what it answers."""

    ends = b"\x03"

    def open(self) -> None:
        """Have it start anew, which drops what it holds and lifts the tool."""
        self._answers: deque[str] = deque()
        self.forget_answers()
        self.send(_ANEW)
        if self.status(_WELCOME) is None:
            raise NoAnswer(
                f"The cutter does not answer at {self.machine.serial.baud} baud. Is it on, and is "
                "the cable the right one?"
            )
        self.rest_until(self.clock.now() + _QUIET)

    def status(self, patience: float = SILENCE) -> str | None:
        """Ask for the status and wait; None for silence."""
        self.listen()  # whatever has come answers something that was asked before
        self._answers.clear()
        self.send(_ENQ)
        limit = self.line_free + patience
        while not self._answers:
            if self.clock.now() >= limit:
                return None
            self.wait_a_byte()
        return self._answers.popleft()

    def take(self, line: bytes) -> None:
        """Keep an answer."""
        self._answers.append(line.decode("latin-1").strip())

    def abort(self, unsent: int | None) -> str:  # noqa: ARG002
        """Have it start anew, which drops half a command; ETX would end it as a line elsewhere."""
        self.port.write(_ANEW)
        return "The machine was told to drop what it has and to lift its tool."


class Stated:
    """Windows of three seconds of motion, or one stroke, each proved before the next."""

    def __init__(self, session: GpglSession, job: Job) -> None:
        self._session, self._job, self._sums = session, job, Sums(job)
        self._room = session.buffer - reserve(session.buffer)
        self._sent = self._executed = 0
        self._began = self._asked = session.clock.now()
        self._moving = -inf

    @property
    def acked(self) -> int:
        """Strokes that were sent when it last said that it was ready."""
        if self._executed < len(self._sums.parts):
            return min(self._sums.parts[self._executed].stroke, self._job.strokes)
        return self._job.strokes

    @property
    def busy_until(self) -> float:
        """When it last said that it was moving."""
        return self._moving

    def wait_for(self, number: int) -> None:
        """Return when the unit fits into the window; else wait for all before to be done."""
        session, sums = self._session, self._sums
        session.settle()
        in_window = sums.bytes[number + 1] - sums.bytes[self._executed]
        empty = self._executed == number
        if empty or (in_window <= self._room and sums.may_follow(self._executed, number)):
            if session.clock.now() > self._asked + _OFTEN:
                self._is_ready()
            return
        self._until_ready()

    def written(self, number: int) -> None:
        """Count it."""
        if self._executed == self._sent:
            self._began = self._session.clock.now()
        self._sent = number + 1

    def idle(self) -> None:
        """Look at the machine now and then."""
        self._session.rest_until(self._session.clock.now() + 4 * NAP)
        if self._is_ready():
            self._executed = self._sent

    def confirm(self) -> Ending:
        """Wait until it is ready; whether it received all, it cannot tell."""
        self._until_ready()
        return Ending(Status.UNCONFIRMED)

    def _until_ready(self) -> None:
        session = self._session
        ahead = self._sums.in_flight(self._executed, self._sent)
        deadline = max(session.line_free, self._began) + PATIENCE + SLACK * ahead
        while not self._is_ready():
            if session.clock.now() > deadline:
                raise NoAnswer(
                    f"The cutter answers, but is not done with command {self._sent} of "
                    f"{len(self._sums.parts)} in the time that takes: it stands still, or is far "
                    "slower than its profile says."
                )
            session.rest_until(session.clock.now() + NAP / 2)
        self._executed = self._sent

    def _is_ready(self) -> bool:
        session = self._session
        said = session.status()
        self._asked = session.clock.now()
        if said is None:
            raise NoAnswer(
                f"The cutter has stopped answering after command {self._sent} of "
                f"{len(self._sums.parts)}; the cable, or the machine itself."
            )
        if said == "2":
            raise PlotterError("The cutter says that nothing is loaded: see to sheet and lever.")
        if said not in ("0", "1"):
            raise LineDisturbed(
                f"The cutter answered {said!r} where it should have told its status. Something "
                "disturbs the line."
            )
        if said == "1":
            self._moving = self._asked
        return said == "0"
