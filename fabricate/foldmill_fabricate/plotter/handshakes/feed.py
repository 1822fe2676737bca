"""What every handshake has in common: when the next unit may go, and what is certain so far.

In flight, that is sent and not known to be executed, is at most the buffer less its reserve, and at
most three seconds of motion or one stroke, whichever is longer: so that stopping means something.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from itertools import accumulate
from typing import Protocol

from foldmill_fabricate.plotter.endings import Ending
from foldmill_fabricate.plotter.program import Job

IN_FLIGHT = 3.0
"""s of motion."""
SLACK = 3.0
"""How many times longer than modelled a machine may take before it is given up."""
NAP = 0.05
"""s until something is looked at again that says nothing by itself."""


class Feed(Protocol):
    """Decides when the next unit may go, hears what comes back, and ends a delivery."""

    def wait_for(self, number: int) -> None:
        """Return when unit ``number`` may be written; raises NoAnswer, Stopped."""
        ...

    def written(self, number: int) -> None:
        """Learn that it was; raises PlotterError for what the machine then says is wrong."""
        ...

    def idle(self) -> None:
        """Pass a moment of a pause; raises as ``wait_for``."""
        ...

    def confirm(self) -> Ending:
        """Wait until all is executed, or cannot be known to be."""
        ...

    @property
    def acked(self) -> int:
        """Strokes that are known to be executed: all before this one."""
        ...

    @property
    def busy_until(self) -> float:
        """Until when the machine has something to do at least, s, by what it said; or -inf."""
        ...


class Sums:
    """Sums over the units of a job: bytes and seconds before each."""

    def __init__(self, job: Job) -> None:
        self.parts = job.parts
        self.bytes = [0, *accumulate(len(part.data) for part in job.parts)]
        self.seconds = [0.0, *accumulate(part.seconds for part in job.parts)]

    def in_flight(self, done: int, sent: int) -> float:
        """Return the motion of units ``done`` … ``sent`` - 1, s."""
        return self.seconds[sent] - self.seconds[done]

    def at_byte(self, byte: int) -> float:
        """Return the motion before a byte of the program, s, evenly spread within a unit."""
        number = min(bisect_right(self.bytes, byte) - 1, len(self.parts) - 1)
        share = (byte - self.bytes[number]) / len(self.parts[number].data)
        return self.seconds[number] + share * self.parts[number].seconds

    def byte_at(self, seconds: float) -> int:
        """Return the byte of the program before which there is so much motion, s."""
        number = min(bisect_right(self.seconds, seconds) - 1, len(self.parts) - 1)
        part = self.parts[number]
        share = (seconds - self.seconds[number]) / part.seconds if part.seconds else 1.0
        return self.bytes[number] + int(min(share, 1.0) * len(part.data))

    def may_follow(self, done: int, number: int) -> bool:
        """Whether the next unit keeps what is in flight short, or within one stroke."""
        if done >= number or self.in_flight(done, number + 1) <= IN_FLIGHT:
            return True
        return self.parts[done].stroke == self.parts[number].stroke

    def makes_way(self, number: int) -> int:
        """Return how many units must be done for unit ``number`` to follow."""
        enough = bisect_left(self.seconds, self.seconds[number + 1] - IN_FLIGHT)
        same = bisect_left(self.parts, self.parts[number].stroke, key=lambda part: part.stroke)
        return min(enough, same, number)

    def reach(self, done: int) -> int:
        """Return a number up to which units may follow at most; little above the truth.

        A large buffer holds thousands that may not, and looking at each takes longer than cutting.
        """
        short = bisect_right(self.seconds, self.seconds[done] + IN_FLIGHT) + 1
        if done >= len(self.parts):
            return short
        stroke, last = self.parts[done].stroke, max(done, short)
        while last < len(self.parts) and self.parts[last].stroke == stroke:
            last += 1
        return last + 1
