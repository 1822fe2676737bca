"""A conversation with one machine: open it, ask it, write to it, stop it.

Device control (ESC . letter) is spoken only to machines whose handshake is ESC.B; a cutter that
does not know it might take the letters for HP-GL. Never two of those questions at once:
overlapping output is an I/O error of the machine. What HP-GL asks is answered in its own time, and
told apart by its commas.
"""

from __future__ import annotations

from collections import deque
from typing import Any

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.errors import NoAnswer

_FREE, _SIZE, _ERROR, _STATUS = b"\x1b.B", b"\x1b.L", b"\x1b.E", b"\x1b.O"
_FORGET_ANSWERS, _FORGET = b"\x1b.J", b"\x1b.K"
_MET = 10
"""I/O error of a question that met another answer: it was dropped, and nothing else."""
_PAUSED = 16 | 32
"""Bits of the extended status: paused by a key, or a lever up."""

PATIENCE = 5.0
"""s of silence that are believed to be silence, beyond what the line and the motion take."""
_NOISE = bytes((0x11, 0x13, 0x0A))
"""XON, XOFF and line feed among the answers."""
_SMALLEST, _LARGEST = 64, 1 << 26
"""bytes; a buffer outside is a misread answer."""

READ_SLICE = 0.1
"""s that one read waits at most; deadlines are counted by the clock."""

BY_HAND = "Stop the machine by hand: it may still be cutting what it has been given."


def reserve(buffer: int) -> int:
    """Return the bytes of a buffer that are never filled: real machines overflow before the end."""
    return min(128, buffer // 4)


def longest(buffer: int, machine: Machine) -> int:
    """Return the longest instruction that is sent at once, bytes.

    A third of what may be filled: while one is on the line and one in the buffer, a third can be
    promised, and so the line never waits for an answer.
    """
    return min(machine.dialect.max_instruction, (buffer - reserve(buffer)) // 3)


class Session:
    """The port, the clock and the machine's profile, and what has been learnt since."""

    def __init__(self, port: Any, machine: Machine, clock: Clock) -> None:
        self.port, self.machine, self.clock = port, machine, clock
        if port.timeout is None:
            port.timeout = READ_SLICE  # a read that waits for ever knows no deadline
        self.byte_time = 10 / machine.serial.baud
        self.buffer = machine.serial.buffer
        """Bytes the machine holds: as its profile says, then as it says itself."""
        self.round_trip = 0.0
        """s from a question to its answer on a line that is otherwise still; 0 for not known."""
        self.whole = True
        """Whether all that was written so far ends with a whole instruction."""
        self._heard = b""
        self._numbers: deque[str] = deque()
        self._places: deque[str] = deque()
        self.places = 0
        """Positions that were heard so far."""

    @property
    def controls(self) -> bool:
        """Whether the machine understands device control."""
        return self.machine.serial.handshake == "esc-b"

    def open(self) -> None:
        """Find the machine ready; raises NoAnswer where it should answer and does not."""
        self._forget_answers()
        if not self.controls:
            return
        self.port.write(_FORGET)
        asked = self.clock.now()
        if self.control(_ERROR, PATIENCE) is None:
            raise NoAnswer(
                f"The plotter does not answer at {self.machine.serial.baud} baud. Is it on, is the "
                "cable the right one, and does its own setting agree with the baud rate?"
            )
        self.round_trip = self.clock.now() - asked
        self.buffer = self._size()

    def write(self, data: bytes) -> None:
        """Write one whole instruction."""
        self.whole = False
        self.port.write(data)
        self.whole = True

    def ask_free(self) -> None:
        """Ask for the free bytes; ``answer`` brings them."""
        self.port.write(_FREE)

    def control(self, question: bytes, patience: float) -> int | None:
        """Ask by device control and wait; None for silence, or an answer that is no number."""
        self.port.write(question)
        text = self.answer(self.clock.now() + patience)
        return int(text) if text is not None and text.isdigit() else None

    def io_error(self, deadline: float | None = None) -> int:
        """Return the machine's I/O error; 0 for none, for silence, and for questions that met."""
        patience = PATIENCE if deadline is None else deadline - self.clock.now()
        found = self.control(_ERROR, patience) or 0
        return 0 if found == _MET else found

    def paused(self) -> bool:
        """Whether somebody has paused the machine at its own keys."""
        return bool((self.control(_STATUS, PATIENCE) or 0) & _PAUSED)

    def answer(self, deadline: float) -> str | None:
        """Return the next answer that is no position, without its CR; None for none by then."""
        return self._wait_for(self._numbers, deadline)

    def answer_at_hand(self) -> str | None:
        """Return such an answer if one has come in whole."""
        self._listen()
        return self._numbers.popleft() if self._numbers else None

    def place(self, deadline: float) -> str | None:
        """Return the next answer to OA; None where there is none by then."""
        return self._wait_for(self._places, deadline)

    def place_at_hand(self) -> str | None:
        """Return an answer to OA if one has come in whole."""
        self._listen()
        return self._places.popleft() if self._places else None

    @property
    def hearing(self) -> bool:
        """Whether an answer has begun to come in."""
        self._listen()
        return bool(self._heard)

    def _wait_for(self, answers: deque[str], deadline: float) -> str | None:
        self._listen()
        while not answers:
            if self.clock.now() >= deadline:
                return None
            self._heard += self.port.read(1)
            self._listen()
        return answers.popleft()

    def _listen(self) -> None:
        """Sort whole answers: positions are the ones with a comma."""
        ready = self.port.in_waiting
        if ready:
            self._heard += self.port.read(ready)
        while b"\r" in self._heard:
            line, _, self._heard = self._heard.partition(b"\r")
            text = line.translate(None, _NOISE).decode("ascii", "replace").strip()
            is_place = "," in text
            self.places += is_place
            (self._places if is_place else self._numbers).append(text)
        self._heard = self._heard.lstrip(_NOISE)

    def _forget_answers(self) -> None:
        self.port.reset_input_buffer()
        self._heard = b""
        self._numbers.clear()
        self._places.clear()

    def unsent(self) -> int | None:
        """Return the bytes still in this computer; None where the port cannot tell."""
        try:
            return int(self.port.out_waiting)
        except (AttributeError, OSError):
            return None

    def stop(self) -> str:
        """Stop the machine as far as its profile allows, and say what that means.

        It discards what has not left, lifts XOFF, and lifts the tool. It never moves in x and y and
        never sends IN.
        """
        try:
            unsent = self.unsent()
            self.port.reset_output_buffer()
            self._lift_xoff()
            if self.controls:
                self.port.write(_FORGET + b"PU;")
                return "The machine was told to drop what it has and to lift its tool."
            if self.whole and unsent == 0:
                self.port.write(b"PU;")
            return BY_HAND
        except Exception:  # termios has an error of its own; whatever it is, a person must act
            return BY_HAND

    def _size(self) -> int:
        found = self.control(_SIZE, PATIENCE)
        if found is None:  # some machines tell it only when they are at rest
            self.port.write(_FORGET_ANSWERS)
            self.clock.sleep(self.round_trip)
            self._forget_answers()
        return found if found and _SMALLEST <= found <= _LARGEST else self.buffer

    def _lift_xoff(self) -> None:
        if hasattr(self.port, "set_output_flow_control"):
            self.port.set_output_flow_control(True)
