"""The engine that outlives crashes: one queue for each plotter, one turn at a time on it.

Which job a turn takes is said by the store when the turn begins, so priorities and cancels need
nothing of the engine; and whether a stroke may be cut is said by the ledger alone. What the engine
holds is only that a plotter has a turn to give. This is the one module that knows DBOS, and it
keeps the rules by which that is safe beside a machine:

- one process, one fixed executor id, a pinned application version, and a lock on the host;
- a queue per plotter that gives one turn at a time, over all and in each process;
- workflows are asynchronous, and what blocks runs in threads of their own;
- arguments and results are names, never objects;
- nothing is cancelled, resumed or forked through the engine;
- a turn that nobody has, because its beginning or its end could not be written down, is forgotten:
  it is nothing but a turn, and what is due is given another.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Mapping
from threading import Event, Thread
from typing import Any

from dbos import DBOS, DBOSConfig
from sqlalchemy.exc import SQLAlchemyError

from foldmill_fabricate.jobs import patient
from foldmill_fabricate.plotter.errors import LedgerFailed

_LOG = logging.getLogger(__name__)
_NAME = "foldmill"
_VERSION = "foldmill-1"
"""Bumped by hand where a turn that was begun before must not be taken up by the new code."""
_LOOK = 0.5
"""s between two looks for jobs that were submitted."""
_POLL = 0.25
"""s between two looks of a queue for its next turn."""
_OLD = 20
"""Turns that have ended and are kept, at most."""
_PENDING = ["ENQUEUED", "PENDING", "DELAYED"]
_GRACE = 5.0
"""s after which a turn that was begun, and that nobody has, is lost: it takes that to begin one."""
_PATIENCE = 10
"""s for what is under way when the engine stops."""
PLANNING = "planning"
"""The queue of designs that are to be planned: none of them has a machine."""

Take = Callable[[str], str]
"""Take the next job of a queue: its name, or nothing where there is none."""
Make = Callable[[str, str], None]
"""Work on a job of a queue until it ends."""
_hands: dict[str, tuple[Take, Make]] = {}
"""Who takes and makes, by queue: a process has one engine."""


_under_way: set[str] = set()
"""The turns that this process has now."""


@DBOS.workflow(name="turn")
async def _turn(queue: str) -> str:
    own = DBOS.workflow_id or ""
    _under_way.add(own)
    try:
        job = await DBOS.run_step_async({"name": "take"}, _take, queue)
        if job:
            await DBOS.run_step_async({"name": "make"}, _make, queue, job)
    except Exception as error:
        trace = None if isinstance(error, SQLAlchemyError) else error
        why = (str(error).splitlines() or [type(error).__name__])[0]
        _LOG.error("a turn of %s failed, another is given: %s", queue, why, exc_info=trace)
        raise
    finally:
        _under_way.discard(own)
    return job


async def _take(queue: str) -> str:
    return await asyncio.to_thread(_hands[queue][0], queue)


async def _make(queue: str, job: str) -> str:
    await asyncio.to_thread(_hands[queue][1], queue, job)
    return "ended"


class Engine:
    """Gives turns. There is one in a process.

    url : database of its own tables. host : a fixed name of this computer. queues : by name who
    takes and makes. due : how many jobs of each queue wait for a turn or have one.
    """

    def __init__(
        self,
        url: str,
        host: str,
        queues: Mapping[str, tuple[Take, Make]],
        due: Callable[[], Mapping[str, int]],
    ) -> None:
        self._queues, self._due = queues, due
        self._over, self._wake = Event(), Event()
        self._database = patient.engine(url, self._over)
        self._config: DBOSConfig = {
            "name": _NAME,
            "system_database_engine": self._database,
            "system_database_url": url,
            "executor_id": host,
            "application_version": _VERSION,
            "log_level": "ERROR",
            "enable_otlp": False,
            "notification_coalesce_sec": 1.0,  # nothing waits for one: a hundredth is its default
        }
        self._lost: dict[str, float] = {}
        """When turns were first seen that nobody has, s, by their id."""
        self._away = ""
        self._kept = True
        """Whether turns may have ended that are still kept."""
        self._dispatcher = Thread(target=self._dispatch, name="dispatcher", daemon=True)

    def start(self) -> None:
        """Take up what a crash left, then give turns."""
        _hands.update(self._queues)
        DBOS(config=self._config)
        DBOS.listen_queues(list(self._queues))
        DBOS.launch()
        for name in self._queues:
            DBOS.register_queue(
                name, global_concurrency=1, worker_concurrency=1, polling_interval_sec=_POLL
            )
        self._dispatcher.start()

    def wake(self) -> None:
        """Look for jobs now."""
        self._wake.set()

    def stop(self) -> None:
        """Give no more turns, and wait for those under way; who works must have been told."""
        self._over.set()
        self._wake.set()
        self._dispatcher.join(_PATIENCE)
        DBOS.destroy(workflow_completion_timeout_sec=_PATIENCE)
        if self._database is not None:
            self._database.dispose()
        _hands.clear()

    def _dispatch(self) -> None:
        while not self._over.is_set():
            self._wake.clear()
            try:
                under_way = self._give_turns(self._due())
                if under_way or self._kept:
                    self._kept = self._forget_turns() or under_way
            except Exception as error:  # a database that is away must not end the service
                self._say_away(error)
            else:
                self._say_back()
            self._wake.wait(_LOOK)

    def _say_away(self, error: Exception) -> None:
        """Log once, and not at every look, why no turns are given."""
        why = patient.sentence(error, self._config["system_database_url"] or "")
        if not self._away and not self._over.is_set():
            trace = None if isinstance(error, LedgerFailed) or "full" in why else error
            _LOG.warning("no jobs are begun now: %s", why, exc_info=trace)
        self._away = self._away or why

    def _say_back(self) -> None:
        if self._away:
            _LOG.warning("jobs are begun again; what was in the way is over")
        self._away = ""

    def _give_turns(self, due: Mapping[str, int]) -> bool:
        """Give as many turns as are due; tell whether any is."""
        wanted = {name: count for name, count in due.items() if name in self._queues}
        for name, count in wanted.items():
            if count > 0:
                for _ in range(count - self._given(name)):
                    DBOS.enqueue_workflow(name, _turn, name)
        return any(wanted.values())

    def _forget_turns(self) -> bool:
        """Forget turns that have ended: what they did stands in the store; tell whether any was."""
        ended = DBOS.list_workflows(
            queue_name=list(self._queues),
            status=["SUCCESS", "ERROR"],
            limit=_OLD,
            load_input=False,
            load_output=False,
        )
        if len(ended) == _OLD:
            DBOS.delete_workflows([one.workflow_id for one in ended])
        return len(ended) == _OLD

    def _given(self, name: str) -> int:
        """Return how many turns of a queue wait or are under way."""
        found: list[Any] = DBOS.list_workflows(
            queue_name=name, status=_PENDING, load_input=False, load_output=False
        )
        lost = {turn.workflow_id for turn in found if self._is_lost(turn)}
        if lost:
            DBOS.delete_workflows(sorted(lost))
            self._lost = {turn: since for turn, since in self._lost.items() if turn not in lost}
        return len(found) - len(lost)

    def _is_lost(self, turn: Any) -> bool:
        """Tell whether a turn was begun, and nobody has had it for a while."""
        mine = turn.status == "PENDING" and turn.executor_id == self._config["executor_id"]
        if not mine or turn.workflow_id in _under_way:
            self._lost.pop(turn.workflow_id, None)
            return False
        now = time.monotonic()
        return now - self._lost.setdefault(turn.workflow_id, now) > _GRACE
