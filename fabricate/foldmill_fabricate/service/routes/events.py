"""What happens, while it happens."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent

from foldmill_fabricate.service.callers import Viewer, still
from foldmill_fabricate.service.events import Following, News, follow
from foldmill_fabricate.service.ids import EventNumber, OneJob
from foldmill_fabricate.service.routes.answers import READING, workshop
from foldmill_fabricate.service.workshop import Workshop

ROUTER = APIRouter(tags=["jobs"])
Shop = Annotated[Workshop, Depends(workshop)]
_MOST_S = 86_400.0


async def _place(
    request: Request,
    _: Viewer,
    shop: Shop,
    job: OneJob = "",
    after: Annotated[int, Query(ge=0, le=2**62, description="Number heard last.")] = 0,
    last_event_id: EventNumber = "",
) -> AsyncIterator[Following]:
    """Take a place among those who follow, before anything is answered."""
    name = (await asyncio.to_thread(shop.desk.job, job)).id if job else ""
    heard = int(last_event_id) if last_event_id else after
    news: News = request.app.state.news
    await news.enter(heard)
    try:
        yield Following(name, heard, still(request))
    finally:
        news.leave()


@ROUTER.get(
    "/events",
    responses=READING,
    response_class=EventSourceResponse,
)
async def events(
    request: Request,
    shop: Shop,
    asked: Annotated[Following, Depends(_place)],
    seconds: Annotated[float, Query(ge=0, le=_MOST_S, description="How long.")] = 3600.0,
) -> AsyncIterator[ServerSentEvent]:
    """Follow what happens to jobs, from the event after the one that was heard last on."""
    state = request.app.state
    async for event in follow(shop, state.news, asked, seconds, state.stopping):
        yield event
