"""The application: routes, guard, errors, and what lives as long as it does."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.metadata import version

from fastapi import FastAPI

from foldmill import installed
from foldmill_fabricate.service import description, problems
from foldmill_fabricate.service.desk import WORK, Desk
from foldmill_fabricate.service.events import News
from foldmill_fabricate.service.logs import PREFIX, Watch
from foldmill_fabricate.service.metrics import Metrics, computing
from foldmill_fabricate.service.planning import Plans
from foldmill_fabricate.service.retention import Retention
from foldmill_fabricate.service.routes import catalogue, events, health, jobs, patterns, plans
from foldmill_fabricate.service.sandbox import Sandbox
from foldmill_fabricate.service.security import Guard, Policy
from foldmill_fabricate.service.storage import Storage
from foldmill_fabricate.service.warming import warm
from foldmill_fabricate.service.ways import Ways
from foldmill_fabricate.service.workshop import Workshop

ROUTERS = (
    catalogue.ROUTER,
    patterns.ROUTER,
    plans.ROUTER,
    jobs.ROUTER,
    events.ROUTER,
    description.ROUTER,
)


def create(
    workshop: Workshop, policy: Policy | None = None, sandbox: Sandbox | None = None
) -> FastAPI:
    """Return the application.

    workshop : its jobs, and where it keeps its things; it starts and ends with the application.
    policy : who is let in, by default this computer alone. sandbox : by default one of its own.
    """
    app = FastAPI(
        title="foldmill",
        version=version("foldmill"),
        description=description.ABOUT,
        lifespan=_lifespan,
        openapi_url=None,  # a route of ours, which does not hold up the others
        docs_url=None,  # its page loads scripts from elsewhere
        redoc_url=None,
    )
    _furnish(app, workshop, policy or Policy(), sandbox)
    for router in ROUTERS:
        app.include_router(router, prefix=PREFIX)
    app.include_router(health.ROUTER)
    app.state.ways = Ways({PREFIX: ROUTERS, "": (health.ROUTER,)})
    problems.add_to(app)
    app.add_middleware(Guard, policy=app.state.policy, ways=app.state.ways)
    app.add_middleware(Watch, metrics=app.state.metrics)
    return app


def _furnish(app: FastAPI, workshop: Workshop, policy: Policy, sandbox: Sandbox | None) -> None:
    """Give the application what its routes use."""
    storage = Storage(workshop.places.root / "service", workshop.places.keep_days)
    desk = Desk(storage, sandbox or Sandbox(storage.scratch, [WORK]))
    app.state.policy, app.state.workshop, app.state.desk = policy, workshop, desk
    app.state.plans = Plans(desk, workshop.desk.plans)
    app.state.retention = Retention(storage, workshop.desk)
    app.state.stopping = asyncio.Event()
    app.state.news = News(workshop, app.state.stopping)
    app.state.metrics = Metrics()
    app.state.metrics.ask(computing(lambda: desk.sandbox.load))
    app.state.metrics.ask(workshop.gauges.collect)


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    desk: Desk = app.state.desk
    workshop: Workshop = app.state.workshop
    desk.sandbox.start()
    try:
        await asyncio.to_thread(installed)
        await asyncio.to_thread(workshop.start)
        await warm(app)
        throwing_away = asyncio.create_task(app.state.retention.run())
        try:
            yield
        finally:
            throwing_away.cancel()
    finally:
        app.state.stopping.set()
        await asyncio.to_thread(workshop.close)
        await app.state.plans.finish()
        await asyncio.to_thread(desk.sandbox.close)
