"""Files that parameters name, such as a picture of heights: which of them may be read.

A command line reads whatever its user may read. A program that takes parameters from strangers
fences them: no file at all, or those of one folder, where names are taken from that folder and
nothing outside is looked at, by whatever path or link. A fence holds for a ``with`` block, or for
the whole process and those it starts; where there are both, a file must be within both. ::

    with fenced(None):                      # parameters that name a file are refused
        design.run(values)
    fence_process(Path("/srv/uploads"))     # or FOLDMILL_FILES=/srv/uploads in the environment
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from foldmill.errors import UnreadableFile

VARIABLE = "FOLDMILL_FILES"
"""Name in the environment: a folder, or "none" for no file at all. Unset: any file."""
NONE = "none"

_block: ContextVar[str | None] = ContextVar("fence", default=None)


@contextmanager
def fenced(folder: Path | None) -> Iterator[None]:
    """Let parameters name files of one folder only, or none, within this block and thread.

    A fence within another narrows it. Threads started within begin without it: fence the process
    where there are any.
    """
    outer, inner = _block.get(), _word(folder)
    token = _block.set(inner if outer is None or _is_within(inner, outer) else NONE)
    try:
        yield
    finally:
        _block.reset(token)


def fence_process(folder: Path | None) -> None:
    """Let parameters name files of one folder only, or none, in this process and its children."""
    os.environ[VARIABLE] = _word(folder)


def _word(folder: Path | None) -> str:
    return NONE if folder is None else str(folder.resolve())


def _is_within(inner: str, outer: str) -> bool:
    return inner == NONE or (outer != NONE and Path(inner).is_relative_to(outer))


def content(name: str, most: int) -> bytes:
    """Return the bytes of a file that parameters name.

    most : bytes it may have. Raises UnreadableFile where it is not there, too large, no plain file,
    or outside a fence; of what is outside it does not even say whether it is there.
    """
    try:
        path = _allowed(name)
        if not path.is_file():
            raise UnreadableFile(f"There is no file {name}.")
        with path.open("rb") as file:
            found = file.read(most + 1)
    except (OSError, ValueError) as error:
        if isinstance(error, UnreadableFile):
            raise
        raise UnreadableFile(f"The file {name} cannot be read ({type(error).__name__}).") from None
    if len(found) > most:
        raise UnreadableFile(f"The file {name} is larger than {most / 1e6:g} MB.")
    return found


def _allowed(name: str) -> Path:
    """Return where a file is, links followed; raises UnreadableFile where a fence forbids it."""
    fences = [each for each in (_block.get(), os.environ.get(VARIABLE)) if each]
    if not fences:
        return Path(name)
    if NONE in fences:
        raise UnreadableFile(
            f"Parameters may not name files here, and these name {name}. Describe it in another "
            "way, or run foldmill on a machine of your own."
        )
    folders = [Path(each).resolve() for each in fences]
    path = (folders[0] / name).resolve()
    if not all(path.is_relative_to(folder) for folder in folders):
        raise UnreadableFile(
            f"The file {name} is outside the folder that parameters may name files of. Put it "
            "there, and name it as it is called there."
        )
    return path
