"""Errors as ``application/problem+json`` (RFC 9457), with the sentences that a terminal shows.

What foldmill raises on purpose keeps its sentence; what it did not foresee says that it is our
fault and goes to the log, never to who asked.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from foldmill.errors import FoldmillError, PluginFault
from foldmill.refusals import sentence_of
from foldmill_fabricate.jobs.errors import JobRefused, NoSuchJob
from foldmill_fabricate.plotter.errors import LedgerRefused, PlotterError
from foldmill_fabricate.service.ids import SPELLED
from foldmill_fabricate.service.models import Problem
from foldmill_fabricate.service.sandbox import Refused, SandboxFailed
from foldmill_fabricate.service.urns import dashed, urn
from foldmill_fabricate.space import DiskFull, is_full, keeping

MEDIA_TYPE = "application/problem+json"
LOG = logging.getLogger("foldmill.service")
_STATUS: dict[str, int] = {"TooBusy": 503, "SandboxFailed": 500, "PluginFault": 500}
_OURS = "This is a fault of foldmill's, and nothing was done. Tell who runs this service."


class NoSuch(FoldmillError, LookupError):
    """An id that nothing is kept under."""


class Forbidden(FoldmillError, PermissionError):
    """A request that is not allowed; ``status`` is the one of HTTP."""

    def __init__(self, message: str, status: int = 403) -> None:
        super().__init__(message)
        self.status = status


class TooLarge(FoldmillError, ValueError):
    """A request body of more bytes than are read."""


def register(kind: type[FoldmillError], status: int) -> None:
    """Let a kind of error answer with a status of HTTP; without, it is 422."""
    _STATUS[kind.__name__] = status


register(NoSuch, 404)
register(NoSuchJob, 404)
register(JobRefused, 409)
register(LedgerRefused, 409)
register(PlotterError, 503)
register(DiskFull, 503)
register(TooLarge, 413)


def problem(status: int, detail: str, kind: str = "", **more: Any) -> JSONResponse:
    """Return an error as a response; ``kind`` : the name of a class, such as CannotPlan."""
    headers = {"retry-after": "10"} if status == 503 else {}
    if status == 401:
        headers["www-authenticate"] = 'Bearer realm="foldmill"'
    told = Problem(
        type=urn(kind) if kind else "about:blank",
        title=_words(kind) if kind else HTTPStatus(status).phrase,
        status=status,
        detail=detail,
        **more,
    )
    return JSONResponse(told.model_dump(), status, headers=headers, media_type=MEDIA_TYPE)


def status_of(error: FoldmillError) -> int:
    """Return the status of HTTP that an error answers with."""
    if isinstance(error, Forbidden):
        return error.status
    kind = error.kind if isinstance(error, Refused) else type(error).__name__
    known = {kind: None, **{each.__name__: None for each in type(error).__mro__}}
    return next((_STATUS[name] for name in known if name in _STATUS), 422)


def of(error: FoldmillError) -> JSONResponse:
    """Return one of our own errors as a response, with its sentence."""
    kind = error.kind if isinstance(error, Refused) else type(error).__name__
    if isinstance(error, SandboxFailed | PluginFault):
        LOG.error("%s", error, extra={"log": getattr(error, "log", "")})
    return problem(status_of(error), str(error), kind)


def add_to(app: FastAPI) -> None:
    """Let an application answer every error like this."""
    app.add_exception_handler(FoldmillError, _foldmill)
    app.add_exception_handler(OSError, _disk)
    app.add_exception_handler(RequestValidationError, _validation)
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(Exception, _unforeseen)


async def _foldmill(_request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, FoldmillError)
    return of(error)


async def _disk(request: Request, error: Exception) -> JSONResponse:
    """Tell of a disk that is full; whatever else an operating system refuses is not foreseen."""
    if not is_full(error):
        raise error
    try:
        with keeping(request.app.state.desk.storage.folder):
            raise error
    except DiskFull as full:
        LOG.error("%s", full)
        return of(full)


async def _validation(_request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    faults = [_fault(each) for each in error.errors()]
    return problem(422, " ".join(faults[:10]), "InvalidRequest")


def _fault(fault: Mapping[str, Any]) -> str:
    """Return the sentence of one fault of a request; its place begins after body, path or query."""
    if fault["type"] == "json_invalid":
        return f"The body is no JSON: {fault.get('ctx', {}).get('error', 'it cannot be read')}."
    where, *place = fault["loc"]
    if place:
        return sentence_of({**fault, "loc": tuple(place)}, SPELLED)
    if fault["type"] == "missing":
        return f"The {where} is missing: send a JSON object."
    return f"The {sentence_of(fault)}"


async def _http(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    said = {
        404: f"There is nothing at {request.url.path}; GET /api/v1/openapi.json tells what is.",
        405: f"{request.method} is not for {request.url.path}.",
        400: "The request is no HTTP that can be read, or its body no JSON in UTF-8.",
    }
    answer = problem(error.status_code, said.get(error.status_code, str(error.detail)))
    answer.headers.update(error.headers or {})
    if error.status_code == 405 and (known := request.app.state.ways.methods(request.url.path)):
        answer.headers["allow"] = ", ".join(known)  # what was met first knows its own method only
    return answer


async def _unforeseen(request: Request, error: Exception) -> JSONResponse:
    LOG.error("%s %s failed", request.method, request.url.path, exc_info=error)
    return problem(500, _OURS, "Fault")


def _words(kind: str) -> str:
    return dashed(kind).replace("-", " ").capitalize()
