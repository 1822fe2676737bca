"""Rows of the ledger as values, and values as sentences."""

from __future__ import annotations

import json
from typing import Any

from sqlalchemy import Connection, Row, Select, exists, select

from foldmill_fabricate.plotter.errors import LedgerRefused
from foldmill_fabricate.plotter.ledger.tables import ANSWERS, PROGRAMS, RUNS, SHEETS
from foldmill_fabricate.plotter.ledger.values import (
    Answered,
    Entry,
    Program,
    Record,
    SheetRecord,
    State,
)


def at_program(sheet: str, number: int) -> Any:
    """Return the condition that picks one program of a sheet."""
    return (PROGRAMS.c.sheet == sheet) & (PROGRAMS.c.number == number)


def program_row(at: Connection, sheet: str, number: int) -> Row[Any]:
    """Return the row of a program; raises LedgerRefused where there is none."""
    row = at.execute(select(PROGRAMS).where(at_program(sheet, number))).first()
    if row is None:
        raise LedgerRefused(f"Sheet {sheet} has no program {number + 1}.")
    return row


def sheet(at: Connection, name: str) -> SheetRecord:
    """Return a sheet; raises LedgerRefused where there is none of that id."""
    row = at.execute(select(SHEETS).where(SHEETS.c.id == name.upper())).first()
    if row is None:
        raise LedgerRefused(f"The ledger knows no sheet {name!r}; look at its id again.")
    return sheet_record(at, row)


def open_sheets(job: str | None) -> Select[Any]:
    """Return the statement that finds what was begun and is not finished, the newest first.

    Nothing else is read: a workshop has thousands that are finished.
    """
    ended = [State.DONE.value, State.SPOILED.value]
    left = (PROGRAMS.c.sheet == SHEETS.c.id) & PROGRAMS.c.state.not_in(ended)
    begun = exists().where(RUNS.c.sheet == SHEETS.c.id)
    wanted = select(SHEETS).where(exists().where(left), begun).order_by(SHEETS.c.number.desc())
    return wanted if job is None else wanted.where(SHEETS.c.job == job)


def sheet_record(at: Connection, row: Row[Any]) -> SheetRecord:
    """Return a sheet with all its programs and their runs."""
    wanted = select(PROGRAMS).where(PROGRAMS.c.sheet == row.id).order_by(PROGRAMS.c.number)
    records = tuple(_record(at, each) for each in at.execute(wanted).all())
    head = {name: getattr(row, name) for name in ("id", "job", "title", "machine", "material")}
    return SheetRecord(**head, begun=row.begun, records=records)


def _record(at: Connection, row: Row[Any]) -> Record:
    program = Program(row.name, row.face, row.sha256, row.strokes)
    mine = (RUNS.c.sheet == row.sheet) & (RUNS.c.number == row.number)
    found = at.execute(select(RUNS).where(mine).order_by(RUNS.c.token)).all()
    runs = tuple(Entry(r.token, r.first, r.vertex, r.sent, r.acked, r.cut_to) for r in found)
    way = (row.first, row.vertex, row.overlap, row.note)
    return Record(row.sheet, row.number, program, State(row.state), *way, runs)


def record_of(at: Connection, sheet: str, number: int) -> Record:
    """Return one program of a sheet; raises LedgerRefused where there is none."""
    return _record(at, program_row(at, sheet, number))


def answers(at: Connection, sheet: str) -> list[Answered]:
    """Return what was answered at a sheet's gates, the oldest first."""
    rows = at.execute(select(ANSWERS).where(ANSWERS.c.sheet == sheet).order_by(ANSWERS.c.id))
    return [Answered(r.when, r.number, r.who, r.gate, json.loads(r.told)) for r in rows.all()]


def account(record: Record) -> str:
    """Say what is certain, doubtful and left."""
    certain, doubtful, left = (len(n) for n in (record.certain, record.doubtful, record.left))
    sentence = f"Of {record.program.strokes} strokes {certain} are cut for certain"
    if doubtful:
        low, high = record.doubtful[0] + 1, record.doubtful[-1] + 1
        which = f"number {low}" if low == high else f"numbers {low} to {high}"
        sentence += f", {doubtful} are doubtful ({which})"
    return f"{sentence}, {left} are left."


def not_ready(record: Record) -> str:
    """Say why a program cannot be begun."""
    name = f"{record.program.name} of sheet {record.sheet}"
    if record.state is State.RUNNING:
        return f"{name} is being sent by somebody else."
    if record.state in {State.INTERRUPTED, State.UNCONFIRMED}:
        return (
            f"{name} is {record.state.value}. {account(record)} Say how it goes on before anything "
            "else is sent."
        )
    return f"{name} is {record.state.value}; it is not sent again."
