"""What went to a device last, by the histories of its sheets: half of it may still lie there.

A machine that cannot drop half an instruction ends it with the next bytes it hears, whatever those
were meant to be: a number cut short is a line to somewhere else.
"""

from __future__ import annotations

from typing import NamedTuple

from sqlalchemy import Connection, or_, select

from foldmill_fabricate.plotter.ledger.reading import record_of
from foldmill_fabricate.plotter.ledger.tables import AUDIT
from foldmill_fabricate.plotter.ledger.values import Record, State

BEGUN = "begun at stroke "
"""Where a run begins, before the stroke."""
TRYING, TRIED = "a test cut is sent", "a test cut was sent"
EMPTIED = "switched off and on"
"""What a person has said to have done with a device."""


class BrokenOff(NamedTuple):
    """What was sent last to a device, and may have ended within an instruction."""

    sheet: str
    number: int
    """Of the program; of a test cut, the one that it was made for."""
    is_trial: bool


def told(what: str, device: str) -> str:
    """Return what a sheet's history says of a device."""
    return f"{what} on {device}"


def broken_off(at: Connection, device: str) -> BrokenOff | None:
    """Return what was broken off on a device; None where nobody need do anything about it."""
    what = AUDIT.c.what
    known = or_(*(what.startswith(each) for each in (BEGUN, TRYING, TRIED, EMPTIED)))
    here = what.endswith(told("", device), autoescape=True)
    wanted = select(AUDIT.c.sheet, AUDIT.c.number, what).where(known, here)
    last = at.execute(wanted.order_by(AUDIT.c.id.desc()).limit(1)).first()
    if last is None:
        return None
    if last.what.startswith(BEGUN):
        is_open = _may_be_cut_short(record_of(at, last.sheet, last.number))
        return BrokenOff(last.sheet, last.number, is_trial=False) if is_open else None
    is_open = last.what.startswith(TRYING)
    return BrokenOff(last.sheet, last.number, is_trial=True) if is_open else None


def _may_be_cut_short(record: Record) -> bool:
    """Tell whether the last instruction of a program may be sent in half.

    A sheet that is given up takes with it what was confirmed to its end, too.
    """
    if record.state is State.SPOILED:
        return record.runs[-1].acked < record.program.strokes
    return record.state in {State.RUNNING, State.INTERRUPTED}
