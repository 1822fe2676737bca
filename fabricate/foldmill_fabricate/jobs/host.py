"""The one process on a computer that works on jobs: it holds the host's lock and the engine."""

from __future__ import annotations

import logging
import tempfile
from collections import Counter
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from pathlib import Path
from threading import Event

from pydantic import ValidationError

from foldmill.errors import FoldmillError
from foldmill.refusals import explain
from foldmill_fabricate.jobs.alone import alone, alone_in, plotter_name
from foldmill_fabricate.jobs.engine import PLANNING, Engine, Make, Take
from foldmill_fabricate.jobs.errors import Cancelled, JobRefused, Leave
from foldmill_fabricate.jobs.hands import LOOK
from foldmill_fabricate.jobs.ordering import carry_out_elsewhere
from foldmill_fabricate.jobs.places import Places
from foldmill_fabricate.jobs.plans import Plans
from foldmill_fabricate.jobs.plotters import Plotter
from foldmill_fabricate.jobs.states import JobState
from foldmill_fabricate.jobs.store import JobStore
from foldmill_fabricate.jobs.values import Order
from foldmill_fabricate.jobs.work import Shop, Tell, work
from foldmill_fabricate.plotter.errors import Fenced, LedgerFailed
from foldmill_fabricate.space import DiskFull, keeping

_LOG = logging.getLogger(__name__)
_HERE = "this-computer"
"""What the engine knows it by where only this one uses the files: a host's own name may change."""
_BREATH = 2.0
"""s before a turn is given again that nothing could be done in."""


class Host:
    """Works on the jobs of these plotters until it is stopped.

    name : of this computer, fixed; it must be given where the database is not a file, for other
    computers may use the same. Raises JobRefused where another process does so already.
    """

    def __init__(
        self,
        places: Places,
        plotters: Mapping[str, Plotter],
        name: str = "",
        tell: Tell | None = None,
    ) -> None:
        if places.database and not name:
            raise JobRefused(
                "With a database that others reach this computer needs a name of its own, always "
                "the same: give --host-name."
            )
        self.places, self.plotters = places, plotters
        with ExitStack() as held:
            held.enter_context(alone(places))
            self.store = JobStore(places.ledger)
            held.callback(self.store.close)
            self._keep = held.enter_context(alone_in(self.store, name, plotters))
            self.plans = Plans(places.plans, places.keep_days)
            self._leaving = Event()
            self._shop = Shop(self.store, self.plans, places, self._leaving, tell or Tell())
            self._tokens: dict[str, int] = {}
            self._engine = Engine(places.engine, name or _HERE, self._queues(), self._due)
            self._held = held.pop_all()

    def start(self) -> None:
        """Take up what a crash has left, and begin to work."""
        self._engine.start()

    def wake(self) -> None:
        """Look for jobs now."""
        self._engine.wake()

    def stop(self) -> None:
        """Stop the machines, leave what is under way to be taken up again, and let go of all."""
        self._leaving.set()
        try:
            self._engine.stop()
        finally:
            self._held.close()

    def _queues(self) -> dict[str, tuple[Take, Make]]:
        made: dict[str, tuple[Take, Make]] = {
            f"plotter-{name}": (self._take, self._make) for name in self.plotters
        }
        return {PLANNING: (self._take_order, self._plan), **made}

    def _due(self) -> dict[str, int]:
        """Return how many jobs of each queue are due; those nobody can work on any more end."""
        self._keep()
        found = self.store.standing()
        for job in found:
            if job.is_abandoned(self.plotters) and not self._is_elsewhere(job.plotter):
                self.store.end_abandoned(job.id)
        due = Counter(f"plotter-{job.plotter}" for job in found if job.is_due)
        return {**due, PLANNING: sum(job.state is JobState.PLANNING for job in found)}

    def _is_elsewhere(self, plotter: str) -> bool:
        """Tell whether another computer works on a plotter's jobs: it ends them itself."""
        return self.store.ledger.is_reserved(plotter_name(plotter))

    def _take(self, queue: str) -> str:
        try:
            taken = self.store.take(queue.removeprefix("plotter-"))
        except LedgerFailed as error:
            _LOG.warning("%s: no job is taken: %s", queue, error)
            self._leaving.wait(_BREATH)
            return ""  # what is due has a turn again
        if taken is None:
            return ""
        job, self._tokens[job.id] = taken
        return job.id

    def _make(self, queue: str, name: str) -> None:
        """Work on a job that was taken; after a crash it is taken anew, by a new token."""
        plotter = self.plotters[queue.removeprefix("plotter-")]
        try:
            token = self._tokens.pop(name, None) or self._take_again(plotter.name, name)
            if token:
                work(self._shop, self.store.job(name), token, plotter)
        except (Leave, Fenced) as error:
            _LOG.warning("job %s: %s", name, error)
        except LedgerFailed as error:
            _LOG.warning("job %s: %s", name, error)
            self._wait_for_ledger(name, str(error))
        except Exception:  # the job is due, and has a turn again
            _LOG.exception("job %s", name)
            self._leaving.wait(_BREATH)

    def _take_again(self, plotter: str, name: str) -> int:
        """Return a token for a job that was taken by a process that crashed; 0 where it ended."""
        taken = self.store.take(plotter)
        return taken[1] if taken and taken[0].id == name else 0

    def _wait_for_ledger(self, name: str, why: str) -> None:
        """Wait until something can be written down again; the job is taken up by the next turn."""
        while not self._leaving.wait(LOOK):
            with suppress(LedgerFailed):
                self.store.tell(name, f"the work was broken off: {why}")
                return

    def _take_order(self, queue: str) -> str:  # noqa: ARG002
        waiting = self.store.jobs([JobState.PLANNING])
        return waiting[-1].id if waiting else ""

    def _plan(self, queue: str, name: str) -> None:  # noqa: ARG002
        """Plan an ordered design; killed and begun again, it does the same."""
        try:
            if self.store.job(name).state is JobState.PLANNING:
                self._carry_out(name)
        except (Leave, Cancelled):
            return
        except (LedgerFailed, DiskFull) as error:
            _LOG.warning("job %s waits to be planned: %s", name, error)
            with suppress(LedgerFailed):
                self.store.hold(name, str(error))
            self._leaving.wait(_BREATH)

    def _carry_out(self, name: str) -> None:
        """Plan an order; raises LedgerFailed and DiskFull, upon which it may be tried again."""
        scratch = Path(tempfile.gettempdir())
        with keeping(scratch), tempfile.TemporaryDirectory(prefix="foldmill-") as place:
            folder = Path(place) / "job"
            try:
                order = Order.model_validate_json(self.store.order(name))
                carry_out_elsewhere(order, folder, self._leaving, lambda: self._heed_order(name))
                plan = self.plans.keep(folder)
            except (Leave, Cancelled, LedgerFailed, DiskFull):
                raise
            except (FoldmillError, OSError) as error:
                self.store.refused(name, str(error))
                return
            except ValidationError as error:  # it was ordered when more was allowed
                self.store.refused(name, explain(error, Order))
                return
        self.store.planned(name, plan, self.plans.about(plan))

    def _heed_order(self, name: str) -> None:
        with suppress(LedgerFailed):  # planning goes on while nobody can say otherwise
            if self.store.job(name).state is not JobState.PLANNING:
                raise Cancelled("Ended by a person.")
