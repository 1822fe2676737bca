"""ESC.B: ask for the free bytes, early enough that the answer is there before it is needed.

What is known is a lower bound: the last answer less all that was written since its question was
written. One question at a time. ESC.E stands in for ESC.B once after each proof: strokes are
certain only when no byte before their proof was lost or garbled on the line. What is answered late
is told from what was dropped by the kind of the next question (``questions``).
"""

from __future__ import annotations

from bisect import bisect_right
from math import ceil, inf

from foldmill_fabricate.plotter.errors import LineDisturbed, NoAnswer, PlotterError
from foldmill_fabricate.plotter.handshakes.feed import IN_FLIGHT, SLACK
from foldmill_fabricate.plotter.handshakes.hp import LEVER_UP, MET, PAUSED, HpSession
from foldmill_fabricate.plotter.handshakes.losses import disturbed, lost
from foldmill_fabricate.plotter.handshakes.proving import Proving
from foldmill_fabricate.plotter.handshakes.questions import Question, Questions
from foldmill_fabricate.plotter.languages import reserve
from foldmill_fabricate.plotter.program import Job
from foldmill_fabricate.plotter.session import PATIENCE, SILENCE
from foldmill_fabricate.plotter.witness import QUESTION

LENT = 32
"""Bytes of the reserve, a quarter of it at most, that may be used while an answer travels: by the
time they arrive the machine has taken as many out. Besides, as many as it has taken by the model
since the answer, another quarter at most. Should it not, half the reserve is still free."""
_MOST_COLLISIONS = 20
_LONGEST_NAP = 0.25
"""s between two questions while nothing fits."""
_SHORTEST_NAP = 0.02
"""s between two of them while motion is waited for that takes longer than modelled."""
_FRESH = 0.3
"""s for which the model is believed after an answer: an answer's way is longer than the line ought
to wait, and three seconds in flight are counted by the model anyway."""
_OFTEN = 0.4
"""s between two questions while all fits: so that silence is noticed."""
_NAP = 0.02
"""Share of the time without a change that is waited before the next question."""
_LATE = 0.8
"""s that a proof waits for a good moment for ESC.E."""


