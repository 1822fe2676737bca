"""Done before the port opens, so that no request waits for it.

FastAPI builds its routes when the first request looks for one (25 ms), and threads import their
back end when the first one is asked for (15 ms).
"""

from __future__ import annotations

import gc
from contextlib import suppress

from fastapi import FastAPI
from fastapi.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.types import Message


async def warm(app: FastAPI) -> None:
    """Let an application have looked at all its routes, and have begun a thread."""
    asked = {"type": "http", "method": "GET", "path": "/", "root_path": "", "app": app}
    with suppress(HTTPException):  # there is nothing there
        await app.router({**asked, "query_string": b"", "headers": []}, _no_body, _unheard)
    await run_in_threadpool(int)


def settle() -> None:
    """Let the collector of garbage never look again at what is there now and stays.

    These are 150,000 objects, and looking at them all keeps every thread waiting for 50 ms and
    more, at moments nobody chooses.
    """
    gc.collect()
    gc.freeze()


async def _no_body() -> Message:
    return {"type": "http.request", "body": b"", "more_body": False}


async def _unheard(_message: Message) -> None:
    """Send an answer to nobody."""
