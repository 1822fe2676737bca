"""No answers about the room: the motion model says what the machine has executed by now.

With XON/XOFF and RTS/CTS the machine guards its buffer itself; without, the model must, and is
taken with caution. What is in flight is judged by proofs where the machine answers any.
"""

from __future__ import annotations

from collections import deque
from math import inf

from foldmill_fabricate.plotter.errors import NoAnswer
from foldmill_fabricate.plotter.handshakes.feed import IN_FLIGHT, NAP, SLACK
from foldmill_fabricate.plotter.handshakes.hp import HpSession
from foldmill_fabricate.plotter.handshakes.proving import Proving
from foldmill_fabricate.plotter.languages import reserve
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import PATIENCE

CAUTION = 1.25
"""How many times longer than modelled a machine is taken to need where it cannot say."""
_LATE = 0.25
"""s after which an answer that the model expects is late."""
_GUARDED = ("xon-xoff", "rts-cts", "dtr", "enq-ack")


class Modelled(Proving):
    """``none``, ``xon-xoff`` and ``rts-cts``; of the others the base."""

    def __init__(self, session: HpSession, job: Job) -> None:
        super().__init__(session, job)
        self._guarded = session.machine.serial.handshake in _GUARDED
        self._factor = 1.0 if self._guarded else CAUTION
        self._room = session.buffer - reserve(session.buffer)
        self._ends: deque[tuple[float, int]] = deque()
        """When each unit in flight is believed to be executed, s, and its number."""
        self._believed: deque[tuple[float, int]] = deque()
        """Questions that the model has passed, and no proof yet: when, s, and their numbers."""
        self._finished = session.clock.now()
        self._held_at = -inf
        """When the machine was last seen to hold the line, for it was full."""

    @property
    def busy_until(self) -> float:
        """As its proofs say, or since it held the line."""
        return max(super().busy_until, self._held_at)

    @property
    def ahead(self) -> float:
        """Motion that may still be under way."""
        if self.answers:
            return super().ahead
        return max(0.0, self._finished - self.session.clock.now())

    def wait_for(self, number: int) -> None:
        """Return when the machine is believed to have room, and nothing lies in this computer."""
        session = self.session
        while not self._fits(number):
            now = session.clock.now()
            ends = self._ends[0][0] if self._ends else now
            waits = now + NAP if self.witness.waits else ends
            session.rest_until(min(waits, ends) if ends > now else waits)
            self._settle()
        self._settle()
        self._wait_until_sent()
        self.guard(number)

    def guard(self, number: int) -> None:
        """Wait until the machine lets the next unit come."""

    def written(self, number: int) -> None:
        """Work out when it will have been executed."""
        part = self.sums.parts[number]
        start = max(self.session.line_free, self._finished)
        self._finished = start + part.seconds * self._factor
        self._ends.append((self._finished, number))
        super().written(number)

    def drain(self) -> None:
        """Wait until the model says all is done, where the machine will not say it."""
        self._wait_until_sent(0)
        self.losses.settle()
        if not self.answers:
            self.session.rest_until(self._finished)

    def _settle(self) -> None:
        self.witness.hear()
        self.witness.overdue()
        self.losses.look()
        now = self.session.clock.now()
        while self._ends and self._ends[0][0] <= now:
            self._believed += [end for end in (self._ends.popleft(),) if self._asks(end[1])]

    def _asks(self, number: int) -> bool:
        return self.sums.parts[number].asks

    def _fits(self, number: int) -> bool:
        done = max(self._ends[0][1] if self._ends else self.sent, self.witness.executed)
        in_buffer = self.sums.bytes[number + 1] - self.sums.bytes[done]
        if not (self._guarded or in_buffer <= self._room or done == number):
            return False
        return self.sums.may_follow(self.witness.executed if self._is_late else done, number)

    @property
    def _is_late(self) -> bool:
        """Whether the machine is behind the model: then only proofs count."""
        while self._believed and self._believed[0][1] < self.witness.executed:
            self._believed.popleft()
        return bool(self._believed) and self.session.clock.now() > self._believed[0][0] + _LATE

    def _wait_until_sent(self, most: int | None = None) -> None:
        """Keep at most one unit in this computer, where XOFF could hold it unseen."""
        session = self.session
        room = session.machine.dialect.max_instruction if most is None else most
        deadline = session.clock.now() + PATIENCE + SLACK * max(self.ahead, IN_FLIGHT)
        if self._guarded:
            while (session.unsent() or 0) > room:
                self._held_at = session.clock.now()
                if session.clock.now() >= deadline:
                    raise NoAnswer(
                        f"The plotter has held the line since instruction {self.sent} of "
                        f"{len(self.sums.parts)}; it may be paused or out of order."
                    )
                session.rest_until(session.clock.now() + session.byte_time * max(8, room / 8))
        else:
            session.settle()
