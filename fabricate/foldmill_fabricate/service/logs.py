"""Logs as one JSON object a line: what happened, when, to whom; never a token, never a body."""

from __future__ import annotations

import json
import logging
import re
import sys
import time
from datetime import UTC, datetime
from typing import Any, TextIO

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from foldmill_fabricate.service.metrics import Metrics
from foldmill_fabricate.service.tokens import MARK, TOKEN

ACCESS = logging.getLogger("foldmill.access")
PREFIX = "/api/v1"
_OWN = frozenset(vars(logging.makeLogRecord({}))) | {
    "message",
    "asctime",
    "taskName",
    "color_message",
}
"""What every record has, or uvicorn adds for terminals."""
_UNSEEN = re.compile("[\x7f-\x9f\u2028\u2029\ud800-\udfff]")
"""Control characters that JSON leaves as they are, and what no encoding can write."""


class JsonLines(logging.Formatter):
    """One JSON object a line: time (UTC), level, logger, message, and what the call added."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line of a record."""
        told: dict[str, Any] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        told |= {name: value for name, value in vars(record).items() if name not in _OWN}
        if record.exc_info:
            told["trace"] = self.formatException(record.exc_info)
        return _plain(json.dumps(told, ensure_ascii=False, default=str))


def _plain(line: str) -> str:
    """Return a line without tokens, whoever wrote one where, and without what a terminal obeys."""
    told = TOKEN.sub(f"{MARK}…", line)
    return _UNSEEN.sub(lambda found: f"\\u{ord(found[0]):04x}", told)


def configure(level: str = "INFO", stream: TextIO | None = None) -> None:
    """Let everything that this process logs go to a stream (standard error) as JSON lines."""
    handler = logging.StreamHandler(stream or sys.stderr)
    handler.setFormatter(JsonLines())
    root = logging.getLogger()
    root.handlers = [handler]
    root.setLevel(level)
    for name in ("uvicorn", "uvicorn.error", "uvicorn.access"):
        logging.getLogger(name).handlers = []
        logging.getLogger(name).propagate = name != "uvicorn.access"
    logging.getLogger("httpx").setLevel("WARNING")


class Watch:
    """Logs and measures every request: its method, its route, who sent it, how it was answered."""

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self._app, self._metrics = app, metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on and tell of it when it is answered."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began, status = time.perf_counter(), 500

        async def noting(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            await self._app(scope, receive, noting)
        finally:
            self._tell(scope, status, time.perf_counter() - began)

    def _tell(self, scope: Scope, status: int, seconds: float) -> None:
        """Log one request; of its path only the route is told to the metrics, which keep it."""
        route = _route(scope)
        self._metrics.answered(scope["method"], route, status, seconds)
        level = logging.DEBUG if route in {"/healthz", "/metrics"} else logging.INFO
        client = scope.get("client")
        told = {
            "method": scope["method"],
            "path": scope["path"][:300],
            "status": status,
            "ms": round(1000 * seconds, 1),
            "who": scope.get("state", {}).get("who", ""),
            "from": client[0] if client else "",
        }
        ACCESS.log(level, "%s %s %s", told["method"], told["path"], status, extra=told)


def _route(scope: Scope) -> str:
    """Return the path of a request with names for its parts; empty where it led nowhere."""
    found = getattr(scope.get("route"), "path", None)
    if found is None:
        return ""
    within = scope["path"].startswith(PREFIX) and not found.startswith(PREFIX)
    return f"{PREFIX if within else ''}{found}"
