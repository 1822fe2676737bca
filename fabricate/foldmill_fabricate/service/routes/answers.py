"""What every route may answer besides its own: problems, declared once."""

from __future__ import annotations

from typing import Annotated, Any, Final

from fastapi import Header, Request

from foldmill_fabricate.service.desk import Desk
from foldmill_fabricate.service.models import Problem
from foldmill_fabricate.service.planning import Plans
from foldmill_fabricate.service.problems import MEDIA_TYPE
from foldmill_fabricate.service.workshop import Workshop

_SAID = {
    400: "The request is no HTTP that can be read.",
    401: "A token is needed.",
    403: "The token does not allow this, or a page of another site has asked.",
    404: "There is no such thing.",
    405: "This method is not for this path.",
    408: "The body did not arrive in time.",
    409: "It cannot be done as things stand.",
    411: "The length of the body is not stated.",
    413: "The body is too large.",
    415: "The body's media type is none that is read.",
    421: "The service is not reached by that name.",
    422: "What was sent cannot be worked with; the detail says what, where, and what to do.",
    500: "A fault of foldmill's.",
    503: "Too much is under way; try again.",
}


Declared = Annotated[
    str,
    Header(max_length=20, description="1. Without it only a body of application/json is taken."),
]
"""The header of ours that an upload needs which is no JSON: a browser asks before it sends it."""


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Return the declaration of these answers, for ``responses`` of a router or route."""
    schema = {"$ref": f"#/components/schemas/{Problem.__name__}"}
    content = {MEDIA_TYPE: {"schema": schema}}
    return {status: {"description": _SAID[status], "content": content} for status in statuses}


READING: Final = problems(400, 401, 403, 404, 405, 421, 422, 500, 503)
"""What a route may answer that changes nothing."""
CHANGING: Final = READING | problems(408, 409, 411, 413, 415)
"""What a route may answer that takes a body."""


def binary(media_type: str, about: str) -> dict[int | str, dict[str, Any]]:
    """Return the declaration of a file as an answer, whole or a part of it."""
    content = {media_type: {"schema": {"type": "string", "format": "binary"}}}
    return {
        200: {"description": about, "content": content},
        206: {"description": "A part of it, as Range asks.", "content": content},
        416: {"description": "Range asks for what is beyond its end."},
    }


def desk(request: Request) -> Desk:
    """Return the application's desk."""
    found: Desk = request.app.state.desk
    return found


def plans(request: Request) -> Plans:
    """Return the application's plans."""
    found: Plans = request.app.state.plans
    return found


def workshop(request: Request) -> Workshop:
    """Return the application's jobs."""
    found: Workshop = request.app.state.workshop
    return found
