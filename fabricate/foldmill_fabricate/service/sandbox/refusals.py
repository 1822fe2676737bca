"""How work in the sandbox ends when it does not end well.

::

    FoldmillError
    ├── Refused (ValueError)           what the function itself refused, with its own sentence
    ├── TooMuch (ValueError)           work that needed more than its limits (``confining``)
    ├── TooBusy (RuntimeError)         more work waiting than there is room for
    └── SandboxFailed (RuntimeError)   a process that ended without a word, by a fault of ours
"""

from __future__ import annotations

from foldmill.errors import FoldmillError


class Refused(FoldmillError, ValueError):
    """What a function in the sandbox refused; ``kind`` names the class of its error."""

    def __init__(self, message: str, kind: str = "FoldmillError") -> None:
        super().__init__(message)
        self.kind = kind


class TooBusy(FoldmillError, RuntimeError):
    """More work than can wait; the same request may be sent again later."""


class SandboxFailed(FoldmillError, RuntimeError):
    """A process that ended without saying why."""

    def __init__(self, message: str, log: str = "") -> None:
        super().__init__(message)
        self.log = log
        """What it has printed, for who runs the service; never for who asked."""
