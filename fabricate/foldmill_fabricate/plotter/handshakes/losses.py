"""ESC.E after proofs: strokes are certain only when no byte before their proof was lost.

``OA;OE;`` proves where a stroke ends. A whole instruction lost inside it leaves the same end, and
only the machine's register of I/O errors tells of it: 15 for a byte that came in broken, 16 for one
that found no room.

An ESC.E that met another answer was dropped, or its answer is late. The next one's answer tells:
10 that one was dropped, and anything else that it is the first one's.
"""

from __future__ import annotations

from collections import deque

from foldmill_fabricate.plotter.errors import LineDisturbed, NoAnswer
from foldmill_fabricate.plotter.handshakes.hp import MET, HpSession
from foldmill_fabricate.plotter.session import PATIENCE, SILENCE
from foldmill_fabricate.plotter.witness import Witness


class Losses:
    """Asks between the proofs of a delivery that is not fed by questions of its own."""

    def __init__(self, session: HpSession, witness: Witness) -> None:
        self._session, self._witness = session, witness
        self._clean = 0
        self._open: deque[int] = deque()
        """Units proved when each question was asked to which an answer may still come."""
        self._asked = 0.0
        self._places = 0

    @property
    def certain(self) -> int:
        """Units that are proved, and before whose proof no byte was lost as far as is told."""
        return self._clean if self._session.reports else self._witness.executed

    def look(self) -> None:
        """Hear an answer that has come, or ask where something was proved; raises LineDisturbed."""
        if not self._session.reports:
            return
        if self._open:
            self._hear(self._session.answer_at_hand())
        if not self._open and self._witness.executed > self._clean:
            self._ask()

    def settle(self) -> None:
        """Wait for the answers that are open, so that the next one is not mistaken for them."""
        session = self._session
        limit = session.clock.now() + PATIENCE
        while self._open and session.clock.now() < limit:
            session.wait_a_byte()
            self._hear(session.answer_at_hand())

    def told(self) -> str | None:
        """Ask now, and return what was lost, a sentence; "" for nothing, None for silence."""
        if not self._session.reports:
            return ""
        self.settle()
        return self._last_word(1 + len(self._open))

    def _last_word(self, most: int) -> str | None:
        """Ask once more, and hear up to so many answers: some may be to what was asked before."""
        session, found = self._session, list[str]()
        session.ask_error()
        while len(found) < most:
            answer = session.answer(session.line_free + SILENCE)
            if answer is None or not answer.isdigit():
                break
            found.append("" if int(answer) == MET else lost(int(answer)))
        self._open.clear()
        return max(found, default=None, key=len)

    def _ask(self) -> None:
        session = self._session
        if session.hearing or session.proving:
            return  # two answers at once are an error
        if not self._open and (stray := session.answer_at_hand()) is not None:
            raise LineDisturbed(disturbed(stray))
        session.ask_error()
        self._open.append(self._witness.executed)
        self._places, self._asked = session.places, session.line_free

    def _hear(self, answer: str | None) -> None:
        if answer is None:
            self._wait_on()
            return
        if not answer.isdigit():
            raise LineDisturbed(disturbed(answer))
        error = int(answer)
        if told := lost(0 if error == MET else error):
            raise LineDisturbed(told)
        if error == MET and len(self._open) > 1:
            self._open.popleft()
        self._clean = self._open.popleft()

    def _wait_on(self) -> None:
        """Ask again later what met another answer; raise NoAnswer for silence."""
        session = self._session
        silent = session.clock.now() - self._asked
        if session.unsent():
            self._asked = session.clock.now()  # held by XOFF or a line, it has not even left
        elif len(self._open) > 1 and silent > PATIENCE:
            self._open.clear()  # both were dropped
        elif len(self._open) == 1 and silent > SILENCE:
            if session.places <= self._places:
                raise NoAnswer(
                    "The plotter has stopped answering; the cable, or the machine itself."
                )
            self._ask()


def lost(error: int) -> str:
    """Say what an I/O error means; "" for none."""
    if not error:
        return ""
    return (
        f"The machine reports that bytes were lost or garbled on the line (error {error}). Check "
        "the cable and the baud rate."
    )


def disturbed(answer: str) -> str:
    """Say that something was heard which answers nothing."""
    return (
        f"The plotter said {answer!r}, which was not asked for. Something disturbs the line; check "
        "the cable and the baud rate."
    )
