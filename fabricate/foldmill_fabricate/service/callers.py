"""Whose request it is, and what that person may do: dependencies of routes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, NamedTuple

from fastapi import Depends, Request, Security
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from foldmill.errors import UnreadableFile
from foldmill_fabricate.service.problems import Forbidden
from foldmill_fabricate.service.security import Policy
from foldmill_fabricate.service.tokens import Scope

BEARER = HTTPBearer(
    auto_error=False,
    description="A token of `foldmill serve --new-token`; on 127.0.0.1 none is needed.",
)
_Credentials = Annotated[HTTPAuthorizationCredentials | None, Security(BEARER)]


class Caller(NamedTuple):
    """Whoever sent a request."""

    name: str
    """The token's; empty for whoever is at this computer."""
    scope: Scope


def caller(request: Request, credentials: _Credentials) -> Caller:
    """Return who sends a request; raises Forbidden where a token is needed and is none."""
    policy: Policy = request.app.state.policy
    if policy.tokens is None:
        return Caller("", Scope.OPERATE)
    found = policy.tokens.find(credentials.credentials) if credentials else None
    if found is None:
        raise Forbidden(
            "This service wants a token, as Authorization: Bearer …; who runs it makes one with "
            "foldmill serve --new-token NAME.",
            401,
        )
    request.state.who, request.state.token = found.name, found
    return Caller(found.name, found.scope)


Anyone = Annotated[Caller, Depends(caller)]


def still(request: Request) -> Callable[[], bool]:
    """Return how to ask whether whoever sent a request, and was let in, would be now."""
    tokens, token = request.app.state.policy.tokens, getattr(request.state, "token", None)

    def counts() -> bool:
        try:
            return tokens is None or token in tokens.every
        except UnreadableFile:
            return False

    return counts


def _require(who: Caller, wanted: Scope) -> Caller:
    if not who.scope.allows(wanted):
        raise Forbidden(
            f"The token {who.name!r} allows to {who.scope.value}, and this needs {wanted.value}. "
            "Ask who runs the service for another."
        )
    return who


def _submitter(who: Anyone) -> Caller:
    return _require(who, Scope.SUBMIT)


def _operator(who: Anyone) -> Caller:
    return _require(who, Scope.OPERATE)


Viewer = Anyone
Submitter = Annotated[Caller, Depends(_submitter)]
Operator = Annotated[Caller, Depends(_operator)]
