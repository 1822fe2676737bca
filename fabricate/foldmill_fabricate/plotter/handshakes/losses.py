"""ESC.E after proofs: strokes are certain only when no byte before their proof was lost.

``OA;OE;`` proves where a stroke ends. A whole instruction lost inside it leaves the same end, and
only the machine's register of I/O errors tells of it: 15 for a byte that came in broken, 16 for one
that found no room.
"""

from __future__ import annotations

from foldmill_fabricate.plotter.errors import LineDisturbed, NoAnswer
from foldmill_fabricate.plotter.handshakes.hp import MET, HpSession
from foldmill_fabricate.plotter.session import PATIENCE, SILENCE
from foldmill_fabricate.plotter.witness import Witness

_MET = 0.3
"""s after which a question that met another answer is known to be dropped."""


class Losses:
    """Asks between the proofs of a delivery that is not fed by questions of its own."""

    def __init__(self, session: HpSession, witness: Witness) -> None:
        self._session, self._witness = session, witness
        self._clean = 0
        self._proved: int | None = None
        """Units proved when the open question was asked; None for no open question."""
        self._asked = 0.0
        self._places = 0

    @property
    def certain(self) -> int:
        """Units that are proved, and before whose proof no byte was lost as far as is told."""
        return self._clean if self._session.reports else self._witness.executed

    def look(self) -> None:
        """Hear an answer that has come, or ask where something was proved; raises LineDisturbed."""
        session = self._session
        if not session.reports:
            return
        if self._proved is not None:
            self._hear(session.answer_at_hand())
        if self._proved is None and self._witness.executed > self._clean:
            self._ask()

    def settle(self) -> None:
        """Wait for an open question's answer, so that the next one is not mistaken for it."""
        session = self._session
        limit = session.clock.now() + PATIENCE
        while self._proved is not None and session.clock.now() < limit:
            session.wait_a_byte()
            self._hear(session.answer_at_hand())
        self._proved = None

    def told(self) -> str | None:
        """Ask now, and return what was lost, a sentence; "" for nothing, None for silence."""
        if not self._session.reports:
            return ""
        self.settle()
        error = self._session.io_error()
        return None if error is None else lost(error)

    def _ask(self) -> None:
        session = self._session
        if session.hearing or session.proving:
            return  # two answers at once are an error
        if (stray := session.answer_at_hand()) is not None:
            raise LineDisturbed(_disturbed(stray))
        session.ask_error()
        self._proved, self._places = self._witness.executed, session.places
        self._asked = session.line_free

    def _hear(self, answer: str | None) -> None:
        if answer is None:
            self._wait_on()
            return
        if not answer.isdigit():
            raise LineDisturbed(_disturbed(answer))
        told = lost(0 if int(answer) == MET else int(answer))
        if told:
            raise LineDisturbed(told)
        assert self._proved is not None
        self._clean, self._proved = self._proved, None

    def _wait_on(self) -> None:
        """Ask again later what met another answer; raise NoAnswer for silence."""
        session = self._session
        now = session.clock.now()
        if session.unsent():
            self._asked = now  # held by XOFF or a line, it has not even left
        elif session.places > self._places and now > self._asked + _MET:
            self._proved = None
        elif now > self._asked + SILENCE:
            raise NoAnswer("The plotter has stopped answering; the cable, or the machine itself.")


def lost(error: int) -> str:
    """Say what an I/O error means; "" for none."""
    if not error:
        return ""
    return (
        f"The machine reports that bytes were lost or garbled on the line (error {error}). Check "
        "the cable and the baud rate."
    )


def _disturbed(answer: str) -> str:
    return (
        f"The plotter said {answer!r}, which was not asked for. Something disturbs the line; check "
        "the cable and the baud rate."
    )
