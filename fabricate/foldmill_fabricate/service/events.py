"""What happens, as server-sent events: each job event has a number, so that nothing is missed.

A client that was cut off names the number it heard last (Last-Event-ID) and hears the rest. Between
them comes, without a number, how far the sheets under work are: only the newest counts.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Any

from fastapi.sse import ServerSentEvent

from foldmill_fabricate.jobs.states import ACTIVE
from foldmill_fabricate.jobs.values import Event
from foldmill_fabricate.plotter.errors import LedgerFailed
from foldmill_fabricate.service.sandbox import TooBusy
from foldmill_fabricate.service.workshop import Workshop

LOOK = 0.3
"""s between two looks for something new."""
MOST = 50
"""Who may follow at the same time: each takes a look at the database."""
RETRY = 1000
"""ms after which a client that was cut off comes back."""


class Followers:
    """Who follows what happens; there is room for a few."""

    def __init__(self) -> None:
        self._count = 0

    def enter(self) -> None:
        """Take a place; raises TooBusy where there is none."""
        if self._count >= MOST:
            raise TooBusy(f"{MOST} others follow what happens already; try again later.")
        self._count += 1

    def leave(self) -> None:
        """Give the place back."""
        self._count -= 1


async def follow(
    shop: Workshop, after: int, job: str, seconds: float, stopping: asyncio.Event
) -> AsyncIterator[ServerSentEvent]:
    """Yield what happened after an event, and what happens, for so many seconds.

    job : only of this one; empty for all.
    """
    loop = asyncio.get_running_loop()
    end, told = loop.time() + seconds, None
    yield ServerSentEvent(comment="following", retry=RETRY)
    while True:
        events, progress = await asyncio.to_thread(_news, shop, after, job)
        for event in events:
            after = event.number
            yield _numbered(event)
        if progress is not None and progress != told:
            told = progress
            yield ServerSentEvent(event="progress", data=progress)
        left = end - loop.time()
        if left <= 0 or stopping.is_set():
            return
        if not events:
            await asyncio.sleep(min(LOOK, left))


def _news(shop: Workshop, after: int, job: str) -> tuple[list[Event], list[dict[str, Any]] | None]:
    """Return what happened and how far it is; nothing while the database is away."""
    try:
        return shop.desk.store.events(after, job), _progress(shop, job)
    except LedgerFailed:
        return [], None


def _numbered(event: Event) -> ServerSentEvent:
    return ServerSentEvent(event="job", id=str(event.number), data=event.model_dump(mode="json"))


def _progress(shop: Workshop, job: str) -> list[dict[str, Any]]:
    """Return how far the sheets under work are."""
    under_way = [each for each in shop.desk.jobs([*ACTIVE]) if each.begun and each.sheets]
    return [
        {"job": each.id, "sheet": shop.sheets(each)[-1].model_dump(mode="json")}
        for each in under_way
        if not job or each.id == job
    ]
