"""Clocks. Sender and simulator share one, so simulated hours take seconds.

A clock counts seconds from an origin of its own; only differences mean something.
"""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """What can be asked the time and be waited by."""

    def now(self) -> float:
        """Return the time, s."""
        ...

    def sleep(self, seconds: float) -> None:
        """Return that many seconds later; at once where they are not positive."""
        ...

    def sleep_until(self, moment: float) -> None:
        """Return at that time; at once where it has passed."""
        ...


class RealClock:
    """The time on the wall, for wires that really exist."""

    def now(self) -> float:
        """Return the time, s."""
        return time.monotonic()

    def sleep(self, seconds: float) -> None:
        """Wait."""
        time.sleep(max(0.0, seconds))

    def sleep_until(self, moment: float) -> None:
        """Wait until then."""
        self.sleep(moment - self.now())


class VirtualClock:
    """A time that passes only when somebody waits, and then at once.

    >>> clock = VirtualClock()
    >>> clock.sleep(3600)
    >>> clock.now()
    3600.0
    """

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        """Return the time, s."""
        return self._now

    def sleep(self, seconds: float) -> None:
        """Let the time pass."""
        self._now += max(0.0, seconds)

    def sleep_until(self, moment: float) -> None:
        """Let the time pass until then."""
        self._now = max(self._now, moment)
