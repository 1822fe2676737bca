"""What happens, while it happens."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent

from foldmill_fabricate.service.callers import Viewer
from foldmill_fabricate.service.events import Followers, follow
from foldmill_fabricate.service.ids import EventNumber, OneJob
from foldmill_fabricate.service.routes.answers import READING, workshop
from foldmill_fabricate.service.workshop import Workshop

ROUTER = APIRouter(tags=["jobs"])
Shop = Annotated[Workshop, Depends(workshop)]
_MOST_S = 86_400.0


async def _place(request: Request, _: Viewer, shop: Shop, job: OneJob = "") -> AsyncIterator[str]:
    """Take a place among those who follow, before anything is answered; give the job's id."""
    name = (await asyncio.to_thread(shop.desk.job, job)).id if job else ""
    followers: Followers = request.app.state.followers
    followers.enter()
    try:
        yield name
    finally:
        followers.leave()


@ROUTER.get(
    "/events",
    responses=READING,
    response_class=EventSourceResponse,
)
async def events(
    request: Request,
    shop: Shop,
    job: Annotated[str, Depends(_place)],
    after: Annotated[int, Query(ge=0, le=2**62, description="Number heard last.")] = 0,
    seconds: Annotated[float, Query(ge=0, le=_MOST_S, description="How long.")] = 3600.0,
    last_event_id: EventNumber = "",
) -> AsyncIterator[ServerSentEvent]:
    """Follow what happens to jobs, from the event after the one that was heard last on."""
    heard = int(last_event_id) if last_event_id else after
    async for event in follow(shop, heard, job, seconds, request.app.state.stopping):
        yield event
