"""Whether it works, and how much: for whoever watches it."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from foldmill_fabricate.service.callers import Viewer
from foldmill_fabricate.service.metrics import MEDIA_TYPE, Metrics
from foldmill_fabricate.service.models import Health
from foldmill_fabricate.service.routes.answers import problems

ROUTER = APIRouter(tags=["watch"])


@ROUTER.get(
    "/healthz",
    responses={503: {"model": Health, "description": "It cannot work."}, **problems(400, 405, 421)},
)
async def healthz(request: Request, response: Response) -> Health:
    """Tell whether the service can work; this needs no token."""
    state = request.app.state
    computing, waiting = state.desk.sandbox.load
    ok = not state.stopping.is_set()
    response.status_code = 200 if ok else 503
    return Health(ok=ok, computing=computing, waiting=waiting)


@ROUTER.get(
    "/metrics",
    response_class=Response,
    responses={
        200: {"content": {"text/plain": {"schema": {"type": "string"}}}},
        **problems(400, 401, 403, 405, 421),
    },
)
def metrics(request: Request, _: Viewer) -> Response:
    """Tell the figures that Prometheus collects."""
    figures: Metrics = request.app.state.metrics
    return Response(figures.text(), headers={"content-type": MEDIA_TYPE})
