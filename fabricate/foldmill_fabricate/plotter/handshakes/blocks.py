"""ENQ/ACK and the DTR line: the machine promises a block of bytes at a time."""

from __future__ import annotations

from abc import ABC, abstractmethod

from foldmill_fabricate.plotter.errors import NoAnswer
from foldmill_fabricate.plotter.handshakes.feed import IN_FLIGHT, NAP, SLACK
from foldmill_fabricate.plotter.handshakes.hp import HpSession
from foldmill_fabricate.plotter.handshakes.modelled import Modelled
from foldmill_fabricate.plotter.languages import block
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import PATIENCE

_FIRST = 0.002
"""s between two looks at a line."""


class _Blocks(Modelled, ABC):
    """Writes what was promised, then waits for the next promise."""

    def __init__(self, session: HpSession, job: Job) -> None:
        super().__init__(session, job)
        self._block, self._credit = block(session.buffer), 0

    def guard(self, number: int) -> None:
        """Wait for a block's promise where the last one is used up."""
        length = len(self.sums.parts[number].data)
        if length > self._credit:
            self.promise(self.session.clock.now() + PATIENCE + SLACK * max(self.ahead, IN_FLIGHT))
            self._credit = self._block
        self._credit -= length

    @abstractmethod
    def promise(self, deadline: float) -> None:
        """Wait until the machine has room for a block; raises NoAnswer by ``deadline``."""

    def _held(self, what: str) -> NoAnswer:
        return NoAnswer(
            f"The plotter has {what} since instruction {self.sent} of {len(self.sums.parts)}; it "
            "may be paused or out of order, or the cable may lack that line."
        )


class Enquired(_Blocks):
    """``enq-ack``: ENQ is answered by ACK when a block fits."""

    def promise(self, deadline: float) -> None:
        """Ask, and wait for the ACK."""
        session = self.session
        session.listen()  # what acknowledges an ENQ that was asked before promises nothing now
        before = session.acks
        session.enquire()
        while session.acks == before:
            if session.clock.now() >= deadline:
                raise self._held("not acknowledged an ENQ")
            session.wait_a_byte()
            self.witness.hear()


class Wired(_Blocks):
    """``dtr``: the machine's DTR, which the computer sees as DSR, is high while a block fits."""

    def promise(self, deadline: float) -> None:
        """Look at the line once all that was written has arrived."""
        session, nap = self.session, _FIRST
        session.rest_until(session.line_free + 2 * session.byte_time)
        while session.unsent() or not session.port.dsr:
            if session.clock.now() >= deadline:
                raise self._held("held its DTR line low")
            session.rest_until(session.clock.now() + nap)
            nap = min(NAP, 2 * nap)
            self.witness.hear()
