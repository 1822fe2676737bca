"""A sheet that was left half made, planned to its end: only what is missing on its record.

``strokes`` says which stroke of a plan the ledger's strokes are, and how each stands; ``words``
what a person says of those in doubt; ``make`` plans the rest; ``write`` makes a job folder of it.
"""

from foldmill_fabricate.remaking.make import remake
from foldmill_fabricate.remaking.strokes import Account, Standing, accounts, before
from foldmill_fabricate.remaking.words import Fate, Spoken, read_spoken
from foldmill_fabricate.remaking.write import plan_rest, write_remake

__all__ = [
    "Account",
    "Fate",
    "Spoken",
    "Standing",
    "accounts",
    "before",
    "plan_rest",
    "read_spoken",
    "remake",
    "write_remake",
]
