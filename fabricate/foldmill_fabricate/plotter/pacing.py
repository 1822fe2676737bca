"""How fast a machine is fed: by what it says of its buffer, or by how long its motions take.

In flight, that is sent and not known to be executed, is at most the buffer less its reserve, and at
most three seconds of motion or one stroke, whichever is longer: so that stopping means something.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from itertools import accumulate
from math import ceil
from typing import Protocol

from foldmill_fabricate.plotter.errors import NoAnswer
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import PATIENCE, Session, reserve

IN_FLIGHT = 3.0
"""s of motion."""
SLACK = 3.0
"""How many times longer than modelled a machine may take before it is given up."""
CAUTION = 1.25
"""How many times longer than modelled a machine is taken to need where it cannot say."""
LENT = 16
"""Bytes of the reserve, a quarter of it at most, that may be used while an answer travels: by the
time they arrive the machine has taken as many out. Should it not, three quarters are still free."""
_MOST_COLLISIONS = 20
_LONGEST_NAP = 0.25
"""s between two questions."""
_NAP = 0.02
"""Share of the time without a change that is waited before the next question."""


class Pace(Protocol):
    """Decides when the next instruction may go."""

    def wait_for(self, number: int) -> None:
        """Return when instruction ``number`` may be written; raises NoAnswer."""
        ...

    def written(self, number: int) -> None:
        """Learn that it was."""
        ...

    def finish(self) -> None:
        """Return when no question of one's own is open and all is believed to be executed."""
        ...

    @property
    def ahead(self) -> float:
        """Motion that may still be under way, s."""
        ...


def pace(session: Session, job: Job) -> Pace:
    """Choose the pace that the machine's handshake allows."""
    return Asked(session, job) if session.controls else Modelled(session, job)


class Sums:
    """Sums over the instructions of a job: bytes and seconds before each."""

    def __init__(self, job: Job) -> None:
        self.parts = job.parts
        self.bytes = [0, *accumulate(len(part.data) for part in job.parts)]
        self.seconds = [0.0, *accumulate(part.seconds for part in job.parts)]

    def in_flight(self, done: int, sent: int) -> float:
        """Return the motion of instructions ``done`` … ``sent`` - 1, s."""
        return self.seconds[sent] - self.seconds[done]

    def may_follow(self, done: int, number: int) -> bool:
        """Whether the next instruction keeps what is in flight short, or within one stroke."""
        if done >= number or self.in_flight(done, number + 1) <= IN_FLIGHT:
            return True
        return self.parts[done].stroke == self.parts[number].stroke

    def reach(self, done: int) -> int:
        """Return a number up to which instructions may follow at most; little above the truth.

        A large buffer holds thousands that may not, and looking at each takes longer than cutting.
        """
        short = bisect_right(self.seconds, self.seconds[done] + IN_FLIGHT) + 1
        stroke, last = self.parts[done].stroke, max(done, short)
        while last < len(self.parts) and self.parts[last].stroke == stroke:
            last += 1
        return last + 1


