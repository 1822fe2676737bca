"""The tables of jobs, beside the ledger's, in SQL that SQLite and PostgreSQL both know."""

from __future__ import annotations

from sqlalchemy import Boolean, Column, ForeignKey, Integer, MetaData, String, Table, Text

METADATA = MetaData()

JOBS = Table(
    "jobs",
    METADATA,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("id", String(8), nullable=False, unique=True),
    Column("key", String(200), unique=True),
    Column("content", String(64), nullable=False),
    Column("plotter", Text, nullable=False, index=True),
    Column("plan", String(64), nullable=False),
    Column("order", Text, nullable=False),
    Column("title", Text, nullable=False),
    Column("material", Text, nullable=False),
    Column("machine", Text, nullable=False),
    Column("copies", Integer, nullable=False),
    Column("priority", Integer, nullable=False),
    Column("state", String(32), nullable=False, index=True),
    Column("note", Text, nullable=False, server_default=""),
    Column("wish", String(16), nullable=False, server_default=""),
    Column("begun", Boolean, nullable=False),
    Column("token", Integer, nullable=False, server_default="0"),
    Column("who", Text, nullable=False),
    Column("submitted", String(32), nullable=False),
    Column("ended", String(32), nullable=False, server_default=""),
    Column("remakes", String(8), nullable=False, server_default=""),
)
JOB_SHEETS = Table(
    "job_sheets",
    METADATA,
    Column("job", ForeignKey("jobs.id"), primary_key=True),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("sheet", String(8), nullable=False, unique=True),
)
QUESTIONS = Table(
    "questions",
    METADATA,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("id", String(16), nullable=False, unique=True),
    Column("job", ForeignKey("jobs.id"), nullable=False, index=True),
    Column("sheet", String(8), nullable=False),
    Column("program", Integer),
    Column("kind", String(16), nullable=False),
    Column("setup", Text, nullable=False),
    Column("face", String(16), nullable=False),
    Column("text", Text, nullable=False),
    Column("data", Text, nullable=False),
    Column("asked", String(32), nullable=False),
    Column("state", String(16), nullable=False),
    Column("answer", Text, nullable=False, server_default=""),
    Column("who", Text, nullable=False, server_default=""),
)
EVENTS = Table(
    "job_events",
    METADATA,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("when", String(32), nullable=False),
    Column("job", String(8), nullable=False, index=True),
    Column("who", Text, nullable=False),
    Column("what", Text, nullable=False),
    Column("state", String(32), nullable=False),
)
