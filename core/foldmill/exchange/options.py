"""What a person can say of a file that the file itself does not say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite

from foldmill.errors import InvalidInput
from foldmill.exchange.keys import MILLIMETRES

UNITS = MILLIMETRES | {"px": 25.4 / 96}
"""mm per unit; a px is that of CSS, 96 to the inch."""
LETTERS = "BMVFUC"
SKIP = "skip"
"""Said of lines that are left out."""
OTHER = "other"
"""Stands for every colour and layer that nothing else is said of."""
SIDES = ("front", "back")
BY = ("auto", "layer", "colour")
LOOSE = ("refuse", "drop")
RADIANS = "radians"
ANGLES = ("degrees", RADIANS)


@dataclass(frozen=True)
class Options:
    """How to take a file; the defaults take it as it is and ask where that is not enough.

    Raises InvalidInput, naming the option, for a value that means nothing.
    """

    unit: str | None = None
    """What a unit of the file is, one of UNITS, whatever the file says."""
    scale: float | None = None
    """How many times as large as the file says; mm per unit where it says nothing."""
    width: float | None = None
    """mm: how wide the pattern is, whatever the file says; scales it."""
    side: str = "front"
    """Which face of the sheet the file shows; from the back, mountains are valleys."""
    mirror: bool = False
    """True for a mirror image, as programs make that copy y downward as y upward."""
    frame: int | None = None
    """FOLD: the number of the frame that is the pattern, 0 for the first."""
    by: str = "auto"
    """Whether layers or colours say what lines are; layers first, where neither is asked for."""
    named: Mapping[str, str] = field(default_factory=dict)
    """Colour (#rrggbb or a CSS name) or layer → one of LETTERS, or SKIP; OTHER for all others."""
    gap: float | None = None
    """mm within which ends of lines meet; by default a ten-thousandth of the sheet's size."""
    loose: str = "refuse"
    """What becomes of lines that end inside the sheet: "refuse" or "drop"."""
    planarise: bool = False
    """FOLD: whether lines that cross or lie on each other are mended; other formats always are."""

    angles: str | None = None
    """FOLD: what its fold angles are in, one of ANGLES; degrees, where they can be, by default."""

    def __post_init__(self) -> None:
        for name in ("scale", "width", "gap"):
            value = getattr(self, name)
            if value is not None and not (isfinite(value) and 0 < value <= 1e9):
                raise InvalidInput(f"--{name} must be a positive number, not {value:g}.")
        for name, known in (("side", SIDES), ("by", BY), ("loose", LOOSE)):
            _one_of(name, getattr(self, name), known)
        if self.angles is not None:
            _one_of("angles", self.angles, ANGLES)
        if self.unit is not None:
            _one_of("unit", self.unit, tuple(UNITS))
        if self.width is not None and (self.scale is not None or self.unit is not None):
            raise InvalidInput("--width says it all; leave out --unit and --scale with it.")
        for name, letter in self.named.items():
            _one_of(f"as {name}", letter, (*LETTERS, SKIP))


def _one_of(name: str, value: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise InvalidInput(f"--{name}: there is no {value!r}; say one of {', '.join(known)}.")


def named(said: list[str]) -> dict[str, str]:
    """Return what "NAME=LETTER" says, item by item; raises InvalidInput for anything else."""
    found: dict[str, str] = {}
    for each in said:
        name, equals, letter = each.rpartition("=")
        if not equals or not name.strip():
            raise InvalidInput(
                f"--as takes a colour or layer and what it means, as '#ff8800=M'; not {each!r}."
            )
        word = letter.strip()
        found[name.strip()] = SKIP if word.lower() == SKIP else word.upper()
    return found
