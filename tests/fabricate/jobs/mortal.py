"""`foldmill job work` in a process that dies by SIGKILL at a named point, as the power might fail.

A point is a method around which something is written down, ``before`` or ``after`` it, and which
call of it.
"""

from __future__ import annotations

import contextlib
import functools
import os
import signal
from pathlib import Path
from typing import Any

from sqlalchemy import update

from foldmill_fabricate.cli.working import work_here
from foldmill_fabricate.jobs.store import JobStore
from foldmill_fabricate.plotter.ledger import Ledger, Record, State
from foldmill_fabricate.plotter.ledger.tables import PROGRAMS

POINTS: dict[str, tuple[type, str]] = {
    "lay": (Ledger, "lay"),
    "claim": (Ledger, "claim"),
    "write": (Ledger, "write"),
    "end": (Ledger, "end"),
    "recover": (Ledger, "recover"),
    "say": (Ledger, "say"),
    "gate": (Ledger, "answer"),
    "take": (JobStore, "take"),
    "begin-sheet": (JobStore, "begin_sheet"),
    "ask": (JobStore, "ask"),
    "reply": (JobStore, "reply"),
    "move": (JobStore, "move"),
}


def die_at(point: str) -> None:
    """Let this process die at a point, such as write:after:3."""
    name, when, count = point.split(":")
    owner, method = POINTS[name]
    whole, left = getattr(owner, method), int(count)

    @functools.wraps(whole)
    def wrapped(*args: Any, **named: Any) -> Any:
        nonlocal left
        left -= 1
        if left == 0 and when == "before":
            os.kill(os.getpid(), signal.SIGKILL)
        result = whole(*args, **named)
        if left == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return result

    setattr(owner, method, wrapped)


def be_careless() -> None:
    """Take the guard out: whatever was under way is ready again from its start."""

    def recover(self: Ledger, sheet: str, number: int) -> Record:
        with self._engine.begin() as at:
            where = (PROGRAMS.c.sheet == sheet) & (PROGRAMS.c.number == number)
            unfinished = PROGRAMS.c.state != State.DONE.value
            at.execute(update(PROGRAMS).where(where, unfinished).values(state=State.READY.value))
        return self.record(sheet, number)

    Ledger.recover = recover  # type: ignore[method-assign]


def main(words: list[str], environment: dict[str, str], log: Path) -> None:
    """Work on jobs; words : plotters, a point such as write:after:3, careless."""
    os.environ.update(environment)
    for word in words:
        if word == "careless":
            be_careless()
        elif "=" not in word:
            die_at(word)
    with log.open("a") as to, contextlib.redirect_stderr(to):
        plotters = [word for word in words if "=" in word]
        work_here(plotters, "here", lambda line: print(line, file=to, flush=True))
