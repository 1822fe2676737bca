"""Who is let in, before any route is looked at: a web page must not be able to start a cut.

A browser sends whatever a page of some other site asks it to. So, on every address: the host that
a request names must be ours (a stranger's name may be made to lead here), an origin that it names
must be the same, and what changes anything must be JSON, or a declared upload with a header of
ours: a browser asks before it sends either for another site, and nobody here answers that it may.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from ipaddress import ip_address

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from foldmill_fabricate.service import problems
from foldmill_fabricate.service.bounds import MOST_DRAWING, MOST_JSON, MOST_UPLOAD
from foldmill_fabricate.service.patience import InTime
from foldmill_fabricate.service.problems import Forbidden, TooLarge
from foldmill_fabricate.service.tokens import Tokens
from foldmill_fabricate.service.ways import Ways

UPLOADS = {
    "/api/v1/patterns": MOST_UPLOAD,
    "/api/v1/plans/kept": MOST_UPLOAD,
    "/api/v1/plans/drawn": MOST_DRAWING,
}
"""The paths that take more than a request of JSON, and how many bytes."""
CUSTOM = "x-foldmill"
"""A header of ours, which no page of another site can send without asking."""
UPLOAD_TYPE = "application/octet-stream"
"""Media type of uploads that are no JSON."""
_HOST = re.compile(r"(\[(?P<six>[0-9A-Fa-f:.]+)\]|(?P<name>[^\[\]:/@\s]+))(:[0-9]{1,5})?")
_LOCAL = frozenset({"127.0.0.1", "localhost", "::1"})
_EVERY = frozenset({"0.0.0.0", "::"})
"""Addresses that stand for all of a computer's, those that only it reaches among them."""
_SAFE = frozenset({"GET", "HEAD", "OPTIONS"})


@dataclass(frozen=True)
class Policy:
    """Under which address a service is reached, and who may use it."""

    host: str = "127.0.0.1"
    names: tuple[str, ...] = ()
    """Other names it is reached by, such as that of a proxy; as ``plain_name`` returns them."""
    tokens: Tokens | None = field(default=None, compare=False)
    """Which tokens count; None where none is asked for."""

    def knows(self, host: str) -> bool:
        """Tell whether a request may name this host, written with or without a port."""
        name = plain_name(host)
        if name in {self.host, *self.names} or (self._is_reached_here and name in _LOCAL):
            return True
        anywhere = self.host in _EVERY and not self.names
        return anywhere and bool(name) and self.tokens is not None

    @property
    def _is_reached_here(self) -> bool:
        """Whether this computer's own names lead to it, which no stranger can make lead here."""
        return self.host in _EVERY or is_local(self.host)


def is_local(host: str) -> bool:
    """Tell whether an address is reached from this computer alone."""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def plain_name(host: str) -> str:
    """Return the name in a Host header, small, without port or last dot; empty where it is none."""
    found = _HOST.fullmatch(host)
    return (found["six"] or found["name"].removesuffix(".")).lower() if found else ""


class Guard:
    """Refuses what must not be let in, before the application sees it."""

    def __init__(self, app: ASGIApp, policy: Policy, ways: Ways) -> None:
        self._app, self._policy, self._ways = app, policy, ways

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or answer with a problem."""
        if scope["type"] == "http":
            try:
                self._judge(scope["method"], scope["path"], Headers(scope=scope))
            except (Forbidden, TooLarge) as error:
                await problems.of(error)(scope, receive, send)
                return
            if scope["method"] not in _SAFE:
                receive = InTime(receive)
        elif scope["type"] == "websocket":
            return  # there are none
        await self._app(scope, receive, send)

    def _judge(self, method: str, path: str, headers: Headers) -> None:
        """Raise Forbidden or TooLarge."""
        host = headers.get("host", "")
        if not self._policy.knows(host):
            raise Forbidden(
                f"This service is not reached by the name {host[:80]!r}. Use the address that it "
                "told when it started, or let it start with --name.",
                421,
            )
        _refuse_foreign(method, host, headers)
        if method not in _SAFE:
            _refuse_large(path, headers)
            if method in self._ways.methods(path):  # any other is told that it is not for the path
                _refuse_simple(headers)


def _refuse_foreign(method: str, host: str, headers: Mapping[str, str]) -> None:
    """Raise Forbidden for what the page of another site has sent."""
    origin = headers.get("origin")
    if origin is not None and origin.lower() not in {f"http://{host}", f"https://{host}"}:
        raise Forbidden(f"A page of {origin[:80]} may not use this service; use its own client.")
    if method not in _SAFE and headers.get("sec-fetch-site") in {"cross-site", "same-site"}:
        raise Forbidden("A page of another site may not change anything here.")


def _refuse_simple(headers: Mapping[str, str]) -> None:
    """Raise Forbidden for a body that a browser sends for another site without asking."""
    kind = headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind == "application/json":
        return
    if kind == UPLOAD_TYPE and CUSTOM in headers:
        return
    raise Forbidden(
        f"The body is {kind or 'of no stated type'}; send application/json, or an upload as "
        f"{UPLOAD_TYPE} with the header X-Foldmill: 1.",
        415,
    )


def _refuse_large(path: str, headers: Mapping[str, str]) -> None:
    """Raise for a body that is larger than what is read, before any of it is read."""
    if "transfer-encoding" in headers:
        raise Forbidden("Say how long the body is, by Content-Length.", 411)
    length, most = headers.get("content-length", "0"), UPLOADS.get(path, MOST_JSON)
    if not length.isdecimal() or int(length) > most:
        raise TooLarge(
            f"The body has {length[:20]} bytes; at most {most:,} are read here. Leave out what is "
            "not needed."
        )
