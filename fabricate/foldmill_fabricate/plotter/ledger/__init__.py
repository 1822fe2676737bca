"""The pass ledger: what was sent to which machine, what it has confirmed, and who said what.

A sheet that is being made is kept with all its programs. A program runs under a token: only its
holder may write, every stroke is written down before its bytes leave, and a run that nobody ended
is never begun again without a person's word. So after a crash it is known what is certain, what is
doubtful and what is left.
"""

from __future__ import annotations

from foldmill_fabricate.plotter.ledger.ledger import Ledger, ledger_file, ledger_place
from foldmill_fabricate.plotter.ledger.origins import GoesOn, Origin
from foldmill_fabricate.plotter.ledger.reading import account
from foldmill_fabricate.plotter.ledger.run import Run
from foldmill_fabricate.plotter.ledger.values import (
    Answered,
    Entry,
    Program,
    Record,
    SheetRecord,
    State,
    Word,
)
from foldmill_fabricate.plotter.ledger.words import Said

__all__ = [
    "Answered",
    "Entry",
    "GoesOn",
    "Ledger",
    "Origin",
    "Program",
    "Record",
    "Run",
    "Said",
    "SheetRecord",
    "State",
    "Word",
    "account",
    "ledger_file",
    "ledger_place",
]
