"""Small disks that fill up: file systems in memory, of which a test says when they are full."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from errno import ENOSPC
from pathlib import Path

import pytest

_PAGE = 4096


class Disk:
    """A file system of its own; place : where it is mounted."""

    def __init__(self, place: Path) -> None:
        self.place = place
        self._filler = place / "filler"

    def fill(self) -> None:
        """Let somebody else's file take all the room that is left."""
        with self._filler.open("ab", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(_PAGE))
            except OSError as error:
                if error.errno != ENOSPC:
                    raise

    def free(self) -> None:
        """Take that file away."""
        self._filler.unlink()


@contextmanager
def small_disk(place: Path, megabytes: float) -> Iterator[Disk]:
    """Mount one while the context lasts; who may mount none skips the test."""
    place.mkdir(parents=True)
    options = f"size={int(megabytes * 1024)}k,mode=0755"
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", options, "foldmill", str(place)], capture_output=True
    )
    if mounted.returncode:
        assert os.geteuid() != 0 or b"permitted" in mounted.stderr, mounted.stderr
        pytest.skip("only the superuser may mount a disk to fill it up")
    try:
        yield Disk(place)
    finally:
        subprocess.run(["umount", "--lazy", str(place)], check=True)