class Asked:
    """ESC.B: ask for the free bytes, early enough that the answer is there before it is needed.

    What is known is a lower bound: the last answer less all that was written since its question was
    written. One question at a time.
    """

    def __init__(self, session: Session, job: Job) -> None:
        self._session, self._sums = session, Sums(job)
        self._reserve = reserve(session.buffer)
        self._kept = self._reserve - min(LENT, self._reserve // 4)
        self._cover = ceil(1.5 * session.round_trip / session.byte_time)
        """Bytes that keep the line busy while an answer comes."""
        self._sent = 0
        """Instructions written."""
        self._free, self._free_at = session.buffer, 0
        """The last answer, and how many instructions were written before its question."""
        self._done = 0
        """Instructions that had left the buffer then."""
        self._asked: int | None = None
        """Instructions written before the open question."""
        self._places = self._collisions = 0
        """Positions heard before it; questions in a row that met one."""
        self._progress = self._changed = self._asked_when = session.clock.now()
        """When an instruction was last seen to leave the buffer; when an answer last differed."""

    @property
    def ahead(self) -> float:
        """Motion that may still be under way, the one that has left the buffer included."""
        return self._sums.in_flight(max(0, self._done - 1), self._sent)

    def wait_for(self, number: int) -> None:
        """Return when it fits; asks at once when it does not."""
        self._hear(self._session.answer_at_hand() if self._asked is not None else None)
        while not self._fits(number):
            self._ask()
            self._wait()
            self._nap(number)
        if self._asked is None and self._following(number) < self._cover:
            self._ask()  # what follows on the line covers the time until the answer

    def written(self, number: int) -> None:
        """Count it as in the buffer."""
        self._sent = number + 1

    def finish(self) -> None:
        """Wait for an answer that is still open, so that the next one is not mistaken for it."""
        if self._asked is not None:
            self._wait()

    @property
    def _bound(self) -> int:
        """Bytes that are free at least."""
        sums = self._sums
        return self._free - (sums.bytes[self._sent] - sums.bytes[self._free_at])

    def _fits(self, number: int) -> bool:
        length = len(self._sums.parts[number].data)
        return length + self._kept <= self._bound and self._sums.may_follow(self._done, number)

    def _following(self, number: int) -> int:
        """Return the bytes that could follow instruction ``number`` without another answer."""
        sums = self._sums
        room = self._bound - self._reserve + sums.bytes[self._sent]
        last = bisect_right(sums.bytes, room) - 1
        if last >= len(sums.parts):
            return self._cover  # all the rest fits
        last = max(min(last, sums.reach(self._done)), number + 1)
        while last > number + 1 and not sums.may_follow(self._done, last - 1):
            last -= 1
        return max(0, sums.bytes[last] - sums.bytes[number + 1])

    def _ask(self) -> None:
        if self._asked is None:
            while self._session.hearing:  # two answers at once are an error of the machine
                self._session.clock.sleep(self._session.byte_time)
            self._session.ask_free()
            self._asked, self._asked_when = self._sent, self._session.clock.now()
            self._places = self._session.places

    def _wait(self) -> None:
        answer = self._session.answer(self._soon(self._asked_when))
        if answer is None and self._session.places > self._places:
            self._collided()
            return
        on_line = self._session.buffer * self._session.byte_time
        answer = answer or self._session.answer(self._asked_when + on_line + PATIENCE)
        if answer is None:
            raise NoAnswer(
                f"The plotter has stopped answering after instruction {self._sent} of "
                f"{len(self._sums.parts)}; the cable, or the machine itself."
            )
        self._hear(answer)
        self._check_progress()

    def _soon(self, asked: float) -> float:
        """Return by when an answer is there that nothing has met: what is queued goes first."""
        session = self._session
        queued = session.unsent()
        queued = (
            session.buffer if queued is None else queued + session.machine.dialect.max_instruction
        )
        return asked + min(queued, session.buffer) * session.byte_time + 4 * session.round_trip

    def _collided(self) -> None:
        """Ask again: the question met the answer to OA, and was dropped for it."""
        self._asked = None
        self._collisions += 1
        if self._collisions > _MOST_COLLISIONS:
            raise NoAnswer(
                "The plotter tells its position, but not its free bytes: it does not know ESC.B. "
                'Use a profile with the handshake "xon-xoff" or "none".'
            )
        if self._session.io_error(self._soon(self._session.clock.now())):
            raise NoAnswer(
                "The machine reports that bytes were lost or garbled on the line. Check the cable "
                "and the baud rate."
            )

    def _hear(self, answer: str | None) -> None:
        if answer is None or self._asked is None:
            return
        if not answer.isdigit():
            raise NoAnswer(
                f"The plotter answered {answer!r} where it should have told its free bytes. "
                "Something disturbs the line; check the cable and the baud rate."
            )
        if self._free_at != self._asked or str(self._free) != answer:
            self._changed = self._session.clock.now()
        self._collisions = 0
        self._free, self._free_at = min(int(answer), self._session.buffer), self._asked
        self._asked = None
        gone = self._sums.bytes[self._free_at] - (self._session.buffer - self._free)
        done = max(self._done, bisect_right(self._sums.bytes, gone) - 1)
        if done > self._done or self._done == self._sent:
            self._progress = self._session.clock.now()
        self._done = done

    def _check_progress(self) -> None:
        clock = self._session.clock
        if clock.now() < self._progress + PATIENCE + SLACK * self.ahead:
            return
        if self._session.paused():
            self._progress = clock.now()  # a person's doing; waiting costs nothing
            return
        raise NoAnswer(
            f"The plotter answers, but has not got beyond instruction {self._done} of "
            f"{len(self._sums.parts)} in the time that takes: it stands still, or is far slower "
            f"than its profile says. Its own display may say why."
        )

    def _nap(self, number: int) -> None:
        """Do not ask a hundred times a second while a long motion, or a person, is waited for."""
        if self._fits(number):
            return
        clock, length = self._session.clock, len(self._sums.parts[number].data)
        nap = _NAP * (clock.now() - self._changed)
        if length + self._reserve <= self._bound:
            nap = (self._sums.in_flight(self._done, number + 1) - IN_FLIGHT) / 2
        clock.sleep(min(_LONGEST_NAP, nap))


class Modelled:
    """No answers while it runs: the motion model says what the machine has executed by now.

    With XON/XOFF the machine guards its buffer itself; without, the model must, and is taken with
    caution.
    """

    def __init__(self, session: Session, job: Job) -> None:
        self._session, self._sums = session, Sums(job)
        self._guarded = session.machine.serial.handshake == "xon-xoff"
        self._factor = 1.0 if self._guarded else CAUTION
        self._room = session.buffer - reserve(session.buffer)
        self._sent = 0
        self._ends: deque[tuple[float, int]] = deque()
        """When each instruction in flight is believed to be executed, s, and its number."""
        self._line_free = self._finished = session.clock.now()

    @property
    def ahead(self) -> float:
        """Motion that may still be under way."""
        return max(0.0, self._finished - self._session.clock.now())

    def wait_for(self, number: int) -> None:
        """Return when the machine is believed to have room, and nothing lies in this computer."""
        while self._ends and not self._fits(number):
            self._session.clock.sleep_until(self._ends[0][0])
            self._settle()
        self._settle()
        self._wait_until_sent()

    def written(self, number: int) -> None:
        """Work out when it will have arrived and been executed."""
        part = self._sums.parts[number]
        start = max(self._line_free, self._session.clock.now())
        self._line_free = start + len(part.data) * self._session.byte_time
        self._finished = max(self._line_free, self._finished) + part.seconds * self._factor
        self._ends.append((self._finished, number))
        self._sent = number + 1

    def finish(self) -> None:
        """Wait until the model says all is done."""
        self._session.clock.sleep_until(self._finished)

    def _settle(self) -> None:
        now = self._session.clock.now()
        while self._ends and self._ends[0][0] <= now:
            self._ends.popleft()

    def _fits(self, number: int) -> bool:
        done = self._ends[0][1]
        in_buffer = self._sums.bytes[number + 1] - self._sums.bytes[done]
        room = self._guarded or in_buffer <= self._room
        return room and self._sums.may_follow(done, number)

    def _wait_until_sent(self) -> None:
        """Keep at most one instruction in this computer, where XOFF could hold it unseen."""
        session = self._session
        most = session.machine.dialect.max_instruction
        deadline = session.clock.now() + PATIENCE + SLACK * max(self.ahead, IN_FLIGHT)
        while (session.unsent() or 0) > most:
            if session.clock.now() >= deadline:
                raise NoAnswer(
                    f"The plotter has held the line since instruction {self._sent} of "
                    f"{len(self._sums.parts)}; it may be paused or out of order."
                )
            session.clock.sleep(session.byte_time * most / 8)
