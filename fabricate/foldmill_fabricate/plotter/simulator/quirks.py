"""Habits in which real HP-GL machines differ from their manuals, each on demand.

What is a fact of a machine stands in its profile (``lowest``, ``highest``, ``answers``,
``second_in_cancels``); the others are options of the simulator.
"""

from __future__ import annotations

from enum import StrEnum

from foldmill.errors import InvalidInput
from foldmill_fabricate.machines import Machine


class Quirk(StrEnum):
    """One habit; each name is what ``--quirk`` takes."""

    SECOND_IN_CANCELS = "second-in-cancels"
    """An IN that arrives while something waits in the buffer cancels all of it."""
    NEEDS_IN = "needs-in"
    """Nothing but questions is obeyed before the first IN."""
    NEGATIVES_CLAMPED = "negatives-clamped"
    """A coordinate below the lowest is taken for the lowest, without an error."""
    WRAPS = "wraps-16-bit"
    """A number beyond 16 bits comes out at the other end, without an error."""
    ODD_DROPPED = "odd-dropped"
    """Half a pair at the end of a move is dropped without an error."""
    SPLIT_GARBLES = "split-garbles"
    """ESC.B inside an instruction costs that instruction its next byte."""


def parse(text: str) -> frozenset[Quirk]:
    """Read names with commas between them; raises InvalidInput."""
    names = [each.strip() for each in text.split(",") if each.strip()]
    unknown = [each for each in names if each not in set(Quirk)]
    if unknown:
        raise InvalidInput(f"There is no quirk {unknown[0]!r}. There are: {', '.join(Quirk)}.")
    return frozenset(map(Quirk, names))


def habits(machine: Machine) -> frozenset[Quirk]:
    """Return the quirks that a profile states."""
    return frozenset({Quirk.SECOND_IN_CANCELS} if machine.dialect.second_in_cancels else ())


def wrapped(value: int) -> int:
    """Return what is left of a number in 16 bits, two's complement.

    >>> wrapped(32768), wrapped(-5), wrapped(65541)
    (-32768, -5, 5)
    """
    return (value + 0x8000) % 0x10000 - 0x8000
