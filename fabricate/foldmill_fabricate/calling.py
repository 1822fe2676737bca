"""A line to a service: what is asked over HTTP, and its refusals as the errors they are."""

from __future__ import annotations

from collections.abc import Mapping
from types import TracebackType
from typing import Any, Self, TypeVar

import httpx

from foldmill_fabricate.service import answers
from foldmill_fabricate.service.answers import Unreachable
from foldmill_fabricate.service.reach import reached

T = TypeVar("T")
PREFIX = "/api/v1"
UPLOAD = {"content-type": "application/octet-stream", "x-foldmill": "1"}


class Calling:
    """A line to a service, at an address.

    url : by default where this user's service says it is. token : as ``foldmill serve --new-token``
    told it. seconds : how long an answer may take. Raises Unreachable where no service runs,
    InvalidInput for what is no address or no token.
    """

    def __init__(self, url: str = "", token: str = "", seconds: float = 120.0) -> None:
        found = url or reached()
        if found is None:
            raise Unreachable("No service runs here; start one with foldmill serve.")
        self.url = answers.address(found)
        self._http = httpx.Client(
            base_url=self.url,
            headers=answers.bearer(token),
            timeout=seconds,
            limits=httpx.Limits(max_keepalive_connections=0),  # a service may end in between
            trust_env=False,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the connection."""
        self._http.close()

    def _get(self, kind: type[T], path: str, asked: Mapping[str, Any] | None = None) -> T:
        return self._read(kind, self._answered("GET", path, params=asked))

    def _bytes(self, path: str) -> bytes:
        return self._answered("GET", path).content

    def _post(self, kind: type[T], path: str, body: Any) -> T:
        return self._read(kind, self._answered("POST", path, json=body))

    def _send(self, kind: type[T], path: str, content: bytes, asked: Mapping[str, Any]) -> T:
        answer = self._answered("POST", path, content=content, headers=UPLOAD, params=asked)
        return self._read(kind, answer)

    def _answered(self, method: str, path: str, **how: Any) -> httpx.Response:
        return answers.asked(self._http, method, PREFIX + path, **how)

    def _read(self, kind: type[T], answer: httpx.Response) -> T:
        return answers.understood(kind, answer.content, self.url)
