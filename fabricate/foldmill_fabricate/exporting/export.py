"""A pattern as the bytes of a file for one program."""

from __future__ import annotations

from dataclasses import dataclass

from foldmill import Fold, FoldmillError, UnknownName
from foldmill_fabricate.errors import CannotHold
from foldmill_fabricate.exporting.programs import PROGRAMS


@dataclass(frozen=True)
class Exported:
    """A file for another program."""

    content: bytes
    lost: tuple[str, ...]
    """Sentences on what the file does not hold of the pattern."""


def export(fold: Fold, program: str, suffix: str, *, lossy: bool = False) -> Exported:
    """Return a pattern as a file that a program reads.

    program : a slug of PROGRAMS; suffix : such as ``.fold``.
    lossy : whether the file is wanted even where it does not hold all. Raises UnknownName for a
    program nobody knows, FoldmillError for a kind of file it does not read, and CannotHold, with
    what would be lost.
    """
    if program not in PROGRAMS:
        raise UnknownName.of("profile", program, PROGRAMS)
    offered = PROGRAMS[program]
    writer = offered.files.get(suffix.lower())
    if writer is None:
        raise FoldmillError(
            f"{program} is written as {' or '.join(offered.files)}, not {suffix or 'that'}."
        )
    name = offered.title.partition(":")[0]
    lost = tuple(said for loss in writer.losses for said in loss(fold, name))
    if lost and not lossy:
        raise CannotHold(" ".join(lost))
    return Exported(writer.write(fold), lost)
