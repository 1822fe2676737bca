"""A person's word on a program that ended before its end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, select, update

from foldmill_fabricate.plotter.errors import LedgerRefused
from foldmill_fabricate.plotter.ledger.tables import PROGRAMS, RUNS
from foldmill_fabricate.plotter.ledger.values import Record, State, Word
from foldmill_fabricate.plotter.ledger.writing import set_state

_TO = {Word.GO_ON: State.READY, Word.FINISHED: State.DONE, Word.SPOILED: State.SPOILED}


@dataclass(frozen=True)
class Said:
    """What was said, and where it goes on."""

    word: Word
    stroke: int = 0
    """With ``go on`` the first that is cut next; all before it are cut."""
    vertex: int = 0
    """That of the stroke from which it goes on, where the machine proved its place."""
    overlap: float = 0.0
    """mm that a through-cut is cut again."""
    who: str = ""
    """Who says so; by default whoever is at the computer."""

    def __str__(self) -> str:
        if self.word is not Word.GO_ON:
            return self.word.value
        inside = f", from inside it at vertex {self.vertex}" if self.vertex else ""
        again = f", cutting {self.overlap:g} mm again" if self.overlap else ""
        return f"{self.word.value} at stroke {self.stroke + 1}{inside}{again}"


def refuse(record: Record, said: Said) -> None:
    """Raise LedgerRefused where a word says what cannot be."""
    name = f"{record.program.name} of sheet {record.sheet}"
    if record.state not in {State.INTERRUPTED, State.UNCONFIRMED}:
        raise LedgerRefused(f"{name} is {record.state.value}; there is nothing to decide.")
    last = record.runs[-1]
    unsent = record.program.strokes - last.sent
    if said.word is Word.FINISHED and unsent > 0:
        raise LedgerRefused(
            f"{name} cannot be finished: of {unsent} strokes, the first of them number "
            f"{last.sent + 1}, no byte has left this computer."
        )
    low, high = last.acked, min(max(last.acked, last.sent), record.program.strokes - 1)
    if said.word is Word.GO_ON and low > high:
        raise LedgerRefused(f"All of {name} is cut for certain; say that it is finished.")
    if said.word is Word.GO_ON and not low <= said.stroke <= high:
        raise LedgerRefused(
            f"{name} can go on from stroke {low + 1} to {high + 1}, not from {said.stroke + 1}: "
            "what is before is cut for certain, and of what is after no byte has left."
        )


def apply(at: Connection, row: Any, record: Record, said: Said) -> bool:
    """Write a word; False where the program is no longer as ``record`` says."""
    way: dict[str, Any] = {}
    if said.word is Word.GO_ON:
        way = {"first": said.stroke, "vertex": said.vertex, "overlap": said.overlap}
    if State(row.state) is not record.state or not set_state(at, row, _TO[said.word], **way):
        return False
    if said.word is Word.SPOILED:
        give_up(at, record.sheet)
    else:
        cut_to = said.stroke if said.word is Word.GO_ON else record.program.strokes
        _settle(at, record, cut_to)
    return True


def _settle(at: Connection, record: Record, cut_to: int) -> None:
    """Keep what was said of strokes of which nobody had spoken."""
    here = (RUNS.c.sheet == record.sheet) & (RUNS.c.number == record.number)
    at.execute(update(RUNS).where(here, RUNS.c.cut_to.is_(None)).values(cut_to=cut_to))


CUT_SHORT = "Its sheet was given up while it was being cut."
"""What the record says of a program that was running then."""


def give_up(at: Connection, sheet: str, *, running: bool = True) -> None:
    """Spoil every program of a sheet; one that runs loses its token by that, and is stopped.

    running : False to leave those alone.
    """
    for row in at.execute(select(PROGRAMS).where(PROGRAMS.c.sheet == sheet)).all():
        if State(row.state) is not State.RUNNING:
            set_state(at, row, State.SPOILED)
        elif running:
            set_state(at, row, State.SPOILED, token=row.token + 1, note=CUT_SHORT)
