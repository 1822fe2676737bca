"""How well a sender uses the line: measured from outside, with what only the simulator knows."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

QUESTIONS = re.compile(rb"(?:O[AE];)+")
"""What senders ask between instructions."""
MOST_IN_FLIGHT = 3.0
"""s of motion."""


@dataclass
class Use:
    """Seconds of the line towards the machine."""

    busy: float = 0.0
    """a byte was on its way"""
    missed: float = 0.0
    """the line stood idle although the next whole instruction would have been taken, and would not
    have made more than three seconds in flight"""
    unfilled: float = 0.0
    """the same, with no regard to what is in flight"""
    questions: int = 0
    """bytes of device control among those sent"""
    program: int = 0
    """bytes of HP-GL among those sent"""

    @property
    def utilisation(self) -> float:
        """Share of the time in which the line was busy or could have been, that it was busy."""
        return self.busy / (self.busy + self.missed) if self.busy else 0.0

    @property
    def filling(self) -> float:
        """The same where only the buffer counts, which a sender leaves half empty on purpose."""
        return self.busy / (self.busy + self.unfilled) if self.busy else 0.0

    @property
    def payload(self) -> float:
        """Share of the bytes sent that are HP-GL."""
        return self.program / (self.program + self.questions) if self.program else 0.0


class Gauge:
    """Knows the program that comes, and so whether its next instruction may go.

    It may when it has room: the bytes free, less those on the line, are at least its length and the
    reserve; on an XON/XOFF line also whenever the machine does not hold. And when what the machine
    has not begun, with it, is at most three seconds of motion or within one stroke: more is held
    back on purpose. Questions of a sender between instructions are none.
    """

    def __init__(
        self,
        instructions: Sequence[bytes],
        reserve: int,
        motion: Sequence[tuple[float, int]] = (),
    ) -> None:
        """Take the program; motion : the seconds and the stroke of each instruction, if known."""
        self.use = Use()
        self._lengths = [len(each) for each in instructions]
        self._reserve = reserve
        self._seconds = [0.0, *accumulate(seconds for seconds, _ in motion)]
        self._strokes = [stroke for _, stroke in motion]
        self._ends = [0]
        """Bytes of program written up to the end of each instruction, questions included."""
        self._left = self._total = 0

    def written(self, data: bytes, program: int) -> None:
        """Learn that bytes were written, ``program`` of them not device control."""
        self._total += program
        if QUESTIONS.fullmatch(data):
            return
        self._left += program
        while self._next is not None and self._left >= self._lengths[len(self._ends) - 1]:
            self._left -= self._lengths[len(self._ends) - 1]
            self._ends.append(self._total - self._left)

    @property
    def _next(self) -> int | None:
        number = len(self._ends) - 1
        return number if number < len(self._lengths) else None

    def needs(self) -> int | None:
        """Return the free bytes that the next instruction needs; None where none is left."""
        number = self._next
        return None if number is None else self._lengths[number] + self._reserve

    def missed(self, seconds: float, begun: int) -> None:
        """Learn that the line stood idle for so long while there was room.

        begun : bytes of program, written since the gauge was made, that the machine has begun.
        """
        number = self._next
        self.use.unfilled += seconds
        if number is not None and self._may_go(number, bisect_right(self._ends, begun) - 1):
            self.use.missed += seconds

    def _may_go(self, number: int, done: int) -> bool:
        if not self._strokes:
            return True
        in_flight = self._seconds[number + 1] - self._seconds[min(done, number)]
        same = self._strokes[min(done, number)] == self._strokes[number]
        return same or in_flight <= MOST_IN_FLIGHT
