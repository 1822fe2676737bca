"""A throttle: so many bytes a second, and never more than the motion model lets be in flight."""

from __future__ import annotations

from foldmill_fabricate.plotter.handshakes.hp import HpSession
from foldmill_fabricate.plotter.handshakes.modelled import Modelled
from foldmill_fabricate.plotter.program import Job


class Paced(Modelled):
    """``paced``: for machines that lose bytes which come in too fast, whatever their buffer."""

    def __init__(self, session: HpSession, job: Job) -> None:
        super().__init__(session, job)
        self._rate = session.machine.serial.bytes_per_second
        self._next = session.clock.now()

    def guard(self, number: int) -> None:
        """Wait until the unit's turn has come."""
        self.session.rest_until(self._next)
        seconds = len(self.sums.parts[number].data) / self._rate
        self._next = max(self._next, self.session.clock.now()) + seconds
