"""What nobody needs is thrown away, when the service starts and once a day, so that no disk fills.

A job needs its plan, and a plan its pattern: a history has material, machine, plan and both faces
as they were. Transcripts, and the database of jobs and strokes, are never touched.
"""

from __future__ import annotations

import asyncio
import logging

from foldmill_fabricate.jobs import Desk
from foldmill_fabricate.jobs.keeping import DAY
from foldmill_fabricate.service.storage import Storage

LOG = logging.getLogger("foldmill.service")


class Retention:
    """Throws away the plans and patterns of a service that nobody needs and nobody asks for."""

    def __init__(self, storage: Storage, desk: Desk) -> None:
        self._storage, self._desk = storage, desk

    def sweep(self) -> int:
        """Throw away what is due now; return how many patterns, plans and job folders that was.

        What is asked for while this goes on stays, and so does what is submitted meanwhile.
        """
        days = self._desk.places.keep_days
        needed = self._desk.store.plans_needed()
        gone = self._storage.throw_away(needed)
        gone += self._desk.plans.throw_away(days, needed | self._storage.made())
        if gone:
            LOG.info("threw away %d that nobody asked for in %d days", len(gone), days)
        return len(gone)

    async def run(self) -> None:
        """Sweep now and once a day, until cancelled; what goes wrong is told to the log."""
        while True:
            try:
                await asyncio.to_thread(self.sweep)
            except Exception:
                LOG.exception("nothing more is thrown away today")
            await asyncio.sleep(DAY)
