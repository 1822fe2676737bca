"""The ledger's tables, in SQL that SQLite and PostgreSQL both know."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from sqlalchemy import (
    Column,
    Connection,
    Engine,
    Float,
    ForeignKey,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    create_engine,
    event,
)

from foldmill_fabricate.plotter.ledger import failing

METADATA = MetaData()
_READS = "foldmill_reads"
"""Execution option of a transaction that writes nothing."""
_LASTING: dict[bool, dict[str, Any]] = {
    True: {},
    False: {"pool_pre_ping": True, "connect_args": {"connect_timeout": 5}},
}
"""How a file is opened, False: a server. A connection that it has cut is made anew before use."""

SHEETS = Table(
    "sheets",
    METADATA,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("id", String(8), nullable=False, unique=True),
    Column("job", String(64), nullable=False, index=True),
    Column("title", Text, nullable=False),
    Column("machine", Text, nullable=False),
    Column("material", Text, nullable=False),
    Column("begun", String(32), nullable=False),
)
PROGRAMS = Table(
    "programs",
    METADATA,
    Column("sheet", ForeignKey("sheets.id"), primary_key=True),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("name", Text, nullable=False),
    Column("face", String(16), nullable=False),
    Column("sha256", String(64), nullable=False),
    Column("strokes", Integer, nullable=False),
    Column("state", String(32), nullable=False),
    Column("token", Integer, nullable=False, server_default="0"),
    Column("first", Integer, nullable=False, server_default="0"),
    Column("vertex", Integer, nullable=False, server_default="0"),
    Column("overlap", Float, nullable=False, server_default="0"),
    Column("note", Text, nullable=False, server_default=""),
)
ORIGINS = Table(
    "origins",
    METADATA,
    Column("sheet", ForeignKey("sheets.id"), primary_key=True),
    Column("folder", Text, nullable=False),
    Column("goes_on", String(8), unique=True),
)
RUNS = Table(
    "runs",
    METADATA,
    Column("sheet", ForeignKey("sheets.id"), primary_key=True),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("token", Integer, primary_key=True, autoincrement=False),
    Column("device", Text, nullable=False),
    Column("first", Integer, nullable=False),
    Column("vertex", Integer, nullable=False),
    Column("sent", Integer, nullable=False),
    Column("acked", Integer, nullable=False),
    Column("cut_to", Integer),
)
AUDIT = Table(
    "audit",
    METADATA,
    Column("id", Integer, primary_key=True, autoincrement=True),
    Column("when", String(32), nullable=False),
    Column("sheet", String(8), nullable=False, index=True),
    Column("number", Integer),
    Column("who", Text, nullable=False),
    Column("what", Text, nullable=False),
)
ANSWERS = Table(
    "answers",
    METADATA,
    Column("id", Integer, primary_key=True, autoincrement=True),
    Column("when", String(32), nullable=False),
    Column("sheet", ForeignKey("sheets.id"), nullable=False, index=True),
    Column("number", Integer),
    Column("who", Text, nullable=False),
    Column("gate", String(32), nullable=False),
    Column("told", Text, nullable=False),
)

HOLDERS = Table(
    "holders",
    METADATA,
    Column("name", Text, primary_key=True),
    Column("holder", Text, nullable=False),
)
"""Who said to hold a name in a database of many computers; it counts while the lock is held."""


def connect(place: Path | str) -> Engine:
    """Open a ledger's database, a file's path or an SQLAlchemy URL, with all its tables."""
    url = f"sqlite:///{place}" if isinstance(place, Path) else place
    engine = create_engine(url, **_LASTING[url.startswith("sqlite")])
    if engine.dialect.name == "sqlite":
        event.listen(engine, "connect", _safe)
        event.listen(engine, "begin", _immediate)
    failing.listen(engine)
    METADATA.create_all(engine)
    return engine


def _safe(connection: Any, _record: Any) -> None:
    """Make every commit reach the disk, and leave the beginning of transactions to us."""
    connection.isolation_level = None
    for setting in ("busy_timeout = 30000", "journal_mode = WAL", "synchronous = FULL"):
        connection.execute(f"PRAGMA {setting}")
    connection.execute("PRAGMA foreign_keys = ON")


def _immediate(connection: Any) -> None:
    """Lock when a transaction begins, not when it first writes: what it has read stays true."""
    only_reads = connection.get_execution_options().get(_READS, False)
    connection.exec_driver_sql("BEGIN" if only_reads else "BEGIN IMMEDIATE")


def reading(engine: Engine) -> AbstractContextManager[Connection]:
    """Begin a transaction that only reads: it sees one moment, and keeps no writer waiting."""
    options: dict[str, Any] = {_READS: True}
    if engine.dialect.name == "postgresql":
        options["isolation_level"] = "REPEATABLE READ"  # else each statement sees its own moment
    return engine.execution_options(**options).begin()
