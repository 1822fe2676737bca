"""What the HP-GL handshakes share: the questions between strokes, and the one at the end."""

from __future__ import annotations

from foldmill_fabricate.plotter.endings import Ending, Status
from foldmill_fabricate.plotter.handshakes.feed import NAP, SLACK, Sums
from foldmill_fabricate.plotter.handshakes.hp import HpSession
from foldmill_fabricate.plotter.handshakes.losses import Losses
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import PATIENCE
from foldmill_fabricate.plotter.witness import QUESTION, Witness, is_off, position, reported

_WHOLE = "Every stroke ended where it should, and the machine has reported no byte lost."
_ENDS = (
    "Every stroke ended where it should, and no instruction was refused. Whether one inside a "
    "stroke was lost on the line, this machine does not say: look at the sheet."
)


class Proving:
    """A feed that hears proofs; the handshakes add when the next unit may go."""

    def __init__(self, session: HpSession, job: Job) -> None:
        self.session, self.job, self.sums = session, job, Sums(job)
        self.witness = Witness(session, job)
        self.losses = Losses(session, self.witness)
        self.sent = 0
        """Units written."""

    @property
    def ahead(self) -> float:
        """Motion that may still be under way, s."""
        return self.sums.in_flight(self.witness.executed, self.sent)

    @property
    def acked(self) -> int:
        """Strokes that are known to be executed: all before this one."""
        return self.witness.strokes_before(self.losses.certain)

    @property
    def busy_until(self) -> float:
        """As long as what was sent beyond a question takes, since that was last seen unanswered."""
        when, number = self.witness.seen_open
        return when + self.sums.in_flight(number, self.sent)

    @property
    def answers(self) -> bool:
        """Whether the machine answers questions in its program."""
        return self.session.machine.serial.answers

    def written(self, number: int) -> None:
        """Count it as sent, and hear what has come."""
        self.sent = number + 1
        self.witness.written(number, self.deadline())
        self.witness.hear()

    def deadline(self) -> float:
        """Return by when all that is sent must be executed, s."""
        session = self.session
        start = max(session.clock.now(), session.line_free)
        return start + PATIENCE + SLACK * self.ahead

    def idle(self) -> None:
        """Pass a moment of a pause."""
        self.session.rest_until(self.session.clock.now() + NAP)
        self.witness.hear()

    def drain(self) -> None:
        """Wait until no question of the handshake's own is open."""

    def confirm(self) -> Ending:
        """Ask where the tool is, and whether anything went wrong."""
        self.drain()
        if not self.answers:
            return Ending(Status.UNCONFIRMED)
        self.session.write(QUESTION)
        deadline = self.deadline()
        proof = self.session.proof(deadline) if self.witness.finish(deadline) else None
        if proof is None:
            return Ending(Status.UNCONFIRMED)
        place, found = proof
        lost = self.losses.told()
        if lost is None:
            return Ending(Status.UNCONFIRMED)
        fault = _fault(self.job, place, found) or lost
        error = int(found) if found.isdigit() else None
        if fault:
            return Ending(Status.FAULT, position(place), error, fault)
        if not self.session.reports:
            return Ending(Status.ENDED, position(place), error, proved=_ENDS)
        return Ending(Status.EXECUTED, position(place), error, proved=_WHOLE)


def _fault(job: Job, place: str, error: str) -> str:
    if error != "0":
        told = reported(error)
        return told[0].upper() + told[1:]
    at = position(place)
    if at is None:
        return f"The machine answered {place!r} where it should have told its position."
    if job.end and is_off(at, job.end):
        return (
            f"The tool stands at {at[0]:g}, {at[1]:g} steps, but the program ends at "
            f"{job.end[0]:g}, {job.end[1]:g}."
        )
    return ""
