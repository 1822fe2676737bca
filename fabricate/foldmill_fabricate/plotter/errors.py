"""What goes wrong between a program and a plotter, in sentences for the person beside it.

::

    FoldmillError
    ├── PlotterError (OSError)           the port or the machine did not do its part
    │   ├── PortUnavailable              no such port, busy, not permitted, no such scheme
    │   ├── NoAnswer (TimeoutError)      silence where an answer was due
    │   ├── LineDisturbed                bytes were lost or garbled between computer and machine
    │   ├── Stopped                      a person stopped it
    │   ├── Fenced                       another process has taken the run over
    │   │   └── Spoiled                  the sheet was given up while it was cut
    │   └── LedgerFailed                 its database is away or full: nothing is sent without it
    ├── ProgramRefused (InvalidInput)    bytes that must not reach a machine
    └── LedgerRefused (InvalidInput)     what the ledger of passes does not allow
"""

from __future__ import annotations

from foldmill.errors import FoldmillError, InvalidInput


class PlotterError(FoldmillError, OSError):
    """The port or the machine did not do its part."""


class PortUnavailable(PlotterError):
    """A port that cannot be opened."""


class NoAnswer(PlotterError, TimeoutError):
    """A machine that was silent where an answer was due."""


class LineDisturbed(PlotterError):
    """Bytes that were lost or garbled on their way, or found no room in the machine."""


class Stopped(PlotterError):
    """A delivery that a person stopped."""


class ProgramRefused(InvalidInput):
    """Bytes that must not reach a machine."""


class LedgerRefused(InvalidInput):
    """What the ledger of passes does not allow."""


class LedgerFailed(PlotterError):
    """A database that does not answer, or has no room: it may be tried again later."""


class Fenced(PlotterError):
    """A run whose token another process has taken."""


class Spoiled(Fenced):
    """A run whose sheet a person has given up meanwhile."""
