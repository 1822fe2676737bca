"""A line of G-code, read as GRBL 1.1 reads it: words, modal groups, and which error a wrong one is.

Known here: G0 G1 G4 G20 G21 G90 G91, M3 M4 M5, F S X Y Z P N, and of what changes nothing for a
plotter G17 G40 G49 G54 G61 G80 G94, M0 M1 M2 M7 M8 M9 M30, T. Anything else is error 20.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

LETTER, NUMBER, DOLLAR, LOCKED, TOO_LONG = 1, 2, 3, 9, 11
UNSUPPORTED, SAME_GROUP, NO_FEED, NOT_WHOLE, REPEATED, MISSING, UNUSED = 20, 21, 22, 23, 25, 28, 36
"""Errors, as ``error:n`` tells them."""

LONGEST_LINE = 80
"""Characters, without spaces and comments."""
_COMMENTS = re.compile(r"\([^)]*\)?|;.*|\s+")
_WORD = re.compile(r"([A-Z])([+-]?(?:\d+\.?\d*|\.\d+))")
_LARGEST = 1e6
_GROUPS = {
    **dict.fromkeys(("G0", "G1", "G80"), "motion"),
    "G4": "dwell",
    **dict.fromkeys(("G20", "G21"), "units"),
    **dict.fromkeys(("G90", "G91"), "distance"),
    **dict.fromkeys(("G17",), "plane"),
    **dict.fromkeys(("G40",), "radius"),
    **dict.fromkeys(("G49",), "length"),
    **dict.fromkeys(("G54",), "origin"),
    **dict.fromkeys(("G61",), "path"),
    **dict.fromkeys(("G94",), "feed"),
    **dict.fromkeys(("M3", "M4", "M5"), "spindle"),
    **dict.fromkeys(("M0", "M1", "M2", "M30"), "stop"),
    **dict.fromkeys(("M7", "M8", "M9"), "coolant"),
}
_VALUES = frozenset("FSXYZPNT")


class Refused(Exception):
    """A line that GRBL answers with an error."""

    def __init__(self, number: int) -> None:
        super().__init__(f"error:{number}")
        self.number = number


@dataclass
class Block:
    """The words of one line: codes by modal group, values by letter."""

    codes: dict[str, str] = field(default_factory=dict)
    values: dict[str, float] = field(default_factory=dict)

    @property
    def axes(self) -> bool:
        """Whether it names a place."""
        return any(letter in self.values for letter in "XYZ")


def bare(line: str) -> str:
    """Return a line without comments and spaces, in capitals.

    >>> bare("g1 x2.5 (there) f600 ; slowly")
    'G1X2.5F600'
    """
    return _COMMENTS.sub("", line).upper()


def read(line: str) -> Block:
    """Read a bare line; raises Refused."""
    block, at = Block(), 0
    while at < len(line):
        found = _WORD.match(line, at)
        if not found:
            raise Refused(NUMBER if line[at].isalpha() else LETTER)
        _take(block, found[1], float(found[2]))
        at = found.end()
    _judge(block)
    return block


def _take(block: Block, letter: str, value: float) -> None:
    if letter in "GM":
        if value != int(value):
            raise Refused(UNSUPPORTED if letter == "G" else NOT_WHOLE)
        code = f"{letter}{int(value)}"
        if code not in _GROUPS:
            raise Refused(UNSUPPORTED)
        if _GROUPS[code] in block.codes:
            raise Refused(SAME_GROUP)
        block.codes[_GROUPS[code]] = code
    elif letter not in _VALUES:
        raise Refused(UNUSED if letter in "IJKLQR" else UNSUPPORTED)
    elif letter in block.values:
        raise Refused(REPEATED)
    else:
        block.values[letter] = max(-_LARGEST, min(_LARGEST, value))


def _judge(block: Block) -> None:
    dwell = "dwell" in block.codes
    if dwell and "P" not in block.values:
        raise Refused(MISSING)
    if ("P" in block.values and not dwell) or (dwell and block.axes):
        raise Refused(UNUSED)
    if block.values.get("F", 0.0) < 0 or block.values.get("S", 0.0) < 0:
        raise Refused(4)  # negative value
