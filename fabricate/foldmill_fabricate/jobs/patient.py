"""Connections of the engine that wait for a server which is away.

The engine would try again by itself, after longer and longer rests; so it is at work half a second
after the server is.
"""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

from sqlalchemy import Engine, create_engine, event

from foldmill_fabricate.jobs.errors import Leave
from foldmill_fabricate.space import sentence as of_disk

_REST = 0.5
"""s between two tries."""
_SETTINGS = {"connect_timeout": 5, "application_name": "foldmill-engine"}
_IDLE_MS = 60_000
"""after which the server ends a transaction that nobody goes on with, and with it its locks."""


def engine(url: str, over: Event) -> Engine | None:
    """Return what the engine connects by to a server; None for a file, which is never away.

    over : set when nobody is to wait any longer; who waits has Leave raised.
    """
    if url.startswith("sqlite"):
        return None
    settings = _SETTINGS | {"options": f"-c idle_in_transaction_session_timeout={_IDLE_MS}"}
    made = create_engine(url, pool_size=20, pool_pre_ping=True, connect_args=settings)

    def connect(dialect: Any, _record: Any, words: Any, named: Any) -> Any:
        while True:
            try:
                return dialect.connect(*words, **named)
            except dialect.loaded_dbapi.OperationalError:
                if over.wait(_REST):
                    raise Leave("The service ends.") from None

    event.listen(made, "do_connect", connect)
    return made


def sentence(error: BaseException, url: str) -> str:
    """Say what is in the way of the engine's database; url : of it."""
    said = (str(error).splitlines() or [type(error).__name__])[0]
    if "database or disk is full" in said:
        return of_disk(Path(url.removeprefix("sqlite:///")))
    return said
