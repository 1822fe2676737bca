"""What one piece of work may use up."""

from __future__ import annotations

import signal
from dataclasses import dataclass

from foldmill_fabricate.service.sandbox.refusals import SandboxFailed, TooMuch


@dataclass(frozen=True)
class Limits:
    """Limits on one piece of work; whatever reaches one of them is killed, or refused."""

    seconds: float = 30.0
    """Of the clock on the wall; of the processor's time as well, rounded up."""
    memory_mb: int = 1024
    """MB beyond what the nursery itself holds."""
    file_mb: int = 256
    """MB of the largest file it writes."""

    def late(self, what: str) -> TooMuch:
        """Return the refusal of work that took too long; ``what`` begins the sentence."""
        return TooMuch(
            f"{what} took more than {self.seconds:g} s and was stopped. Make it simpler: fewer "
            "lines, fewer copies."
        )

    def too_large(self, what: str) -> TooMuch:
        """Return the refusal of work that needs too much memory."""
        return TooMuch(
            f"{what} needs more than {self.memory_mb} MB of memory and was stopped. Make it "
            "simpler: fewer lines, fewer copies."
        )

    def too_long(self, what: str) -> TooMuch:
        """Return the refusal of work that writes too large a file."""
        return TooMuch(
            f"{what} would write a file of more than {self.file_mb} MB and was stopped. Make it "
            "simpler: fewer lines, fewer copies."
        )

    def after(self, ended: int, what: str) -> TooMuch | SandboxFailed:
        """Return the refusal of work that a signal has ended; ``ended`` : its number."""
        if ended in {signal.SIGXCPU, signal.SIGKILL}:
            return self.late(what)
        if ended == signal.SIGXFSZ:
            return self.too_long(what)
        if ended in {signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS}:
            return self.too_large(what)
        return SandboxFailed(
            f"{what} ended by itself (signal {ended}) and nothing was kept. Try again; tell who "
            "runs this service if it happens twice."
        )
