"""A disk that is full: told apart from other failures, in a sentence that names the folder."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from foldmill.errors import FoldmillError

_FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


class DiskFull(FoldmillError, OSError):
    """Nothing more can be written where something is to be kept."""


def is_full(error: BaseException) -> bool:
    """Tell whether that is why something failed."""
    return isinstance(error, OSError) and error.errno in _FULL


def sentence(place: Path) -> str:
    """Say that the disk of a file or folder is full, how full, and what to do."""
    folder = next(each for each in (place, *place.absolute().parents) if each.is_dir())
    disk = shutil.disk_usage(folder)
    return (
        f"The disk of {folder} is full: {disk.free / 1e6:.1f} MB of {disk.total / 1e6:.0f} MB are "
        "free, or a quota is used up. Make room on it."
    )


@contextmanager
def keeping(place: Path) -> Iterator[None]:
    """Raise DiskFull, which names ``place``, where what is written in this context finds no room.

    An error that names a file of its own names the folder.
    """
    try:
        yield
    except OSError as error:
        if not is_full(error):
            raise
        named = error.filename2 or error.filename
        raise DiskFull(sentence(Path(named) if isinstance(named, str) else place)) from None
