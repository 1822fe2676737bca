"""How well a sender uses the line: measured from outside, with what only the simulator knows."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate


@dataclass
class Use:
    """Seconds of the line towards the machine."""

    busy: float = 0.0
    """a byte was on its way"""
    missed: float = 0.0
    """the line stood idle although the next whole instruction would have been taken"""
    questions: int = 0
    """bytes of device control among those sent"""
    program: int = 0
    """bytes of HP-GL among those sent"""

    @property
    def utilisation(self) -> float:
        """Share of the time in which the line was busy or could have been, that it was busy."""
        return self.busy / (self.busy + self.missed) if self.busy else 0.0

    @property
    def payload(self) -> float:
        """Share of the bytes sent that are HP-GL."""
        return self.program / (self.program + self.questions) if self.program else 0.0


class Gauge:
    """Knows the program that comes, and so whether its next instruction has room.

    An instruction has room when the bytes free, less those on the line, are at least its length
    and the reserve; on an XON/XOFF line also whenever the machine does not hold.
    """

    def __init__(self, instructions: Sequence[bytes], reserve: int) -> None:
        self.use = Use()
        self._needs = [len(each) + reserve for each in instructions]
        self._ends = list(accumulate(len(each) for each in instructions))

    def needs(self, sent: int) -> int | None:
        """Return the free bytes that the next instruction needs; None when all are sent."""
        number = bisect_right(self._ends, sent)
        return self._needs[number] if number < len(self._needs) else None
