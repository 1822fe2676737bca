"""What a process that computes for somebody may use up: said once, and kept by the kernel.

A plan that the service makes at once and one that a job has ordered have the same limits.
"""

from __future__ import annotations

import errno
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import ceil
from pathlib import Path

from foldmill.errors import FoldmillError

_MB = 1024 * 1024
_LAST_WORDS = 64 * _MB
"""Memory that is left to say that there was too little of it."""
_SIMPLER = "Make it simpler: fewer lines, fewer copies."


class TooMuch(FoldmillError, ValueError):
    """Work that needed more time, memory or room than it may have."""


@dataclass(frozen=True)
class Limits:
    """Limits on one piece of work; whatever reaches one of them is killed, or refused."""

    seconds: float = 30.0
    """Of the processor's time, rounded up; who waits for it limits the time on the wall, too."""
    memory_mb: int = 1024
    """MB beyond what the process holds when it begins."""
    file_mb: int = 256
    """MB of the largest file it writes."""

    def late(self, what: str) -> TooMuch:
        """Return the refusal of work that took too long; ``what`` begins the sentence."""
        return TooMuch(f"{what} took more than {self.seconds:g} s and was stopped. {_SIMPLER}")

    def too_large(self, what: str) -> TooMuch:
        """Return the refusal of work that needs too much memory."""
        return TooMuch(
            f"{what} needs more than {self.memory_mb} MB of memory and was stopped. {_SIMPLER}"
        )

    def too_long(self, what: str) -> TooMuch:
        """Return the refusal of work that writes too large a file."""
        return TooMuch(
            f"{what} would write a file of more than {self.file_mb} MB and was stopped. {_SIMPLER}"
        )

    def after(self, ended: int, what: str) -> TooMuch | None:
        """Return the refusal of work that a signal has ended; None where no limit sends it."""
        if ended in {signal.SIGXCPU, signal.SIGKILL}:
            return self.late(what)
        if ended == signal.SIGXFSZ:
            return self.too_long(what)
        if ended in {signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS}:
            return self.too_large(what)
        return None


PLANNING = Limits(seconds=600, memory_mb=2048, file_mb=512)
"""Of a plan, whoever asks for it."""


def confine(limits: Limits) -> None:
    """Take away from this process, for good, what its work may not use."""
    if sys.platform == "win32":
        return
    import resource

    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (limits.file_mb * _MB,) * 2)
    processor = max(1, ceil(limits.seconds))
    resource.setrlimit(resource.RLIMIT_CPU, (processor, processor + 1))
    if sys.platform == "linux":
        most = _address_space() + limits.memory_mb * _MB
        resource.setrlimit(resource.RLIMIT_AS, (most, most + _LAST_WORDS))


@contextmanager
def refusing(limits: Limits, what: str) -> Iterator[None]:
    """Raise TooMuch, within a confined process, where its work meets a limit that can be told of.

    Processor time can not: it ends the process, and who waits for it asks ``Limits.after``.
    """
    try:
        yield
    except MemoryError:
        _make_room()
        raise limits.too_large(what) from None
    except OSError as error:
        if error.errno != errno.EFBIG:
            raise
        raise limits.too_long(what) from None


def _make_room() -> None:
    if sys.platform != "win32":
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _address_space() -> int:
    """Return the bytes of address space that this process has now."""
    import resource

    pages = int(Path("/proc/self/statm").read_text().split()[0])
    return pages * resource.getpagesize()
