"""A binary DXF as the text it stands for, tag by tag and counted on the way."""

from __future__ import annotations

from foldmill.errors import UnreadableFile
from foldmill.exchange.limits import Limits

MARK = b"AutoCAD Binary DXF"
"""Begins such a file."""
_BEGINS_ENTITY = 0
"""Group code of what begins an entity."""


def as_text(content: bytes, limits: Limits) -> bytes:
    """Return a binary DXF as one in text; raises UnreadableFile for what breaks off.

    Its entities are counted before any is made, and its text is no larger than a file may be.
    """
    from ezdxf.lldxf.tagger import binary_tags_loader

    lines: list[str] = []
    entities = size = 0
    try:
        for tag in binary_tags_loader(content):
            lines.append(f"{tag.code}\n{_plain(tag.value)}\n")
            size += len(lines[-1])
            entities += tag.code == _BEGINS_ENTITY
            limits.check_size(size)
            limits.check_elements(entities)
    except UnreadableFile:
        raise
    except Exception as error:  # a parser of someone else's, over a file of someone else's
        said = " ".join(str(error).split())[:120].rstrip(".") or type(error).__name__
        raise UnreadableFile(
            f"This binary DXF breaks off after {entities} entities ({said}); save it as an ASCII "
            f"DXF."
        ) from None
    return "".join(lines).encode("utf-8", errors="surrogateescape")


def _plain(value: object) -> str:
    """Return a value on one line, numbers with all their digits."""
    if isinstance(value, bytes):
        return value.hex().upper()
    return value.translate(_ENDS) if isinstance(value, str) else repr(value)


_ENDS = str.maketrans("\r\n", "  ")
