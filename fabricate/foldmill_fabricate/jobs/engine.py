"""The engine that outlives crashes: one queue for each plotter, one turn at a time on it.

Which job a turn takes is said by the store when the turn begins, so priorities and cancels need
nothing of the engine; and whether a stroke may be cut is said by the ledger alone. What the engine
holds is only that a plotter has a turn to give. This is the one module that knows DBOS, and it
keeps the rules by which that is safe beside a machine:

- one process, one fixed executor id, a pinned application version, and a lock on the host;
- a queue per plotter that gives one turn at a time, over all and in each process;
- workflows are asynchronous, and what blocks runs in threads of their own;
- arguments and results are names, never objects;
- nothing is cancelled, resumed or forked through the engine.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Iterable, Mapping
from threading import Event, Thread
from typing import Any

from dbos import DBOS, DBOSConfig

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
PLANNING = "planning"
"""The queue of designs that are to be planned: none of them has a machine."""

Take = Callable[[str], str]
"""Take the next job of a queue: its name, or nothing where there is none."""
Make = Callable[[str, str], None]
"""Work on a job of a queue until it ends."""
_hands: dict[str, tuple[Take, Make]] = {}
"""Who takes and makes, by queue: a process has one engine."""


@DBOS.workflow(name="turn")
async def _turn(queue: str) -> str:
    job = await DBOS.run_step_async({"name": "take"}, _take, queue)
    if job:
        await DBOS.run_step_async({"name": "make"}, _make, queue, job)
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
        self._config: DBOSConfig = {
            "name": _NAME,
            "system_database_url": url,
            "executor_id": host,
            "application_version": _VERSION,
            "log_level": "WARNING",
            "enable_otlp": False,
        }
        self._over, self._wake = Event(), Event()
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
        self._dispatcher.join()
        DBOS.destroy(workflow_completion_timeout_sec=10)
        _hands.clear()

    def _dispatch(self) -> None:
        while not self._over.is_set():
            self._wake.clear()
            try:
                self._give_turns(self._due())
                self._forget_turns()
            except Exception:  # a database that is away for a moment must not end the service
                _LOG.exception("no turns could be given")
            self._wake.wait(_LOOK)

    def _give_turns(self, due: Mapping[str, int]) -> None:
        wanted = {name: count for name, count in due.items() if name in self._queues}
        for name, count in wanted.items():
            if count > 0:
                for _ in range(count - self._given(name)):
                    DBOS.enqueue_workflow(name, _turn, name)

    def _forget_turns(self) -> None:
        """Keep nothing of turns that have ended: what they did stands in the store."""
        ended = DBOS.list_workflows(
            queue_name=list(self._queues),
            status=["SUCCESS", "ERROR"],
            limit=_OLD,
            load_input=False,
            load_output=False,
        )
        if len(ended) == _OLD:
            DBOS.delete_workflows([one.workflow_id for one in ended])

    def _given(self, name: str) -> int:
        found: Iterable[Any] = DBOS.list_workflows(
            queue_name=name, status=_PENDING, load_input=False, load_output=False
        )
        return len(list(found))
