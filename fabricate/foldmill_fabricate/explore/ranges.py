"""What a parameter is varied over: ``start:stop:step``, ``start:stop:xCOUNT`` or a list ``a,b,c``.

Values are computed as exact fractions of what was written, so that 0:1:0.1 holds 0.3 and its end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from foldmill_fabricate.errors import CannotExplore

MOST_VALUES = 10_000_000
"""Of one parameter: more would fill the memory before anything is computed."""
FORMS = "name=start:stop:step, name=start:stop:xCOUNT or name=a,b,c"


@dataclass(frozen=True)
class Range:
    """The values one parameter takes, in the unit of its field."""

    name: str
    """Dotted, such as ``points.3.y``."""
    values: tuple[float, ...]
    """In order: rising, or falling where the step is negative."""

    def __post_init__(self) -> None:
        if not self.values:
            raise CannotExplore(f"{self.name} has no values; write {FORMS}.")
        for value in self.values:
            if not math.isfinite(value):
                raise CannotExplore(f"{self.name}: {value} is no finite number.")
        if len(set(self.values)) < len(self.values):
            raise CannotExplore(f"{self.name} takes a value twice; name each value once.")

    @classmethod
    def steps(cls, name: str, start: float, stop: float, step: float) -> Range:
        """Return start, start + step … up to and with stop, where the steps meet it."""
        first, last, by = (_exact(name, value) for value in (start, stop, step))
        if by == 0:
            raise CannotExplore(f"{name}: the step is 0, so {start:g} would never be left.")
        if (last - first) * by < 0:
            raise CannotExplore(
                f"{name}: a step of {step:g} leads away from {stop:g}; "
                f"write {start:g}:{stop:g}:{-step:g}."
            )
        count = (last - first) // by + 1
        return cls(name, _walk(name, first, by, int(count)))

    @classmethod
    def spaced(cls, name: str, start: float, stop: float, count: int) -> Range:
        """Return so many values, evenly spaced, both ends among them."""
        first, last = _exact(name, start), _exact(name, stop)
        if count < 2 or first == last:
            raise CannotExplore(
                f"{name}: {count} values from {start:g} to {stop:g} are no range; "
                "take at least two values and two different ends."
            )
        return cls(name, _walk(name, first, (last - first) / (count - 1), count))

    @classmethod
    def listed(cls, name: str, *values: float) -> Range:
        """Return these values in rising order."""
        return cls(name, tuple(sorted(float(_exact(name, value)) for value in values)))

    @classmethod
    def read(cls, text: str) -> Range:
        """Read ``name=start:stop:step``, ``name=start:stop:xCOUNT`` or ``name=a,b,c``.

        Raises CannotExplore with what is wrong.
        """
        name, equals, said = text.partition("=")
        name = name.strip().removeprefix("--").replace("-", "_")
        if not (name and equals and said.strip()):
            raise CannotExplore(f"{text!r} says not what to vary; write {FORMS}.")
        parts = said.split(":")
        if len(parts) == 1:
            return cls.listed(name, *(_number(name, word) for word in said.split(",")))
        if len(parts) != 3:
            raise CannotExplore(f"{name}: {said!r} has {len(parts)} parts, not 3; write {FORMS}.")
        start, stop = _number(name, parts[0]), _number(name, parts[1])
        last = parts[2].strip()
        if last.startswith(("x", "×")):
            return cls.spaced(name, start, stop, _count(name, last[1:]))
        return cls.steps(name, start, stop, _number(name, last))


def _walk(name: str, first: Fraction, by: Fraction, count: int) -> tuple[float, ...]:
    if count > MOST_VALUES:
        raise CannotExplore(
            f"{name} would take {count:,} values, more than {MOST_VALUES:,}; take a larger step."
        )
    return tuple(float(first + k * by) for k in range(count))


def _exact(name: str, value: float) -> Fraction:
    """Return the number as it is written in decimals; raises CannotExplore where it has no end."""
    if not math.isfinite(value):
        raise CannotExplore(f"{name}: {value} is no finite number.")
    return Fraction(repr(float(value)))


def _number(name: str, word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise CannotExplore(f"{name}: {word.strip()!r} is no number; write {FORMS}.") from None


def _count(name: str, word: str) -> int:
    if not (word.isascii() and word.isdigit()):
        raise CannotExplore(f"{name}: x{word} is no count of values; write {FORMS}.")
    return int(word[:12])
