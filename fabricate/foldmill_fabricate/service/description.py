"""The description of the API that programs read: OpenAPI, made once, beside the event loop."""

from __future__ import annotations

from importlib.metadata import version
from threading import Lock
from typing import Any

from fastapi import APIRouter, FastAPI, Request
from fastapi.openapi.utils import get_openapi
from fastapi.responses import JSONResponse

from foldmill_fabricate.service.models import Problem

ABOUT = """From an origami design to a sheet that a cutting plotter scores on both faces.

Lengths in mm, angles in degrees, times in s. Errors are `application/problem+json`; their detail
is a sentence for people. Whatever changes something is sent as JSON."""
ROUTER = APIRouter(include_in_schema=False)
_MAKING = Lock()


@ROUTER.get("/openapi.json")
def openapi(request: Request) -> JSONResponse:
    """Describe all routes. Making it takes a tenth of a second, so this runs in a thread."""
    return JSONResponse(described(request.app))


def described(app: FastAPI) -> dict[str, Any]:
    """Return the description of all routes, with the form of a problem among the schemas."""
    with _MAKING:
        if app.openapi_schema is None:
            app.openapi_schema = _made(app)
        return app.openapi_schema


def _made(app: FastAPI) -> dict[str, Any]:
    made = get_openapi(
        title=app.title, version=version("foldmill"), description=ABOUT, routes=app.routes
    )
    schemas = made.setdefault("components", {}).setdefault("schemas", {})
    schemas["Problem"] = Problem.model_json_schema()
    for unused in ("HTTPValidationError", "ValidationError"):
        schemas.pop(unused, None)
    return made
