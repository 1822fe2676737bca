"""Folders that are kept by a digest, each with when somebody last asked for it.

Asking and throwing away exclude each other by a lock on the disk, whichever processes do it: what
was asked for a moment ago is never gone a moment later. The time stands as the folder's own.
"""

from __future__ import annotations

import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock

KEEP_DAYS = 30
"""How long what nobody needs is kept, unless who runs the service says otherwise."""
DAY = 86_400.0
"""s"""
_ID = re.compile(r"[0-9a-f]{64}")
_DRAFT, _GONE, _LOCK = ".draft-", ".gone-", ".lock"


class Keeping:
    """Folders below one root, made where there is none.

    proof : the file that tells a whole folder from a half-made one. now : s, as of ``time.time``.
    """

    def __init__(self, root: Path, proof: str, now: Callable[[], float] = time.time) -> None:
        self.root, self._proof, self._now = root, proof, now

    def __iter__(self) -> Iterator[str]:
        """Yield the ids of what is kept, in order; to list it is not to ask for it."""
        found = self.root.iterdir() if self.root.is_dir() else ()
        return iter(sorted(place.name for place in found if self._is_whole(place)))

    def place(self, name: str) -> Path:
        """Return where a folder lies, or would, without asking for it."""
        return self.root / name

    def find(self, name: str) -> Path | None:
        """Ask for a folder: it is kept anew from now on; None where there is none."""
        if not _ID.fullmatch(name) or not self._is_whole(self.root / name):
            return None
        with self._locked():
            if not self._is_whole(self.root / name):
                return None
            self._touch(name)
        return self.root / name

    @contextmanager
    def draft(self) -> Iterator[Path]:
        """Give a folder to fill; what is left of it afterwards is thrown away."""
        self.root.mkdir(parents=True, exist_ok=True, mode=0o700)
        made = Path(tempfile.mkdtemp(prefix=_DRAFT, dir=self.root))
        try:
            yield made
        finally:
            shutil.rmtree(made, ignore_errors=True)

    def settle(self, made: Path, name: str) -> Path:
        """Put a filled folder in its place; where one is there it is the same, and stays."""
        place = self.root / name
        with self._locked():
            if not self._is_whole(place):
                shutil.rmtree(place, ignore_errors=True)  # half made by a process that was killed
                made.rename(place)
            self._touch(name)
        return place

    def begin(self, name: str) -> Path:
        """Return a folder that is filled bit by bit, made where there is none; kept anew."""
        with self._locked():
            (self.root / name).mkdir(parents=True, exist_ok=True, mode=0o700)
            self._touch(name)
        return self.root / name

    def throw_away(self, days: float, needed: Collection[str] = ()) -> list[str]:
        """Throw away what nobody has asked for in so many days; return the ids.

        needed : ids that stay, whatever their age. Whatever comes to need one afterwards has asked
        for it, and it stays as well. Drafts that a crash has left go after a day.
        """
        oldest = self._now() - days * DAY
        gone = [name for name in self._every() if name not in needed and self._leave(name, oldest)]
        self._clear_up()
        return gone

    def _every(self) -> list[str]:
        found = self.root.iterdir() if self.root.is_dir() else ()
        return sorted(place.name for place in found if _ID.fullmatch(place.name))

    def _leave(self, name: str, oldest: float) -> bool:
        """Take a folder away if it is older; it is deleted when nobody waits for the lock."""
        place, aside = self.root / name, self.root / f"{_GONE}{name}"
        with self._locked():
            if not place.is_dir() or place.stat().st_mtime >= oldest:
                return False
            shutil.rmtree(aside, ignore_errors=True)
            place.rename(aside)
        shutil.rmtree(aside, ignore_errors=True)
        return True

    def _clear_up(self) -> None:
        """Delete what processes that were killed have left half done."""
        yesterday = self._now() - DAY
        for place in [*self.root.glob(f"{_DRAFT}*"), *self.root.glob(f"{_GONE}*")]:
            with suppress(FileNotFoundError):
                if place.name.startswith(_GONE) or place.stat().st_mtime < yesterday:
                    shutil.rmtree(place, ignore_errors=True)

    def _is_whole(self, place: Path) -> bool:
        return bool(_ID.fullmatch(place.name)) and (place / self._proof).is_file()

    def _touch(self, name: str) -> None:
        now = self._now()
        os.utime(self.root / name, (now, now))

    @contextmanager
    def _locked(self) -> Iterator[None]:
        self.root.mkdir(parents=True, exist_ok=True, mode=0o700)
        with FileLock(self.root / _LOCK):
            yield
