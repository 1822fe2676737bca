"""The changes a transaction of the ledger is made of."""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, and_, insert, update

from foldmill_fabricate.plotter.holding import person as person
from foldmill_fabricate.plotter.ledger.reading import at_program
from foldmill_fabricate.plotter.ledger.tables import ANSWERS, AUDIT, PROGRAMS
from foldmill_fabricate.plotter.ledger.values import FOLLOWS, State


def set_state(at: Connection, row: Row[Any], to: State, **values: Any) -> bool:
    """Compare and set: True where the program was still as ``row`` says."""
    if to not in FOLLOWS[State(row.state)]:
        return False
    same = and_(
        at_program(row.sheet, row.number),
        PROGRAMS.c.state == row.state,
        PROGRAMS.c.token == row.token,
    )
    done = at.execute(update(PROGRAMS).where(same).values(state=to.value, **values))
    return bool(done.rowcount == 1)


def note(
    at: Connection, when: datetime, sheet: str, number: int | None, what: str, who: str = ""
) -> None:
    """Add to the history of a sheet."""
    about = {"sheet": sheet, "number": number, "who": who or person(), "what": what}
    at.execute(insert(AUDIT).values(when=stamp(when), **about))


def answer(
    at: Connection,
    when: datetime,
    sheet: str,
    number: int | None,
    gate: str,
    told: Mapping[str, Any],
    who: str = "",
) -> None:
    """Keep what a person did and measured at a gate, and add it to the history."""
    row = {"when": stamp(when), "sheet": sheet, "number": number, "who": who or person()}
    text = json.dumps(dict(told), sort_keys=True)
    at.execute(insert(ANSWERS).values(gate=gate, told=text, **row))
    words = ", ".join(f"{name} {told[name]}" for name in sorted(told))
    note(at, when, sheet, number, f"{gate}: {words}" if words else gate, who)


def stamp(when: datetime) -> str:
    """Return a time as it is written down."""
    return when.isoformat(timespec="milliseconds")
