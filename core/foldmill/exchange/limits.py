"""How large a file of somebody else may be: said once, and refused with one sentence."""

from __future__ import annotations

from dataclasses import dataclass

from foldmill.errors import UnreadableFile


@dataclass(frozen=True)
class Limits:
    """Bounds on a file that is read; what is above any of them is refused before it costs much."""

    size: int = 64_000_000
    """Bytes of the file."""
    lines: int = 200_000
    """Lines of the drawing, edges of the pattern, each chord of a curve."""
    elements: int = 500_000
    """Elements of an XML file, entities of a DXF file with all its blocks set in."""
    depth: int = 200
    """Elements within elements."""

    def check_size(self, size: int) -> None:
        """Refuse a file of so many bytes; raises UnreadableFile."""
        if size > self.size:
            raise UnreadableFile(
                f"This file has {size / 1e6:.1f} MB; at most {self.size / 1e6:g} MB are read."
            )

    def check_lines(self, count: int) -> None:
        """Refuse a drawing of so many lines; raises UnreadableFile."""
        if count > self.lines:
            raise UnreadableFile(
                f"This file has more than {self.lines:,} lines, which is the most that is read. "
                f"Divide the pattern, or leave out what is no crease."
            )

    def check_elements(self, count: int) -> None:
        """Refuse a file of so many elements; raises UnreadableFile."""
        if count > self.elements:
            raise UnreadableFile(
                f"This file has more than {self.elements:,} elements, which is the most that is "
                f"read."
            )


DEFAULT = Limits()
"""What a person's own computer reads."""
