"""A conversation with one machine: the port, the clock, the profile, and what all handshakes share.

What is written leaves the computer byte by byte; ``line_free`` is when the last of it will have
left, so that silence is told from a long way.
"""

from __future__ import annotations

from math import inf
from typing import Any

from foldmill_fabricate.machines import Machine
from foldmill_fabricate.plotter.clock import Clock
from foldmill_fabricate.plotter.errors import Stopped
from foldmill_fabricate.plotter.wish import Wish

SILENCE = 1.0
"""s without an answer that is due at once, after the question has left, that are silence."""
PATIENCE = 5.0
"""s that a machine may be later than the motion model, besides its multiple, before it is given up.
"""
READ_SLICE = 0.02
"""s that one read waits at most; deadlines are counted by the clock."""
_SHORT = 0.002
"""s between two looks shortly before a deadline."""
_FEW = 5
"""Bytes that a fast line brings meanwhile."""
_LOOK = 0.25
"""s between two looks at a port while nothing else is to be done."""

_LAST_WORDS = 0.3
"""s for which a stopped machine is still heard, so that the stop itself is not lost."""

BY_HAND = "Stop the machine by hand: it may still be cutting what it has been given."


class Session:
    """The port, the clock and the machine's profile, and what has been learnt since."""

    ends = b"\r"
    """What ends an answer."""

    def __init__(self, port: Any, machine: Machine, clock: Clock, wish: Wish | None = None) -> None:
        self.port, self.machine, self.clock = port, machine, clock
        self.wish = wish or Wish()
        if port.timeout is None or port.timeout > READ_SLICE:
            port.timeout = READ_SLICE  # a read that waits for ever knows no deadline
        self.byte_time = 10 / machine.serial.baud
        self.buffer = machine.serial.buffer
        """Bytes the machine holds: as its profile says, then as it says itself."""
        self.whole = True
        """Whether all that was written so far ends with a whole unit."""
        self.lift = b""
        """What lifts the tool, of the program that is sent."""
        self.line_free = clock.now()
        self.late = 0.0
        """s by which this computer has woken later than asked, at worst."""
        self._heard = b""

    def open(self) -> None:
        """Find the machine ready; raises NoAnswer where it should answer and does not."""
        self.forget_answers()

    def write(self, data: bytes) -> None:
        """Write one whole unit."""
        self.whole = False
        self.send(data)
        self.whole = True

    def send(self, data: bytes) -> None:
        """Write bytes of the handshake's own."""
        self.line_free = max(self.line_free, self.clock.now()) + len(data) * self.byte_time
        self.port.write(data)

    def settle(self) -> None:
        """Wait until little of what was written lies in this computer, where it is lost to sight.

        Raises Stopped where a person wants that.
        """
        most = self.machine.dialect.max_instruction * self.byte_time
        self.rest_until(self.line_free - most)

    def rest_until(self, moment: float) -> None:
        """Wait and listen; raises Stopped, and what a port raises that has vanished."""
        while True:
            self.heed()
            self.listen()
            now = self.clock.now()
            if now >= moment:
                return
            self._sleep_until(min(moment, now + _LOOK))

    def _sleep_until(self, moment: float) -> None:
        """Sleep, and note by how much too long."""
        self.clock.sleep_until(moment)
        self.late = max(self.late, self.clock.now() - moment)

    def heed(self) -> None:
        """Raise Stopped where a person wants that."""
        if self.wish.stopped:
            raise Stopped("Stopped.")

    def listen(self) -> None:
        """Take what has come in."""
        ready = self.port.in_waiting
        if ready:
            self._heard += self.port.read(ready)
            self._sort()

    def wait_a_byte(self, deadline: float = inf, least: int = 1) -> None:
        """Wait for the next byte, a short while, and not far beyond a deadline.

        least : bytes that are to come at least, for all of which is waited at once.
        """
        self.heed()
        left = deadline - self.clock.now()
        if left < READ_SLICE:
            self.clock.sleep(min(left, _SHORT, _FEW * self.byte_time))
            self.listen()
            return
        came = self.port.read(max(1, least - len(self._heard)))
        if came:
            self._heard += came
            ready = self.port.in_waiting
            if ready:
                self._heard += self.port.read(ready)
            self._sort()

    @property
    def hearing(self) -> bool:
        """Whether an answer has begun to come in."""
        self.listen()
        return bool(self._heard)

    def _sort(self) -> None:
        while self.ends in self._heard:
            line, _, self._heard = self._heard.partition(self.ends)
            self.take(line)

    def take(self, line: bytes) -> None:
        """Take a whole answer, without its end."""

    def forget_answers(self) -> None:
        """Drop what has come in."""
        self.port.reset_input_buffer()
        self._heard = b""

    def unsent(self) -> int | None:
        """Return the bytes still in this computer; None where the port cannot tell."""
        try:
            return int(self.port.out_waiting)
        except (AttributeError, OSError):
            return None

    def stop(self) -> str:
        """Stop the machine as far as its profile allows, and say what that means.

        It discards what has not left and lifts XOFF, then has the machine drop what it holds and
        lift its tool. It never moves in x and y and never sends IN.
        """
        try:
            unsent = self.unsent()
            self.port.reset_output_buffer()
            self._lift_xoff()
            told = self.abort(unsent)
            self._see_off()
            return told
        except Exception:  # termios has an error of its own; whatever it is, a person must act
            return BY_HAND

    def _see_off(self) -> None:
        """Let the last bytes arrive: a connection that closes upon unread answers is reset.

        What was under way to the machine is dropped then, and it goes on with the tool down.
        """
        end = self.clock.now() + _LAST_WORDS
        while self.clock.now() < end:
            self.port.read(self.port.in_waiting)
            self.clock.sleep(_LAST_WORDS / 6)

    def abort(self, unsent: int | None) -> str:
        """Stop a machine that cannot drop what it holds: lift the tool where nothing is half-sent.

        unsent : bytes that had not left when the rest was discarded; None for not known.
        """
        if self.whole and unsent == 0 and self.lift:
            self.port.write(self.lift)
        return BY_HAND

    def _lift_xoff(self) -> None:
        if hasattr(self.port, "set_output_flow_control"):
            self.port.set_output_flow_control(True)
