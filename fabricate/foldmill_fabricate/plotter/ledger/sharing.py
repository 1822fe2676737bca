"""Hold names among all computers that use one database, so that no two do the same.

On PostgreSQL these are its advisory locks: they end with the connection, and so with the process or
the computer that holds them. A database in a file is one computer's: locks of files do there.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress

from sqlalchemy import Connection, Engine, delete, func, insert, select
from sqlalchemy.exc import SQLAlchemyError

from foldmill_fabricate.plotter.errors import LedgerFailed
from foldmill_fabricate.plotter.holding import Held, Holder
from foldmill_fabricate.plotter.ledger.tables import HOLDERS

_PATIENCE = 2.0
"""s for which a name is tried: the server takes a moment to see that a process has ended."""
_LOOK = 0.1
_KEEPALIVE = {"tcp_keepalives_idle": 20, "tcp_keepalives_interval": 5, "tcp_keepalives_count": 4}
"""s, s, times: a computer that was switched off holds nothing after 40 s."""

Keep = Callable[[], None]
"""Holds the names again where the server was started anew; raises Held where another was first."""


@contextmanager
def reserved(engine: Engine, names: Sequence[str], holder: Holder) -> Iterator[Keep]:
    """Hold names in a database while the context lasts; raises Held with who has one of them.

    Gives what is to be called now and then by whoever holds them long. It does nothing where the
    database is a file, nor for no names.
    """
    if engine.dialect.name != "postgresql" or not names:
        yield lambda: None
        return
    held = _Names(engine, names, holder.now().dump())
    try:
        held.take()
        yield held.keep
    finally:
        held.leave()


def is_reserved(engine: Engine, name: str) -> bool:
    """Tell whether another connection holds a name."""
    if engine.dialect.name != "postgresql":
        return False
    with engine.connect() as at:  # a shared lock, for as long as this transaction lasts
        return not at.execute(select(func.pg_try_advisory_xact_lock_shared(_key(name)))).scalar()


def is_any_reserved(engine: Engine, beginning: str) -> bool:
    """Tell whether another connection holds a name that begins so."""
    if engine.dialect.name != "postgresql":
        return False
    with engine.connect() as at:
        noted = select(HOLDERS.c.name).where(HOLDERS.c.name.startswith(beginning, autoescape=True))
        names = at.execute(noted).scalars().all()
    return any(is_reserved(engine, name) for name in names)


class _Names:
    """Names that a connection of their own holds."""

    def __init__(self, engine: Engine, names: Sequence[str], holder: str) -> None:
        self._names, self._holder, self._has_them = sorted(names), holder, False
        self._at = engine.connect().execution_options(isolation_level="AUTOCOMMIT")

    def take(self) -> None:
        self._has_them = False
        self._at.execute(select(func.pg_advisory_unlock_all()))
        for name, value in _KEEPALIVE.items():
            self._at.execute(select(func.set_config(name, str(value), False)))
        for name in self._names:
            _reserve(self._at, name, self._holder)
        self._has_them = True

    def keep(self) -> None:
        try:
            if not self._has_them:
                self.take()
            self._at.execute(select(1))
        except (SQLAlchemyError, LedgerFailed):
            self._at.rollback()
            self._at.invalidate()  # the next statement has a connection that holds nothing yet
            self.take()

    def leave(self) -> None:
        with suppress(SQLAlchemyError, LedgerFailed):  # a server that is gone holds nothing
            self._at.execute(delete(HOLDERS).where(HOLDERS.c.holder == self._holder))
            self._at.execute(select(func.pg_advisory_unlock_all()))
        self._at.invalidate()  # what could not be unlocked ends with the connection
        self._at.close()


def _reserve(at: Connection, name: str, holder: str) -> None:
    end = time.monotonic() + _PATIENCE
    while not at.execute(select(func.pg_try_advisory_lock(_key(name)))).scalar():
        if time.monotonic() > end:
            told = at.execute(select(HOLDERS.c.holder).where(HOLDERS.c.name == name)).scalar()
            raise Held(Holder.load(told or ""), name)
        time.sleep(_LOOK)
    at.execute(delete(HOLDERS).where(HOLDERS.c.name == name))
    at.execute(insert(HOLDERS).values(name=name, holder=holder))


def _key(name: str) -> int:
    """Return the number that PostgreSQL knows a name by."""
    return int.from_bytes(hashlib.sha256(f"foldmill {name}".encode()).digest()[:8], signed=True)
