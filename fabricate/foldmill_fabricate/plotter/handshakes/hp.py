"""A conversation with an HP-GL machine.

Device control (ESC . letter) is spoken only to machines whose handshake is ESC.B or ENQ/ACK; a
cutter that does not know it might take the letters for HP-GL. Never two of those questions at once:
overlapping output is an I/O error of the machine. What HP-GL asks is answered in its own time:
``OA;OE;`` by a place, told by its comma, and the error right behind it.
"""

from __future__ import annotations

from collections import deque

from foldmill_fabricate.plotter.errors import NoAnswer
from foldmill_fabricate.plotter.handshakes.questions import LAST_ERROR
from foldmill_fabricate.plotter.session import SILENCE, Session

FREE, _SIZE, _ERROR, _STATUS = b"\x1b.B", b"\x1b.L", b"\x1b.E", b"\x1b.O"
_FORGET_ANSWERS, _FORGET = b"\x1b.J", b"\x1b.K"
MET = 10
"""I/O error of a question that met another answer: it was dropped, and nothing else."""
DROPS = frozenset({"esc-b", "enq-ack"})
"""Handshakes of machines that drop what they hold, half an instruction too, at ESC.K."""
PAUSED, LEVER_UP = 16, 32
"""Bits of the extended status: paused by a key; the pinch wheels off the sheet."""
_NOISE = bytes((0x11, 0x13, 0x0A))
"""XON, XOFF and line feed among the answers."""
_ENQ, _ACK = b"\x05", b"\x06"
_SMALLEST, _LARGEST = 64, 1 << 26
"""bytes; a buffer outside is a misread answer."""
_WELCOME = 2.0
"""s that a machine may take for its first answer."""


class HpSession(Session):
    """What an HP-GL machine is asked, and what it answers."""

    round_trip = 0.0
    """s from a question to its answer on a line that is otherwise still; 0 for not known."""
    places = 0
    """Positions that were heard so far."""
    acks = 0
    """ACK characters that were heard so far."""

    def open(self) -> None:
        """Drop what the machine holds and find its buffer's size, where it understands that."""
        self._numbers: deque[str] = deque()
        self._proofs: deque[tuple[str, str]] = deque()
        self._place: str | None = None
        self.forget_answers()
        if self.discards:
            self.send(_FORGET)
        if self.controls:
            self._meet()

    @property
    def controls(self) -> bool:
        """Whether the machine is asked by device control."""
        return self.machine.serial.handshake == "esc-b"

    @property
    def discards(self) -> bool:
        """Whether the machine drops what it holds at ESC.K."""
        return self.machine.serial.handshake in DROPS

    @property
    def reports(self) -> bool:
        """Whether the machine is asked by ESC.E if bytes were lost."""
        serial = self.machine.serial
        return serial.answers and (self.discards or serial.reports_losses)

    def _meet(self) -> None:
        """Ask twice, for numbers that cannot be mistaken for each other.

        Who was here before may have been killed with a question open. Its answer is heard before
        these, and is of another kind than the first or the second; so is where the tool was then.
        """
        asked = self.clock.now()
        found = self.control(_ERROR, _WELCOME, most=LAST_ERROR)
        if found is None and self._proofs:  # it was taken for an OE that was dropped
            found = self.control(_ERROR, _WELCOME, most=LAST_ERROR)
        if found is None:
            raise NoAnswer(
                f"The plotter does not answer at {self.machine.serial.baud} baud. Is it on, is the "
                "cable the right one, and does its own setting agree with the baud rate?"
            )
        self.round_trip = self.clock.now() - asked
        self.buffer = self._size()
        self._proofs.clear()
        self._place = None

    def ask_free(self) -> None:
        """Ask for the free bytes; ``answer`` brings them."""
        self.send(FREE)

    def ask_error(self) -> None:
        """Ask for the I/O error; ``answer`` brings it."""
        self.send(_ERROR)

    def enquire(self) -> None:
        """Ask whether a block fits; ``acks`` counts the answers."""
        self.send(_ENQ)

    def control(
        self, question: bytes, patience: float = SILENCE, *, least: int = 0, most: int = _LARGEST
    ) -> int | None:
        """Ask by device control and wait; None for silence, or an answer that is no number.

        least, most : numbers beyond them answer something else that was asked before.
        """
        self.send(question)
        while (text := self.answer(self.line_free + patience)) is not None:
            if not text.isdigit():
                return None
            if least <= int(text) <= most:
                return int(text)
        return None

    def status(self) -> int:
        """Return the extended status, a sum of bits; 0 for silence."""
        return self.control(_STATUS) or 0

    def answer(self, deadline: float, least: int = 0) -> str | None:
        """Return the next answer to device control; None for none by then.

        least : the smallest number that it can be.
        """
        self.listen()
        while not self._numbers:
            if self.clock.now() >= deadline:
                return None
            self.wait_a_byte(deadline, len(str(least)) + len(self.ends))
        return self._numbers.popleft()

    def answer_at_hand(self) -> str | None:
        """Return such an answer if one has come in whole."""
        self.listen()
        return self._numbers.popleft() if self._numbers else None

    def proof(self, deadline: float) -> tuple[str, str] | None:
        """Return the next place and error of ``OA;OE;``; None where there is none by then."""
        self.listen()
        while not self._proofs:
            if self.clock.now() >= deadline:
                return None
            self.wait_a_byte(deadline)
        return self._proofs.popleft()

    def proof_at_hand(self) -> tuple[str, str] | None:
        """Return them if they have come in whole."""
        self.listen()
        return self._proofs.popleft() if self._proofs else None

    @property
    def proving(self) -> bool:
        """Whether a place was heard and its error is still to come."""
        return self._place is not None

    def _sort(self) -> None:
        self.acks += self._heard.count(_ACK)
        self._heard = self._heard.translate(None, _ACK + _NOISE)
        super()._sort()

    def take(self, line: bytes) -> None:
        """Sort an answer: behind a place stands the error of the same question."""
        text = line.decode("ascii", "replace").strip()
        if "," in text:
            self._place = text
            self.places += 1
        elif self._place is not None:
            self._proofs.append((self._place, text))
            self._place = None
        else:
            self._numbers.append(text)

    def forget_answers(self) -> None:
        """Drop what has come in."""
        super().forget_answers()
        self._numbers.clear()
        self._proofs.clear()
        self._place = None

    def abort(self, unsent: int | None) -> str:
        """Have it drop what it has and lift its tool, where it understands that."""
        if not self.discards:
            return super().abort(unsent)
        self.port.write(_FORGET + self.lift)
        return "The machine was told to drop what it has and to lift its tool."

    def _size(self) -> int:
        found = self.control(_SIZE, least=_SMALLEST)
        if found is None:  # some machines tell it only when they are at rest
            self.send(_FORGET_ANSWERS)
            self.clock.sleep(self.round_trip)
            self.forget_answers()
        return found or self.buffer
