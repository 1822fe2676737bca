"""GRBL: count the characters that wait in its buffer; a line has left it when its ok comes.

``ok`` says that a line is taken, not done. ``G4P0`` between strokes is answered when all before it
is done. Behind it ``$G`` has an answer of its own: the oks before that are counted, and where one
is missing a line was lost. Both together prove the strokes before. The end is the same, then Idle,
at the program's last place.
"""

from __future__ import annotations

from collections import deque
from math import inf

from foldmill_fabricate.plotter.endings import Ending, Status
from foldmill_fabricate.plotter.errors import LineDisturbed, NoAnswer, PlotterError
from foldmill_fabricate.plotter.handshakes.feed import NAP, SLACK, Sums
from foldmill_fabricate.plotter.handshakes.grbl import GrblSession
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import PATIENCE, SILENCE

QUESTIONS = (b"G4P0\n", b"$G\n")
_WHOLE = (
    "Every line was taken and counted, and the tool stands where the program ends. A digit that "
    "became another on the line would not be told."
)
_OFTEN = 0.4
"""s between two statuses."""
_NEAR = 0.01
"""mm, beyond two steps, that a place may be off."""


class Counted:
    """Character counting against GRBL's receive buffer."""

    def __init__(self, session: GrblSession, job: Job) -> None:
        self._session, self._job, self._sums = session, job, Sums(job)
        self._room = session.buffer - 1
        self._open: deque[int] = deque()
        """Lines without an ok."""
        self._marks: deque[int] = deque()
        """Lines ``$G`` without an answer."""
        self._before = self._oks = session.oks
        self._sent = self._executed = 0
        self._statuses = session.statuses
        self._due: float | None = None
        """When the open status question is silence; None for no open question."""
        self._looked = self._progress = session.clock.now()
        self._at = session.at

    @property
    def acked(self) -> int:
        """Strokes before the last G4 that was answered."""
        if self._executed < len(self._sums.parts):
            return min(self._sums.parts[self._executed].stroke, self._job.strokes)
        return self._job.strokes

    @property
    def busy_until(self) -> float:
        """Now, while a line waits for its ok, or G4 for the end of what is before it."""
        return self._session.clock.now() if self._open or self._marks else -inf

    def wait_for(self, number: int) -> None:
        """Return when the line fits and not too much motion is unproved."""
        self._session.settle()
        self._hear()
        while not self._fits(number):
            self._pass()

    def written(self, number: int) -> None:
        """Count its characters until its ok."""
        self._open.append(number)
        if self._sums.parts[number].data == QUESTIONS[-1]:
            self._marks.append(number)
        self._sent = number + 1
        self._hear()

    def idle(self) -> None:
        """Look at the machine now and then."""
        self._pass()
        self._progress = self._session.clock.now()

    def confirm(self) -> Ending:
        """Wait for the ok of a last G4, then for Idle, then compare the place."""
        session, job = self._session, self._job
        while self._open or self._marks:
            self._pass()
        for question in QUESTIONS:
            session.write(question)
        self._marks.append(self._sent + 1)
        while self._marks:
            self._pass()
        self._executed = len(self._sums.parts)
        limit = session.clock.now() + PATIENCE
        while not session.status().startswith("Idle"):
            if not session.state or session.clock.now() > limit:
                return Ending(Status.UNCONFIRMED)
        at, near = session.at, _NEAR + 2 / session.machine.axes.units_per_mm
        if at and job.end and max(abs(at[0] - job.end[0]), abs(at[1] - job.end[1])) > near:
            fault = (
                f"The tool stands at {at[0]:g}, {at[1]:g} mm, but the program ends at "
                f"{job.end[0]:g}, {job.end[1]:g}."
            )
            return Ending(Status.FAULT, at, None, fault)
        return Ending(Status.EXECUTED, at, 0, proved=_WHOLE)

    def _fits(self, number: int) -> bool:
        sums = self._sums
        waiting = sums.bytes[self._sent] - sums.bytes[self._open[0]] if self._open else 0
        if waiting + len(sums.parts[number].data) > self._room:
            return False
        return sums.may_follow(self._executed, number)

    def _pass(self) -> None:
        """Let a moment pass; raise what it brings."""
        session = self._session
        session.rest_until(session.clock.now() + NAP / 10)
        self._hear()

    def _hear(self) -> None:
        session, now = self._session, self._session.clock.now()
        session.listen()
        if session.trouble:
            raise PlotterError(f"{session.trouble} That was by line {self._sent} of the program.")
        while self._open and self._oks < session.oks:
            self._oks, self._progress = self._oks + 1, now
            self._open.popleft()
        while self._marks and session.marks:
            self._prove(self._marks.popleft(), session.marks.popleft() - self._before)
        self._look(now)

    def _prove(self, number: int, oks: int) -> None:
        if oks != number:
            raise LineDisturbed(
                f"Before line {number + 1} of the program the machine took {oks} lines: something "
                "was lost on the line."
            )
        self._executed = min(number + 1, self._sent)

    def _look(self, now: float) -> None:
        """Ask for a status now and then: a machine gone silent is noticed, and one that stands."""
        session = self._session
        if session.statuses > self._statuses:
            self._statuses, self._due = session.statuses, None
            if session.at != self._at or session.state.startswith(("Hold", "Door")):
                self._at, self._progress = session.at, now  # a person's doing costs nothing
        if self._due is not None and now > self._due:
            raise NoAnswer(
                f"The machine has stopped answering after line {self._sent} of "
                f"{len(self._sums.parts)}; the cable, or the machine itself."
            )
        ahead = self._sums.in_flight(self._executed, self._sent)
        if now > self._progress + PATIENCE + SLACK * ahead:
            raise NoAnswer(
                f"The machine answers, but has not got on after line {self._sent} of "
                f"{len(self._sums.parts)} in the time that takes: it stands still."
            )
        if self._due is None and now >= self._looked + _OFTEN:
            session.ask()
            self._looked, self._due = now, session.line_free + SILENCE
