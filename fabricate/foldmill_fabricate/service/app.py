"""The application: routes, guard, errors, and what lives as long as it does."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.metadata import version
from pathlib import Path

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from foldmill import installed
from foldmill_fabricate.service import problems
from foldmill_fabricate.service.desk import WORK, Desk
from foldmill_fabricate.service.logs import PREFIX, Watch
from foldmill_fabricate.service.metrics import Metrics, computing
from foldmill_fabricate.service.models import Problem
from foldmill_fabricate.service.planning import Plans
from foldmill_fabricate.service.reach import state_folder
from foldmill_fabricate.service.routes import catalogue, health, patterns, plans
from foldmill_fabricate.service.sandbox import Sandbox
from foldmill_fabricate.service.security import Guard, Policy
from foldmill_fabricate.service.storage import Storage

ABOUT = """From an origami design to a sheet that a cutting plotter scores on both faces.

Lengths in mm, angles in degrees, times in s. Errors are `application/problem+json`; their detail
is a sentence for people. Whatever changes something is sent as JSON."""


def create(
    folder: Path | None = None, policy: Policy | None = None, sandbox: Sandbox | None = None
) -> FastAPI:
    """Return the application.

    folder : where it keeps its things, by default the user's. policy : who is let in, by default
    this computer alone. sandbox : by default one of its own, which ends with it.
    """
    app = FastAPI(
        title="foldmill",
        version=version("foldmill"),
        description=ABOUT,
        lifespan=_lifespan,
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,  # its page loads scripts from elsewhere
        redoc_url=None,
    )
    storage = Storage(folder or state_folder())
    app.state.policy = policy or Policy()
    app.state.desk = Desk(storage, sandbox or Sandbox(storage.scratch, [WORK]))
    app.state.plans = Plans(app.state.desk)
    app.state.stopping = asyncio.Event()
    app.state.metrics = Metrics()
    app.state.metrics.ask(computing(lambda: app.state.desk.sandbox.load))
    for router in (catalogue.ROUTER, patterns.ROUTER, plans.ROUTER):
        app.include_router(router, prefix=PREFIX)
    app.include_router(health.ROUTER)
    problems.add_to(app)
    app.add_middleware(Guard, policy=app.state.policy)
    app.add_middleware(Watch, metrics=app.state.metrics)
    app.openapi = lambda: _openapi(app)  # type: ignore[method-assign]
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    desk: Desk = app.state.desk
    desk.sandbox.start()
    await asyncio.to_thread(installed)
    try:
        yield
    finally:
        app.state.stopping.set()
        await app.state.plans.finish()
        await asyncio.to_thread(desk.sandbox.close)


def _openapi(app: FastAPI) -> dict[str, object]:
    """Return the description of all routes, with the form of a problem among the schemas."""
    if app.openapi_schema is None:
        made = get_openapi(
            title=app.title, version=app.version, description=ABOUT, routes=app.routes
        )
        schemas = made.setdefault("components", {}).setdefault("schemas", {})
        schemas["Problem"] = Problem.model_json_schema()
        for unused in ("HTTPValidationError", "ValidationError"):
            schemas.pop(unused, None)
        app.openapi_schema = made
    return app.openapi_schema
