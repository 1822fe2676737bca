"""The machine behind the line: buffer, device control, flow control, execution in parse order."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from math import inf

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.simulator.carriage import Carriage
from foldmill_fabricate.plotter.simulator.control import BAD_LETTER, Command, ControlChannel
from foldmill_fabricate.plotter.simulator.drawing import DrawnSheet
from foldmill_fabricate.plotter.simulator.parser import ENDS, Parser
from foldmill_fabricate.plotter.simulator.uart import Transmitter

XON, XOFF = 0x11, 0x13
OVERLAP, FRAMING, OVERFLOW = 10, 15, 16
"""I/O errors, as ESC.E answers them."""

_ANSWER_TIME = 0.002
"""s from a question's last byte to the answer's first."""
_BLOCK = 80
"""Default block size of ESC.I, bytes."""


@dataclass(frozen=True)
class Faults:
    """What is wrong with the simulated machine."""

    silent_after: int | None = None
    """It neither reads, moves nor answers once it has received that many bytes."""
    slower: float = 1.0
    """How many times longer than its profile says every motion takes."""


@dataclass
class Traffic:
    """What came in."""

    received: bytearray = field(default_factory=bytearray)
    """every byte, device control included"""
    program: bytearray = field(default_factory=bytearray)
    """HP-GL only, the dropped bytes included"""
    overruns: int = 0
    """bytes dropped because the buffer was full"""
    fullest: int = 0
    """highest occupancy of the buffer, bytes"""
    split: int = 0
    """times ESC.B came in the middle of an instruction, which real machines garble"""
    errors: Counter[int] = field(default_factory=Counter)
    """I/O errors by number"""


class Device:
    """A plotter with a byte-accurate input buffer. Times are seconds of the clock it is run by."""

    def __init__(
        self, machine: Machine, sheet: DrawnSheet, byte_time: float, speed_up: float, faults: Faults
    ) -> None:
        self.machine, self.faults, self.traffic = machine, faults, Traffic()
        self.size = machine.serial.buffer
        self.carriage = Carriage(machine, sheet)
        self.out = Transmitter(byte_time)
        self.paused = False
        self._pace = faults.slower / speed_up
        self._buffer = bytearray()
        self._parser, self._control = Parser(), ControlChannel()
        self._busy_until = -inf
        self._on = True
        self._io_error = 0
        self._size_asked = self._inside = False
        self._held = False
        self._reset_handshake()

    @property
    def free(self) -> int:
        """Bytes that the buffer still takes."""
        return self.size - len(self._buffer)

    @property
    def holds(self) -> bool:
        """Whether it has sent XOFF and no XON since."""
        return self._held

    @property
    def idle(self) -> bool:
        """Whether nothing moves."""
        return self._busy_until == -inf

    @property
    def dead(self) -> bool:
        """Whether it has gone silent."""
        limit = self.faults.silent_after
        return limit is not None and len(self.traffic.received) >= limit

    @property
    def next_event(self) -> float:
        """When something happens here by itself, s."""
        busy = self._busy_until if self._busy_until > -inf else inf
        return inf if self.dead else min(busy, self.out.next_event)

    def happen(self, now: float) -> int | None:
        """Do what is due; return a byte that has reached the host, or None."""
        sent = self.out.happen(now) if self.out.next_event <= now else None
        if -inf < self._busy_until <= now:
            self._work(now)
        return sent

    def receive(self, byte: int, now: float) -> None:
        """Take one byte off the line."""
        if self.dead:
            return
        self.traffic.received.append(byte)
        heard = self._control.feed(byte)
        if isinstance(heard, Command):
            self._obey(heard, now)
        elif heard is not None and self._on:
            self._store(heard, now)

    def garble(self) -> None:
        """Note a byte that came at another rate than the machine's."""
        self._io_fault(FRAMING)

    def resume(self, now: float) -> None:
        """Go on after a pause at the machine."""
        self.paused = False
        self._work(now)

    def _store(self, byte: int, now: float) -> None:
        self.traffic.program.append(byte)
        self._inside = byte not in b";\x03" and (self._inside or byte > 0x20)
        if not self.free:
            self.traffic.overruns += 1
            self._io_fault(OVERFLOW)
            return
        self._buffer.append(byte)
        self.traffic.fullest = max(self.traffic.fullest, len(self._buffer))
        if byte in ENDS and self._busy_until == -inf:
            self._work(now)
        self._hold(now)

    def _work(self, now: float) -> None:
        """Begin whatever can begin. A unit frees its bytes when it begins: it is decoded then."""
        if self._busy_until <= now:
            self._busy_until = -inf
        while self._busy_until == -inf and not self.paused:
            unit = self._parser.take(self._buffer)
            if unit is None:
                break
            outcome = self.carriage.execute(unit)
            if outcome.reply is not None:
                self._say(outcome.reply, now)
            if outcome.seconds > 0:
                self._busy_until = now + outcome.seconds * self._pace
        self._let_go(now)
        if self._size_asked and not self._buffer:
            self._size_asked = False
            self._say(str(self.size), now)

    @property
    def _speaking(self) -> bool:
        return bool(self.out.queue) or self.out.sending or self._size_asked

    def _say(self, text: str, now: float) -> None:
        self.out.not_before = now + _ANSWER_TIME
        self.out.put(text.encode() + b"\r", now)

    def _answer(self, text: str, now: float) -> None:
        """Answer device control; a question while an answer is under way is error 10."""
        if self._speaking:
            self._io_fault(OVERLAP)
        else:
            self._say(text, now)

    def _io_fault(self, error: int) -> None:
        self._io_error = error
        self.traffic.errors[error] += 1

    def _obey(self, command: Command, now: float) -> None:
        if command.error:
            self._io_fault(command.error)
        elif not self._on and command.letter not in "(Y":
            return
        elif command.letter in "BELO":
            self._tell(command.letter, now)
        elif command.letter == "J":
            self.out.queue.clear()
            self._size_asked = False
        elif command.letter == "K":
            self._forget(now)
        elif command.letter in "@HIMNR":
            self._agree(command)
        elif command.letter in "(Y)Z":
            self._on = command.letter in "(Y"
        else:
            self._io_fault(BAD_LETTER)

    def _tell(self, letter: str, now: float) -> None:
        if letter == "B":
            self.traffic.split += self._inside
            self._answer(str(self.free), now)
        elif letter == "E":
            self._answer(str(self._io_error), now)
            self._io_error = 0
        elif letter == "O":
            self._answer(str((0 if self._buffer else 8) + 16 * self.paused), now)
        elif self._speaking:
            self._io_fault(OVERLAP)
        elif self._buffer:
            self._size_asked = True  # answered once the buffer is empty
        else:
            self._say(str(self.size), now)

    def _forget(self, now: float) -> None:
        """ESC.K: drop what is not being executed."""
        self._buffer.clear()
        self._parser.reset()
        self._inside = False
        self._work(now)

    def _agree(self, command: Command) -> None:
        """Set a handshake from the line: XON/XOFF by ESC.I and ESC.N; the rest is taken as read."""
        values = command.parameters + (0,) * 12
        if command.letter == "R":
            self._reset_handshake()
        elif command.letter == "I" and not values[1]:
            self._xon = values[2]
            if self._xon:
                self._hold_below = values[0] or _BLOCK
        elif command.letter == "N":
            self._xoff = values[1]

    def _reset_handshake(self) -> None:
        built_in = self.machine.serial.handshake == "xon-xoff"
        self._xon, self._xoff = (XON, XOFF) if built_in else (0, 0)
        self._hold_below = min(128, self.size // 4)

    def _hold(self, now: float) -> None:
        if self._xon and self._xoff and not self._held and self.free <= self._hold_below:
            self._held = True
            self.out.put_first(self._xoff, now)

    def _let_go(self, now: float) -> None:
        if self._held and self.free >= max(self.size // 2, self._hold_below + 1):
            self._held = False
            self.out.put_first(self._xon, now)
