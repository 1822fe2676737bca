"""A parameter that names a file, and holds the sum of its bytes: same parameters, same result.

The sum is taken when the parameters are made and travels with them. A file that has changed since
is refused, so that a design recorded in a FOLD file is made again as it was or not at all. Which
files may be named is for the program to say that takes the parameters (``foldmill.files``).
"""

from __future__ import annotations

from hashlib import sha256

from pydantic import Field, model_validator

from foldmill import ImpossibleGeometry, Params, UnreadableFile
from foldmill.files import content

LARGEST = 50_000_000
"""Bytes of a file that is read."""


class NamedFile(Params):
    """What all targets that are read from a file have."""

    file: str = ""
    """The file's path, from where foldmill runs."""
    sha256: str = Field(default="", pattern="^([0-9a-f]{64})?$")
    """The SHA-256 of its bytes; left out, it is taken from the file. Another file is refused."""

    @model_validator(mode="after")
    def _summed(self) -> NamedFile:
        found, fault = _read(self.file)
        if fault:
            raise ValueError(fault)
        if not self.sha256:
            object.__setattr__(self, "sha256", sha256(found).hexdigest())
        elif sha256(found).hexdigest() != self.sha256:
            raise ValueError(_changed(self.file))
        return self

    def content(self) -> bytes:
        """Return the file's bytes; raises ImpossibleGeometry where it is gone or has changed."""
        found, fault = _read(self.file)
        if not fault and sha256(found).hexdigest() != self.sha256:
            fault = _changed(self.file)
        if fault:
            raise ImpossibleGeometry(f"The target cannot be read: {fault}.")
        return found


def _changed(file: str) -> str:
    return (
        f"{file} has other bytes than when this design was made (SHA-256); bring the old file "
        "back, or leave sha256 out to take the file as it is"
    )


def _read(file: str) -> tuple[bytes, str]:
    """Return the bytes, and what is wrong or nothing."""
    if not file:
        return b"", "this target is read from a file; say which by surface.file"
    try:
        return content(file, LARGEST), ""
    except UnreadableFile as error:
        said = str(error).rstrip(".")
        return b"", said[0].lower() + said[1:]
