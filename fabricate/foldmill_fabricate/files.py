"""Write files so that they are there whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Mapping
from errno import EISDIR
from pathlib import Path


def write_whole(path: Path, content: bytes) -> None:
    """Write a file by an atomic rename; an older file stays until the new one is complete.

    Raises OSError that names the file, not its draft.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        _rename(path, content)
    except OSError as error:
        raise type(error)(error.errno, error.strerror, str(path)) from None


def require_place(path: Path) -> None:
    """Raise OSError that names a file which could not be written, before any work is done for it.

    Where its folder is not there yet, the nearest folder above it is tried; nothing stays there.
    """
    folder = next(each for each in path.absolute().parents if each.exists())
    try:
        if path.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR))
        with tempfile.NamedTemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise type(error)(error.errno, error.strerror, str(path)) from None


def _rename(path: Path, content: bytes) -> None:
    handle, draft = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as out:
            out.write(content)
        Path(draft).chmod(0o644)
        Path(draft).replace(path)
    except BaseException:
        Path(draft).unlink(missing_ok=True)
        raise


def write_all(folder: Path, contents: Mapping[str, bytes], stale: Iterable[str] = ()) -> None:
    """Write files into a folder, the last name last, and remove those of an older run."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in set(stale) - set(contents):
        (folder / name).unlink(missing_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
