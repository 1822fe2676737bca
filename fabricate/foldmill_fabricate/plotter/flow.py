"""How evenly a machine is fed: gaps, lateness and bytes on their way, as its sender sees them.

A machine that has executed all it was given stands still until more arrives: a *gap*. No machine
tells of one, so it is reckoned: from when all must be executed by the motion model, or by what the
machine itself has said where that is later, until the next instruction has arrived.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import inf

from foldmill_fabricate.plotter.program import Instruction
from foldmill_fabricate.plotter.session import Session

_NO_GAP = 0.001
"""s: shorter ones are the model's rounding, and no machine's standing still."""


@dataclass(frozen=True)
class Flow:
    """How a delivery has flowed so far."""

    starved: float = 0.0
    """s that the machine had nothing to do between the first instruction and the last"""
    gap: float = 0.0
    """s of the longest of these gaps"""
    late: float = 0.0
    """s that the sender has woken later than it had asked to, at worst"""
    paused: float = 0.0
    """s that a person wanted nothing to be sent"""
    in_flight: int = 0
    """bytes that have left and are not executed yet, by the model"""


class Gauge:
    """Measures the flow of one delivery."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._finished = inf
        """When all that was sent is executed; infinite before the first instruction."""
        self._flying: deque[tuple[float, int]] = deque()
        self._in_flight = 0
        self._starved = self._gap = self._paused = 0.0

    def written(self, part: Instruction, busy_until: float) -> None:
        """Count an instruction that has been written.

        busy_until : until when the machine has to do with what was written before, as it said.
        """
        arrives = max(self._session.line_free, self._session.clock.now())
        gap = arrives - max(self._finished, busy_until)
        if gap > _NO_GAP:
            self._starved += gap
            self._gap = max(self._gap, gap)
        begins = arrives if self._finished == inf else max(self._finished, busy_until, arrives)
        self._finished = begins + part.seconds
        self._flying.append((self._finished, len(part.data)))
        self._in_flight += len(part.data)

    def paused(self, seconds: float) -> None:
        """Leave a pause out: what was sent before is executed, and no gap begins."""
        self._paused += seconds
        self._finished = inf

    @property
    def flow(self) -> Flow:
        """Return the flow up to now."""
        now = self._session.clock.now()
        while self._flying and self._flying[0][0] <= now:
            self._in_flight -= self._flying.popleft()[1]
        late = self._session.late
        return Flow(self._starved, self._gap, late, self._paused, self._in_flight)
