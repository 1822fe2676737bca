"""Patterns: made from a design, or uploaded; looked at, drawn and checked."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi.responses import FileResponse
from starlette.requests import ClientDisconnect

from foldmill_fabricate.service.callers import Submitter, Viewer
from foldmill_fabricate.service.desk import DRAWINGS, PATTERN, Desk
from foldmill_fabricate.service.models import DesignRequest, Digest, Pattern, Report
from foldmill_fabricate.service.problems import Forbidden, TooLarge
from foldmill_fabricate.service.routes.answers import CHANGING, READING, binary, desk, problems
from foldmill_fabricate.service.security import MOST_UPLOAD, UPLOAD_TYPE

ROUTER = APIRouter(tags=["patterns"])
At = Annotated[Desk, Depends(desk)]
Form = Literal["fold"]
"""What can be uploaded."""
Drawing = Literal["pattern.svg", "pattern.png", "folded.glb", "folded.stl", "folded.obj"]
_PATIENCE = 60.0
"""s for a body to arrive."""
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


@ROUTER.post("/patterns", status_code=201, responses=CHANGING | problems(408), openapi_extra=_BODY)
async def upload(
    request: Request,
    at: At,
    _: Submitter,
    response: Response,
    form: Annotated[Form, Query(description="What the file is.")] = "fold",
    planarise: Annotated[bool, Query(description="Mend lines that cross.")] = False,
) -> Pattern:
    """Upload a pattern: the body is the file, as JSON or as application/octet-stream."""
    async with at.folder() as folder:
        with (folder / "upload").open("wb") as file:
            await _receive(request, file)
        return _made(await at.read(folder, form, planarise), response)


@ROUTER.get("/patterns", responses=READING)
def patterns(at: At, _: Viewer) -> list[Pattern]:
    """List the patterns that are kept."""
    return [Pattern.model_validate(about) for about in at.storage.patterns()]


@ROUTER.get("/patterns/{pattern}", responses=READING)
def pattern(pattern: Digest, at: At, _: Viewer) -> Pattern:
    """Tell what is known of a pattern."""
    return at.pattern(pattern)


@ROUTER.get("/patterns/{pattern}/check", responses=READING)
async def check(pattern: Digest, at: At, _: Viewer) -> Report:
    """Check that a pattern folds: developable, planar, isometric, free of penetration."""
    return await at.check(pattern)


@ROUTER.get(
    "/patterns/{pattern}/pattern.fold",
    responses=READING | binary("application/json", "The FOLD file."),
    response_class=FileResponse,
)
def fold(pattern: Digest, at: At, _: Viewer) -> FileResponse:
    """Get the FOLD file of a pattern."""
    return FileResponse(at.storage.pattern(pattern) / PATTERN, media_type="application/json")


@ROUTER.get(
    "/patterns/{pattern}/drawings/{name}",
    responses=READING | binary("application/octet-stream", "The drawing, as its name says."),
    response_class=FileResponse,
)
async def drawing(pattern: Digest, name: Drawing, at: At, _: Viewer) -> FileResponse:
    """Get a drawing of a pattern, or a mesh of its folded form."""
    return FileResponse(await at.drawing(pattern, name), media_type=DRAWINGS[name])


def _made(pattern: Pattern, response: Response) -> Pattern:
    response.headers["location"] = f"/api/v1/patterns/{pattern.id}"
    return pattern


async def _receive(request: Request, file: Any) -> None:
    """Write a body into a file as it arrives; raises TooLarge, or Forbidden where it stalls."""
    count = 0
    try:
        async with asyncio.timeout(_PATIENCE):
            async for part in request.stream():
                count += len(part)
                if count > MOST_UPLOAD:
                    raise TooLarge(f"The file is larger than {MOST_UPLOAD:,} bytes.")
                file.write(part)
    except TimeoutError:
        raise Forbidden(f"The file had not arrived after {_PATIENCE:g} s.", 408) from None
    except ClientDisconnect:
        raise Forbidden("The file was cut off on its way.", 400) from None
