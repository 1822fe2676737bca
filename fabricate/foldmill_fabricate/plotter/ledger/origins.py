"""From which folder a sheet was begun, and which sheet it goes on with.

A sheet is gone on with once: the same missing strokes are never planned onto it twice.
"""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Connection, insert, select
from sqlalchemy.exc import IntegrityError

from foldmill_fabricate.plotter.errors import LedgerRefused
from foldmill_fabricate.plotter.ledger import reading, words
from foldmill_fabricate.plotter.ledger.tables import ORIGINS
from foldmill_fabricate.plotter.ledger.values import SheetRecord, State


@dataclass(frozen=True)
class GoesOn:
    """The sheet that another goes on with, as it was when that was planned."""

    sheet: str
    digest: str
    """of its record"""


@dataclass(frozen=True)
class Origin:
    """From where a sheet was begun."""

    folder: str = ""
    """Its job folder then; empty where nobody has said."""
    goes_on: str = ""
    """The sheet that it goes on with; empty where it was a new one."""


def keep(at: Connection, sheet: str, folder: str, goes_on: str) -> None:
    """Keep from where a sheet was begun; raises LedgerRefused for the second to go on with one."""
    try:
        at.execute(insert(ORIGINS).values(sheet=sheet, folder=folder, goes_on=goes_on or None))
    except IntegrityError:
        raise LedgerRefused(f"Sheet {goes_on} was gone on with by another just now.") from None


def origin(at: Connection, sheet: str) -> Origin:
    """Return from where a sheet was begun."""
    row = at.execute(select(ORIGINS).where(ORIGINS.c.sheet == sheet)).first()
    return Origin(row.folder, row.goes_on or "") if row else Origin()


def successor(at: Connection, sheet: str) -> str:
    """Return the sheet that goes on with one; empty for none."""
    row = at.execute(select(ORIGINS.c.sheet).where(ORIGINS.c.goes_on == sheet)).first()
    return row.sheet if row else ""


def take_over(at: Connection, record: SheetRecord, goes_on: GoesOn) -> None:
    """Give up a sheet that another goes on with from now on.

    Raises LedgerRefused where it is not any more as it was when that was planned.
    """
    after = successor(at, record.id)
    if after:
        raise LedgerRefused(f"Sheet {record.id} was gone on with already, as {after}.")
    if _is_made(record):
        raise LedgerRefused(f"Sheet {record.id} is being made; wait for its end.")
    if record.digest != goes_on.digest:
        raise LedgerRefused(
            f"Sheet {record.id} is not as it was when its rest was planned: strokes were cut since "
            f"then, or spoken of. Plan the rest again with foldmill sheets {record.id} --remake."
        )
    words.give_up(at, record.id, running=False)
    if any(one.state is not State.SPOILED for one in reading.sheet(at, record.id).records):
        raise LedgerRefused(f"Sheet {record.id} was taken up by another just now; look again.")


def _is_made(record: SheetRecord) -> bool:
    return any(one.state is State.RUNNING for one in record.records)
