"""Patterns: made from a design, or uploaded; looked at, drawn and checked."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.responses import FileResponse

from foldmill_fabricate.service.callers import Submitter, Viewer
from foldmill_fabricate.service.desk import DRAWINGS, Desk
from foldmill_fabricate.service.ids import PatternId
from foldmill_fabricate.service.models import (
    DesignRequest,
    Pattern,
    Report,
    Upload,
)
from foldmill_fabricate.service.names import PATTERN
from foldmill_fabricate.service.receiving import receive
from foldmill_fabricate.service.routes.answers import (
    CHANGING,
    READING,
    Declared,
    binary,
    desk,
)
from foldmill_fabricate.service.security import UPLOAD_TYPE

ROUTER = APIRouter(tags=["patterns"])
At = Annotated[Desk, Depends(desk)]
Drawing = Literal["pattern.svg", "pattern.png", "folded.glb", "folded.stl", "folded.obj"]
_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            "application/json": {"schema": {"type": "object", "title": "FOLD"}},
            UPLOAD_TYPE: {"schema": {"type": "string", "format": "binary"}},
        },
    }
}


@ROUTER.post("/designs", status_code=201, responses=CHANGING)
async def design(request: DesignRequest, at: At, _: Submitter, response: Response) -> Pattern:
    """Make a design; its pattern is kept."""
    return _made(await at.design(request), response)


@ROUTER.post("/patterns", status_code=201, responses=CHANGING, openapi_extra=_BODY)
async def upload(
    request: Request,
    at: At,
    _: Submitter,
    response: Response,
    said: Annotated[Upload, Query()],
    x_foldmill: Declared = "",  # noqa: ARG001 - looked at before any route is
) -> Pattern:
    """Upload a pattern: the body is the file, as JSON or as application/octet-stream."""
    async with at.folder() as folder:
        await receive(request, folder)
        return _made(await at.read(folder, said), response)


@ROUTER.get("/patterns", responses=READING)
def patterns(at: At, _: Viewer) -> list[Pattern]:
    """List the patterns that are kept."""
    return [Pattern.model_validate(about) for about in at.storage.patterns()]


@ROUTER.get("/patterns/{pattern}", responses=READING)
def pattern(pattern: PatternId, at: At, _: Viewer) -> Pattern:
    """Tell what is known of a pattern."""
    return at.pattern(pattern)


@ROUTER.get("/patterns/{pattern}/check", responses=READING)
async def check(pattern: PatternId, at: At, _: Viewer) -> Report:
    """Check that a pattern folds: developable, planar, isometric, free of penetration."""
    return await at.check(pattern)


@ROUTER.get(
    "/patterns/{pattern}/pattern.fold",
    responses=READING | binary("application/json", "The FOLD file."),
    response_class=FileResponse,
)
def fold(pattern: PatternId, at: At, _: Viewer) -> FileResponse:
    """Get the FOLD file of a pattern."""
    return FileResponse(at.storage.pattern(pattern) / PATTERN, media_type="application/json")


@ROUTER.get(
    "/patterns/{pattern}/drawings/{name}",
    responses=READING | binary("application/octet-stream", "The drawing, as its name says."),
    response_class=FileResponse,
)
async def drawing(pattern: PatternId, name: Drawing, at: At, _: Viewer) -> FileResponse:
    """Get a drawing of a pattern, or a mesh of its folded form."""
    return FileResponse(await at.drawing(pattern, name), media_type=DRAWINGS[name])


def _made(pattern: Pattern, response: Response) -> Pattern:
    response.headers["location"] = f"/api/v1/patterns/{pattern.id}"
    return pattern
