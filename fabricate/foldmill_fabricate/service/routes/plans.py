"""Plans: asked for, waited for, their files."""

from __future__ import annotations

import asyncio
from mimetypes import guess_type
from typing import Annotated, Any

from fastapi import APIRouter, Depends, HTTPException, Path, Query, Request, Response
from fastapi.responses import FileResponse

from foldmill_fabricate.foreign import Asked
from foldmill_fabricate.service.bounds import MOST_DRAWING
from foldmill_fabricate.service.callers import Submitter, Viewer
from foldmill_fabricate.service.desk import Desk
from foldmill_fabricate.service.ids import PlanId
from foldmill_fabricate.service.models import (
    KeptPlan,
    PlanRequest,
    PlanState,
    PlanStatus,
    Verification,
)
from foldmill_fabricate.service.planning import Plans
from foldmill_fabricate.service.receiving import receive
from foldmill_fabricate.service.routes.answers import (
    CHANGING,
    READING,
    Declared,
    binary,
    desk,
    plans,
)
from foldmill_fabricate.service.security import UPLOAD_TYPE

ROUTER = APIRouter(prefix="/plans", tags=["plans"])
Those = Annotated[Plans, Depends(plans)]
_ACCEPTED: dict[int | str, dict[str, Any]] = {
    202: {"model": PlanStatus, "description": "It is being made; ask for it again."}
}
_FILE: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {UPLOAD_TYPE: {"schema": {"type": "string", "format": "binary"}}},
    }
}


@ROUTER.post("", status_code=200, responses=CHANGING | _ACCEPTED)
async def begin(request: PlanRequest, those: Those, _: Submitter, response: Response) -> PlanStatus:
    """Plan a sheet. The same request gives the same plan, and makes it once."""
    status = await those.begin(request)
    response.headers["location"] = f"/api/v1/plans/{status.id}"
    response.status_code = 202 if status.state is PlanState.WAITING else 200
    return status


@ROUTER.post("/kept", status_code=201, responses=CHANGING, openapi_extra=_FILE)
async def keep(
    request: Request,
    those: Those,
    at: Annotated[Desk, Depends(desk)],
    _: Submitter,
    x_foldmill: Declared,  # noqa: ARG001 - looked at before any route is
) -> KeptPlan:
    """Keep a job folder that was planned elsewhere: the body is a ZIP file of it.

    It is verified as a whole; one that is not what it says is refused.
    """
    async with at.folder() as folder:
        await receive(request, folder)
        return await those.keep(folder)


@ROUTER.post("/drawn", status_code=201, responses=CHANGING, openapi_extra=_FILE)
async def draw(
    request: Request,
    those: Those,
    at: Annotated[Desk, Depends(desk)],
    _: Submitter,
    asked: Annotated[Asked, Query()],
    x_foldmill: Declared,  # noqa: ARG001 - looked at before any route is
) -> KeptPlan:
    """Plan an HP-GL drawing from elsewhere: the body is the file, and no byte of it is sent on.

    It is read by a list of what is followed, checked against the machine's limits, written anew by
    our own writers and verified.
    """
    async with at.folder() as folder:
        await receive(request, folder, MOST_DRAWING)
        return await those.draw(folder, asked)


@ROUTER.get("/kept", include_in_schema=False)
@ROUTER.get("/drawn", include_in_schema=False)
def no_plan() -> None:
    """Say that this is no plan's id; without, it would be looked at as one."""
    raise HTTPException(405)


@ROUTER.get("", responses=READING)
def every(those: Those, _: Viewer) -> list[PlanStatus]:
    """List the plans that are kept."""
    return those.every()


@ROUTER.get("/{plan}", responses=READING)
def status(plan: PlanId, those: Those, _: Viewer) -> PlanStatus:
    """Tell how a plan stands, and of one that is done what it is."""
    return those.status(plan)


@ROUTER.get("/{plan}/verification", responses=READING)
async def verification(
    plan: PlanId, those: Those, at: Annotated[Desk, Depends(desk)], _: Viewer
) -> Verification:
    """Replay the programs of a plan on a virtual sheet, and derive the plan again."""
    return await at.verify(plan, await asyncio.to_thread(those.job, plan))


@ROUTER.get(
    "/{plan}/files/{name}",
    responses=READING | binary("application/octet-stream", "The file, as its name says."),
    response_class=FileResponse,
)
def file(
    plan: PlanId,
    name: Annotated[str, Path(max_length=200, description="As the plan's files tell it.")],
    those: Those,
    _: Viewer,
) -> FileResponse:
    """Get a program, a drawing, the job sheet, plan.json or pattern.fold."""
    found = those.file(plan, name)
    kind = guess_type(found.name)[0] or "application/octet-stream"
    return FileResponse(found, media_type=kind, filename=found.name)
