"""What can go wrong between a fold and a finished sheet.

::

    FoldmillError
    ├── CannotPlan (ValueError)      the fold, the material and the machine do not go together
    │   └── DoesNotFit               too large for the blank, the carrier or the machine
    └── CannotSend (RuntimeError)    a job folder that must not be sent to a plotter
"""

from __future__ import annotations

from foldmill.errors import FoldmillError


class CannotPlan(FoldmillError, ValueError):
    """A fold that cannot be made of this material on this machine."""


class DoesNotFit(CannotPlan):
    """A pattern, blank or carrier that is too large for what has to hold it."""


class CannotSend(FoldmillError, RuntimeError):
    """A job folder that must not be sent."""
