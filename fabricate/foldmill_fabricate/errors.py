"""What can go wrong between a fold and a finished sheet.

::

    FoldmillError
    ├── CannotPlan (ValueError)      the fold, the material and the machine do not go together
    │   └── DoesNotFit               too large for the blank, the carrier or the machine
    ├── CannotWrite (ValueError)     a plan that a format cannot hold
    ├── CannotSend (RuntimeError)    a job folder that must not be sent to a plotter
    ├── CannotHold (ValueError)      a file that would not hold what the pattern has
    ├── CannotExplore (ValueError)   a sweep that is asked for in a way that means nothing
    └── EngineFailed (RuntimeError)  processes or a cluster that cannot do the work of a sweep
"""

from __future__ import annotations

from foldmill.errors import FoldmillError


class CannotPlan(FoldmillError, ValueError):
    """A fold that cannot be made of this material on this machine."""


class DoesNotFit(CannotPlan):
    """A pattern, blank or carrier that is too large for what has to hold it."""


class CannotWrite(FoldmillError, ValueError):
    """A plan that a file format cannot hold."""


class CannotSend(FoldmillError, RuntimeError):
    """A job folder that must not be sent."""


class CannotHold(FoldmillError, ValueError):
    """A file for another program that would not hold what the pattern has."""


class CannotExplore(FoldmillError, ValueError):
    """Ranges, rows or files of a sweep that mean nothing."""


class EngineFailed(FoldmillError, RuntimeError):
    """Processes or a cluster that cannot do, or have not finished, the work of a sweep."""
