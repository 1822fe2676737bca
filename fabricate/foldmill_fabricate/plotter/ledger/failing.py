"""A database that is away, full, or held by somebody: as a sentence, whatever its driver raised."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sqlalchemy import Engine, event
from sqlalchemy.engine import ExceptionContext

from foldmill_fabricate.plotter.errors import LedgerFailed
from foldmill_fabricate.space import sentence

_FULL, _HELD = "database or disk is full", "database is locked"
_DISK = "disk I/O error"
_SERVER_FULL, _LOST = "53100", ("08", "53", "57")
"""Classes of SQLSTATE: no room left; the connection is lost, resources are short, it shuts down."""


def listen(engine: Engine) -> None:
    """Let an engine raise LedgerFailed for these, and what it always raised for all else."""
    event.listen(engine, "handle_error", _raise)


def failed(error: BaseException, engine: Engine, *, lost: bool = False) -> LedgerFailed | None:
    """Return what a driver raised as a sentence; None where it is no failure of the database.

    lost : whether the connection is known to be.
    """
    if engine.dialect.name == "sqlite":
        why = _of_file(str(error), Path(engine.url.database or ""))
    else:
        why = _of_server(error, str(engine.url), lost=lost)
    return LedgerFailed(why) if why else None


def is_lost(error: BaseException, engine: Engine, connection: Any) -> bool:
    """Tell whether a connection is of no use after an error."""
    known = isinstance(error, engine.dialect.loaded_dbapi.Error)
    return known and bool(engine.dialect.is_disconnect(error, connection, None))  # type: ignore[arg-type]


def _raise(context: ExceptionContext) -> None:
    if context.is_pre_ping or context.engine is None:
        return  # the pool connects anew
    raised = context.original_exception
    found = failed(raised, context.engine, lost=context.is_disconnect)
    if found is not None:
        raise found from raised


def _of_file(said: str, file: Path) -> str:
    if _FULL in said:
        return f"{sentence(file)} The ledger {file.name} is there, and nothing is sent without it."
    if _DISK in said:
        return f"The ledger {file} cannot be written or read: {said}. Look after its disk."
    if _HELD in said:
        return f"The ledger {file} is held by another program for half a minute: end that one."
    return ""


def _of_server(error: BaseException, url: str, *, lost: bool) -> str:
    code = getattr(error, "sqlstate", None) or ""
    reason = (str(error).strip().splitlines() or ["no reason given"])[0].rstrip(".")
    if code == _SERVER_FULL:
        return f"The disk of the database {url} is full: {reason}. Make room on its server."
    if lost or code[:2] in _LOST or (not code and _never_connected(error)):
        return (
            f"The database {url} does not answer: {reason}. Nothing is sent while it is away; jobs "
            "go on once it is back."
        )
    return ""


def _never_connected(error: BaseException) -> bool:
    """Tell whether an error without a code of its own is one of connecting."""
    return type(error).__name__ in {"OperationalError", "ConnectionTimeout", "InterfaceError"}