class Asked(Proving):
    """The machine is asked how many bytes are free."""

    def __init__(self, session: HpSession, job: Job) -> None:
        super().__init__(session, job)
        self._reserve = reserve(session.buffer)
        self._kept = self._reserve - min(LENT, self._reserve // 4)
        self._cover = ceil(1.5 * session.round_trip / session.byte_time)
        """Bytes that keep the line busy while an answer comes."""
        self._free, self._free_at = session.buffer, 0
        """The last answer, and how many units were written before its question."""
        self._done = 0
        """Units that had left the buffer then."""
        self._questions = Questions()
        self._clean = 0
        """Units proved that ESC.E has made certain."""
        self._places = self._collisions = 0
        """Positions heard before the open question; questions in a row that met one."""
        self._progress = self._changed = self._asked_when = session.clock.now()
        """When a unit was last seen to leave the buffer; when an answer last differed."""
        self._left_at = self._seen_at = session.clock.now()
        """When the last of them left it, by the model, and when it was asked for before."""
        self._cleaned = session.clock.now()
        """When ESC.E was answered last."""
        self._due = session.clock.now()
        """When silence is silence."""

    @property
    def ahead(self) -> float:
        """Motion that may still be under way, the one that has left the buffer included."""
        return self.sums.in_flight(max(0, self._done - 1), self.sent)

    @property
    def acked(self) -> int:
        """Strokes that are proved, and before which no byte was lost."""
        return self.witness.strokes_before(self._clean)

    @property
    def busy_until(self) -> float:
        """As its proofs say, or as long as what it had not begun at the last answer takes."""
        held = self._seen_at + self.sums.in_flight(min(self._done + 1, self.sent), self.sent)
        return max(super().busy_until, held if self._free < self.session.buffer else -inf)

    def wait_for(self, number: int) -> None:
        """Return when it fits; asks at once when it does not."""
        self.session.settle()
        self._look()
        while not self._fits(number):
            self._rest(number)
            if self._fits(number):
                break
            self._ask()
            self._wait()
            if not self._fits(number) and self._unclean and self._is_late:
                self._ask(of_error=True)
                self._wait()
            self._nap(number)
        if self._questions.awaited:
            return
        if self._questions.doubtful:
            self._ask()
            return
        waited = self.session.clock.now() - self._asked_when
        following = self._following(number)
        if self._unclean and (following > 3 * self._cover or waited > _OFTEN or self._is_late):
            self._ask(of_error=True)
        elif waited > _OFTEN or (following < self._cover and not self._unripe(number + 1)):
            self._ask()  # what follows on the line covers the time until the answer

    def idle(self) -> None:
        """Ask now and then."""
        self._ask(of_error=self._unclean)
        self._wait()
        self.session.rest_until(self.session.clock.now() + _LONGEST_NAP)
        self.witness.hear()
        self._progress = self.session.clock.now()

    def drain(self) -> None:
        """Wait for an answer that is still open, so that the next one is not mistaken for it."""
        while self._questions.open or self._bound < len(QUESTION) + self._kept:
            self._ask()
            self._wait()

    @property
    def _unclean(self) -> bool:
        return self.witness.executed > self._clean

    @property
    def _is_late(self) -> bool:
        """Whether what is proved has waited long for ESC.E."""
        return self.session.clock.now() - self._cleaned > _LATE

    @property
    def _bound(self) -> int:
        """Bytes that are free at least."""
        sums = self.sums
        return self._free - (sums.bytes[self.sent] - sums.bytes[self._free_at])

    @property
    def _gone(self) -> int:
        """Bytes of the program that had left the buffer by the last answer."""
        return max(0, self.sums.bytes[self._free_at] - (self.session.buffer - self._free))

    @property
    def _taken(self) -> int:
        """Bytes that have left it since by the model, a quarter of the reserve at most."""
        since = min(self.session.clock.now() - self._seen_at, _FRESH)
        gone = self._gone
        by_now = self.sums.byte_at(self.sums.at_byte(gone) + since)
        return min(by_now - gone, self._reserve // 4)

    def _fits(self, number: int) -> bool:
        length = len(self.sums.parts[number].data)
        if length + self._kept > self._bound + self._taken:
            return False
        return self.sums.may_follow(self._done, number) or self._is_ripe(number)

    def _following(self, number: int) -> int:
        """Return the bytes that could follow unit ``number`` without another answer."""
        sums = self.sums
        room = self._bound - self._reserve + sums.bytes[self.sent]
        last = bisect_right(sums.bytes, room) - 1
        if last >= len(sums.parts):
            return self._cover  # all the rest fits
        last = max(min(last, sums.reach(self._done)), number + 1)
        while last > number + 1 and not sums.may_follow(self._done, last - 1):
            last -= 1
        return max(0, sums.bytes[last] - sums.bytes[number + 1])

    def _ask(self, of_error: bool = False) -> None:
        questions, session = self._questions, self.session
        if questions.awaited:
            return
        if questions.doubtful:
            of_error = not questions.doubtful.of_error
        elif (stray := session.answer_at_hand()) is not None:
            raise LineDisturbed(disturbed(stray))
        limit = session.clock.now() + SILENCE / 2  # half an answer may be the last there is
        while (session.hearing or session.proving) and session.clock.now() < limit:
            session.wait_a_byte(limit)  # two answers at once are an error
        session.ask_error() if of_error else session.ask_free()
        now = self._asked_when = session.clock.now()
        proved = self.witness.executed
        questions.ask(Question(of_error, self.sent, proved, self._bound, now))
        self._due = session.line_free + SILENCE
        self._places = session.places

    def _look(self) -> None:
        """Hear an answer that has come; raise NoAnswer where none will."""
        if not self._questions.open:
            return
        self._hear(self.session.answer_at_hand())
        if self._questions.awaited and self.session.clock.now() > self._due:
            self._missed()

    def _wait(self) -> None:
        """Wait for the open question's answer, and learn from it."""
        questions = self._questions
        if questions.awaited is None:
            return
        least = 0 if questions.awaited.of_error else max(0, self._bound)
        answer = self.session.answer(self._soon, least)
        if answer is None and self.session.places > self._places and questions.tells_soon:
            self._missed()
            return
        answer = answer or self.session.answer(self._due)
        if answer is None:
            self._missed()
            return
        self._hear(answer)
        self.witness.hear()
        self._check_progress()

    @property
    def _soon(self) -> float:
        """By when an answer is there that nothing has met."""
        session = self.session
        return self._due - SILENCE + 3 * session.round_trip + 24 * session.byte_time

    def _missed(self) -> None:
        """Ask again if the question met the answer to OA: it may have been dropped for it."""
        self._questions.doubt()
        if self.session.places <= self._places:
            raise NoAnswer(
                f"The plotter has stopped answering after instruction {self.sent} of "
                f"{len(self.sums.parts)}; the cable, or the machine itself."
            )
        self._collisions += 1
        if self._collisions > _MOST_COLLISIONS:
            raise NoAnswer(
                "The plotter tells its position, but not its free bytes: it does not know ESC.B. "
                'Use a profile with the handshake "xon-xoff" or "none".'
            )

    def _hear(self, answer: str | None) -> None:
        if answer is None:
            return
        if not answer.isdigit():
            raise NoAnswer(
                f"The plotter answered {answer!r} where it should have told its free bytes. "
                "Something disturbs the line; check the cable and the baud rate."
            )
        self._collisions, question = 0, self._questions.answered(int(answer))
        if question is None:
            raise LineDisturbed(disturbed(answer))
        if question.of_error:
            self._judge(int(answer), question)
        else:
            self._learn(answer, question)

    def _learn(self, answer: str, question: Question) -> None:
        """Take what the machine says is free."""
        if self._free_at != question.sent or str(self._free) != answer:
            self._changed = self.session.clock.now()
        self._free, self._free_at = min(int(answer), self.session.buffer), question.sent
        gone = self.sums.bytes[self._free_at] - (self.session.buffer - self._free)
        done = max(self._done, bisect_right(self.sums.bytes, gone) - 1)
        if done > self._done or self._done == self.sent:
            self._progress = self.session.clock.now()
        if done > self._done:
            self._left_at = self._when_left(done)
        self._done, self._seen_at = done, question.when

    def _when_left(self, done: int) -> float:
        """Return when so many units had left the buffer: as modelled, within what was seen."""
        modelled = self._left_at + self.sums.in_flight(self._done, done)
        return min(max(modelled, self._seen_at), self.session.clock.now())

    def _judge(self, error: int, question: Question) -> None:
        """Take what was proved before ESC.E for certain, or stop where bytes were lost."""
        told = lost(0 if error == MET else error)
        if told:
            raise LineDisturbed(told)
        self._clean, self._cleaned = question.proved, self.session.clock.now()

    def _check_progress(self) -> None:
        clock = self.session.clock
        if clock.now() < self._progress + PATIENCE + SLACK * self.ahead:
            return
        status = self.session.status()
        if status & LEVER_UP:
            raise PlotterError(
                "The lever of the pinch wheels is up, and the sheet may have moved. Lower it, and "
                "look at the sheet before anything is cut again."
            )
        if status & PAUSED:
            self._progress = clock.now()  # a person's doing; waiting costs nothing
            return
        raise NoAnswer(
            f"The plotter answers, but has not got beyond instruction {self._done} of "
            f"{len(self.sums.parts)} in the time that takes: it stands still, or is far slower "
            f"than its profile says. Its own display may say why."
        )

    def _rest(self, number: int) -> None:
        """Wait until motion that is in flight will have been executed, by the model."""
        if self._questions.awaited or not self._is_held_back(number):
            return
        now = self.session.clock.now()
        self.session.rest_until(min(self._ripe(number), now + _LONGEST_NAP))

    def _nap(self, number: int) -> None:
        """Do not ask a hundred times a second while a long motion, or a person, is waited for."""
        if self._fits(number):
            return
        now = self.session.clock.now()
        nap = _NAP * (now - self._changed)
        if self._is_held_back(number):
            if self._ripe(number) > now:
                return
            excess = self.sums.in_flight(self._done, number + 1) - IN_FLIGHT
            nap = max(_SHORTEST_NAP, excess / 2)  # it is slower than the model
        else:
            nap = max(nap, self._seen_at + self._until_free(number) - now)
        self.session.rest_until(now + min(_LONGEST_NAP, nap))

    def _is_ripe(self, number: int) -> bool:
        """Whether unit ``number`` may follow by the model, which a fresh answer bears out."""
        now = self.session.clock.now()
        return self._ripe(number) <= now < self._seen_at + _FRESH

    def _until_free(self, number: int) -> float:
        """Return how long after the last answer it is to be asked if unit ``number`` finds room.

        That is when the model says so, where it may be believed; else after half of that motion.
        """
        gone = self._gone
        missing = len(self.sums.parts[number].data) + self._kept - self._bound
        motion = self.sums.at_byte(gone + missing) - self.sums.at_byte(gone)
        return motion if missing <= self._reserve // 4 else motion / 2

    def _unripe(self, number: int) -> bool:
        """Whether a question now would be answered before unit ``number`` may follow."""
        if number >= len(self.sums.parts) or not self._is_held_back(number):
            return False
        return self._ripe(number) > self.session.clock.now() + self.session.round_trip

    def _is_held_back(self, number: int) -> bool:
        """Whether unit ``number`` waits for motion, not for bytes."""
        return len(self.sums.parts[number].data) + self._reserve <= self._bound

    def _ripe(self, number: int) -> float:
        """Return when enough motion will have been executed for unit ``number``, by the model.

        What was under way when it was last asked is taken for done by then at the earliest.
        """
        sums, done = self.sums, self._done
        under_way = sums.in_flight(done, min(done + 1, len(sums.parts)))
        began = max(self._left_at, self._seen_at - under_way)
        return began + sums.in_flight(done, sums.makes_way(number))
