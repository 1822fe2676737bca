"""Job folders as one ZIP file: packed by a client, unpacked in the sandbox."""

from __future__ import annotations

import errno
import io
import re
import struct
import zipfile
import zlib
from pathlib import Path

from foldmill.errors import UnreadableFile

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,100}")
"""Of a file; none of them is a path."""
_MOST_FILES = 300
_MOST_BYTES = 128 << 20
"""Of all files together, unpacked."""
_WAYS = frozenset({zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED})
"""How files may be packed: what every program writes, and nothing that unpacks a thousandfold."""
_BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    RuntimeError,  # encrypted
    NotImplementedError,
    EOFError,
    ValueError,  # names in no encoding
    OverflowError,
)
"""What is raised where a file is not what its headers say."""


def pack(folder: Path) -> bytes:
    """Return the files of a folder as a ZIP file; raises OSError."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as out:
        for file in sorted(folder.iterdir()):
            if file.is_file() and _NAME.fullmatch(file.name):
                out.write(file, file.name)
    return made.getvalue()


def unpack(file: Path, folder: Path) -> None:
    """Unpack a ZIP file into a new folder; raises UnreadableFile, before it takes much room."""
    folder.mkdir()
    try:
        with zipfile.ZipFile(file) as packed:
            every = packed.infolist()
            _refuse(every)
            left = _MOST_BYTES
            for one in every:
                left -= _write(packed, one, folder, left)
    except UnreadableFile:
        raise
    except (*_BROKEN, OSError) as error:
        if isinstance(error, OSError) and error.errno != errno.EINVAL:
            raise  # of the disk; that one is of a place before the beginning
        raise UnreadableFile(f"This is no ZIP file of a job folder: {error}.") from None


def _refuse(every: list[zipfile.ZipInfo]) -> None:
    if len(every) > _MOST_FILES:
        raise UnreadableFile(f"It holds {len(every):,} files; a job folder has few.")
    for one in every:
        if not _NAME.fullmatch(one.filename):
            raise UnreadableFile(f"{one.filename[:60]!r} is no name of a file in a job folder.")
        if one.compress_type not in _WAYS:
            raise UnreadableFile(f"{one.filename} is packed in an unusual way; use deflate.")


def _write(packed: zipfile.ZipFile, one: zipfile.ZipInfo, folder: Path, left: int) -> int:
    """Write one file, whatever its header says of its size; return the bytes of it."""
    with packed.open(one) as source:
        content = source.read(left + 1)
    if len(content) > left:
        raise UnreadableFile(
            f"Unpacked it is larger than {_MOST_BYTES >> 20} MB; leave drawings out."
        )
    (folder / one.filename).write_bytes(content)
    return len(content)
