"""What happens, as server-sent events: each job event has a number, so that nothing is missed.

A client that was cut off names the number it heard last (Last-Event-ID) and hears the rest. Between
them comes, without a number, how far the sheets under work are: only the newest counts. However
many follow, the database is looked at once for all of them; each reads what it has not heard yet.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Callable
from contextlib import suppress
from typing import Any, NamedTuple

from fastapi.sse import ServerSentEvent

from foldmill_fabricate.jobs.states import ACTIVE
from foldmill_fabricate.jobs.values import Event
from foldmill_fabricate.plotter.errors import LedgerFailed
from foldmill_fabricate.service.problems import NoSuch
from foldmill_fabricate.service.sandbox import TooBusy
from foldmill_fabricate.service.workshop import Workshop

LOOK = 0.3
"""s between two looks for something new."""
ASK = 5.0
"""s after which it is asked at the latest whether who follows still may."""
MOST = 200
"""Who may follow at the same time; half of the requests that are answered at once."""
RETRY = 1000
"""ms after which a client that was cut off comes back."""
_AT_ONCE = 100
"""Events that are read at once; who hears slowly holds as many."""
_LOG = logging.getLogger("foldmill.service")


class News:
    """Looks whether anything is new, for as long as anybody follows."""

    def __init__(self, shop: Workshop, stopping: asyncio.Event) -> None:
        self._shop, self._stopping = shop, stopping
        self._count = 0
        self._looking: asyncio.Task[None] | None = None
        self._changed = asyncio.Event()
        self.seen: tuple[int, list[dict[str, Any]]] = 0, []
        """The number of the newest event, and how far the sheets under work are."""

    async def enter(self, heard: int) -> None:
        """Begin to follow; raises TooBusy where there is no room, NoSuch for an event to come."""
        if self._count >= MOST:
            raise TooBusy(f"{MOST} others follow what happens already; try again later.")
        self._count += 1
        try:
            self._see(await asyncio.to_thread(_look, self._shop))
            if heard > self.seen[0]:
                raise NoSuch(
                    f"There is no event {heard} here; the last is {self.seen[0]}. These are the "
                    "jobs of another database: follow from 0."
                )
        except BaseException:
            self.leave()
            raise
        if self._looking is None:
            self._looking = asyncio.create_task(self._watch())

    def leave(self) -> None:
        """Follow no longer."""
        self._count -= 1
        if not self._count and self._looking is not None:
            self._looking.cancel()
            self._looking = None

    async def other_than(self, known: object, seconds: float) -> None:
        """Return when something else is seen than what is known, or after so many seconds."""
        if self.seen is known:
            with suppress(TimeoutError):
                await asyncio.wait_for(self._changed.wait(), seconds)

    async def _watch(self) -> None:
        while not self._stopping.is_set():
            await asyncio.sleep(LOOK)
            try:
                found = await asyncio.to_thread(_look, self._shop)
            except LedgerFailed:
                continue  # who gives turns says so, once
            except Exception:  # whatever it is must not end it
                _LOG.exception("what happens could not be looked at")
                continue
            self._see(found)
        self._wake()

    def _see(self, found: tuple[int, list[dict[str, Any]]]) -> None:
        if found != self.seen:
            self.seen = found
            self._wake()

    def _wake(self) -> None:
        self._changed.set()
        self._changed = asyncio.Event()


class Following(NamedTuple):
    """Who has taken a place among those who follow."""

    job: str
    """Id of the only one that is followed; empty for all."""
    after: int
    """Number of the event that was heard last."""
    counts: Callable[[], bool] = lambda: True
    """Tells whether who follows may still do so: a token may be revoked meanwhile."""


async def follow(
    shop: Workshop, news: News, who: Following, seconds: float, stopping: asyncio.Event
) -> AsyncIterator[ServerSentEvent]:
    """Yield what happened after an event, and what happens, for so many seconds."""
    loop, job, after = asyncio.get_running_loop(), who.job, who.after
    end, told = loop.time() + seconds, None
    yield ServerSentEvent(comment="following", retry=RETRY)
    while True:
        seen = news.seen
        if not who.counts():
            return
        try:
            events = await asyncio.to_thread(shop.desk.store.events, after, job, _AT_ONCE)
        except LedgerFailed:  # nothing is missed: it is looked again
            if stopping.is_set():
                return
            await asyncio.sleep(LOOK)
            continue
        for event in events:
            after = event.number
            yield _numbered(event)
        progress = [each for each in seen[1] if not job or each["job"] == job]
        if progress != told:
            told = progress
            yield ServerSentEvent(event="progress", data=progress)
        left = end - loop.time()
        if left <= 0 or stopping.is_set():
            return
        if not events:
            await news.other_than(seen, min(left, ASK))


def _numbered(event: Event) -> ServerSentEvent:
    return ServerSentEvent(event="job", id=str(event.number), data=event.model_dump(mode="json"))


def _look(shop: Workshop) -> tuple[int, list[dict[str, Any]]]:
    """Return the number of the newest event, and how far the sheets under work are."""
    number = shop.desk.store.last_event()
    under_way = [each for each in shop.desk.jobs([*ACTIVE]) if each.begun and each.sheets]
    return number, [
        {"job": each.id, "sheet": shop.sheets(each)[-1].model_dump(mode="json")}
        for each in under_way
    ]
