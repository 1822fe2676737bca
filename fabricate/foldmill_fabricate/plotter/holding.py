"""A lock that says who holds it: others are told, and asking changes nothing.

The lock is the system's own: it ends with the process, whatever ends that. The note of who holds it
lies beside it, and counts only while the lock is held.
"""

from __future__ import annotations

import getpass
import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from socket import gethostname

from filelock import FileLock, Timeout

from foldmill_fabricate.files import write_whole

_MOST = 4096
"""Bytes of a note that are read."""
_PATIENCE = 0.5
"""s for which a lock is tried: whoever only asks about it has it for less."""


def person() -> str:
    """Return who is at the computer, as it knows them."""
    try:
        return getpass.getuser()
    except (OSError, KeyError):
        return "somebody"


@dataclass(frozen=True)
class Holder:
    """Who holds something, since when, and how that ends."""

    what: str
    """such as "job K3PX7Q" or "foldmill jog" """
    remedy: str
    """what to do about it, a sentence"""
    who: str = ""
    computer: str = ""
    process: int = 0
    since: str = ""
    """UTC, ISO 8601, to the second"""

    def now(self) -> Holder:
        """Return the same as this process, from this moment on."""
        when = datetime.now(UTC).isoformat(timespec="seconds")
        return Holder(self.what, self.remedy, person(), gethostname(), os.getpid(), when)

    def __str__(self) -> str:
        since = self.since.replace("T", " ").replace("+00:00", " UTC")
        where = f"process {self.process} of {self.who} on {self.computer}"
        return f"{self.what} ({where}), since {since}"

    def dump(self) -> str:
        """Return it as text for ``load``."""
        return json.dumps(asdict(self))

    @classmethod
    def load(cls, text: str) -> Holder | None:
        """Read one back; None for what is none."""
        try:
            return cls(**json.loads(text))
        except (ValueError, TypeError):
            return None


class Held(Exception):
    """A lock that another process holds; ``by`` : None where it does not say; ``name`` : of it."""

    def __init__(self, by: Holder | None, name: str = "") -> None:
        self.by, self.name = by, name
        super().__init__(str(by) if by else "another process")


@contextmanager
def locked(file: Path, holder: Holder, mode: int = 0o644) -> Iterator[None]:
    """Hold the lock of a file; raises Held, and OSError where it cannot be locked."""
    lock = FileLock(file, timeout=_PATIENCE, mode=mode, thread_local=False)
    try:
        lock.acquire()
    except Timeout:
        raise Held(holder_of(file)) from None
    note = _note(file, str(os.getpid()))
    try:
        with suppress(OSError):  # a note that cannot be written holds up nobody
            for old in _notes(file):
                old.unlink()
        with suppress(OSError):
            write_whole(note, holder.now().dump().encode())
        yield
    finally:
        with suppress(OSError):
            note.unlink(missing_ok=True)
        lock.release()


def holder_of(file: Path) -> Holder | None:
    """Return who says to hold a lock that is held; None where nobody has said."""
    found = []
    for note in _notes(file):
        with suppress(OSError), note.open("rb") as opened:
            found.append(Holder.load(opened.read(_MOST).decode(errors="replace")))
    return max(filter(None, found), key=lambda one: one.since, default=None)


def is_held(file: Path) -> bool:
    """Tell whether a process holds a lock. Whoever asks keeps nobody from it, nor from asking."""
    if not file.exists():
        return False
    if sys.platform == "win32":
        return _is_refused(file)
    import fcntl

    with file.open("rb") as opened:
        try:
            fcntl.flock(opened, fcntl.LOCK_SH | fcntl.LOCK_NB)  # shared: many may ask at once
        except BlockingIOError:
            return True
    return False


def _is_refused(file: Path) -> bool:
    """Tell whether a lock is held where locks cannot be shared."""
    try:
        with FileLock(file, timeout=_PATIENCE):
            return False
    except Timeout:
        return True


def _note(file: Path, name: str) -> Path:
    return file.with_name(f"{file.name}.{name}.json")


def _notes(file: Path) -> list[Path]:
    return sorted(file.parent.glob(f"{file.name}.*.json"))
