"""What a shape shall measure: ``height=150``, ``width=220±5``, ``seat=200±2%``."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from foldmill import InvalidInput, UnknownName

USUAL = 0.01
"""Share of its value by which a target may be missed where no tolerance is given."""
NAMES: Mapping[str, str] = {
    "height": "the folded form from its lowest to its highest point",
    "width": "the larger side of its box seen from above, in the design's own frame",
    "width_x": "the side of that box along x, where P_1 lies",
    "width_y": "the side of that box along y",
    "seat": "the largest circle in the level facets at the very top",
    "footprint": "the circle about the axis through the outermost of the lowest points",
}
"""What can be aimed at, all in mm."""
_WRITTEN = re.compile(
    r"(?P<value>[^±+%]+?)\s*(?:(?:±|\+-|\+/-)\s*(?P<by>[^±+%]+?)\s*(?P<share>%)?)?"
)


@dataclass(frozen=True)
class Target:
    """One measure, its value and by how much it may be missed, mm."""

    name: str
    value: float
    tolerance: float

    def __post_init__(self) -> None:
        if self.name not in NAMES:
            raise UnknownName.of("target", self.name, NAMES)
        for said, number in (("value", self.value), ("tolerance", self.tolerance)):
            if not (math.isfinite(number) and number > 0):
                raise InvalidInput(
                    f"The {said} of the target {self.name} must be above 0 mm, not {number:g}."
                )

    @classmethod
    def read(cls, text: str) -> Target:
        """Read name=value, name=value±tolerance (mm) or name=value±share%; ``+-`` stands for ±.

        Raises InvalidInput, UnknownName.
        """
        name, equals, written = (part.strip() for part in text.partition("="))
        found = _WRITTEN.fullmatch(written) if equals else None
        if found is None:
            raise InvalidInput(
                f"--target {text}: write name=value, with ±tolerance in mm or in % where 1 % is "
                f"not right, such as height=150, width=220±5 or seat=200±2%."
            )
        value = _number(text, found["value"])
        by = USUAL * value if found["by"] is None else _number(text, found["by"])
        return cls(name, value, by * value / 100 if found["share"] else by)

    def miss(self, figures: Mapping[str, float]) -> float:
        """Return by how much a form misses the target, mm, positive where it is too large."""
        return figures[self.name] - self.value

    def is_met(self, figures: Mapping[str, float]) -> bool:
        """Tell whether a form is within the tolerance."""
        return abs(self.miss(figures)) <= self.tolerance

    def error(self, figures: Mapping[str, float]) -> float:
        """Return the miss in tolerances, a hundred of them being 1.

        At the usual tolerance that is the share of the value; narrower ones weigh more.
        """
        return USUAL * abs(self.miss(figures)) / self.tolerance


def _number(text: str, word: str) -> float:
    try:
        return float(word.strip())
    except ValueError:
        raise InvalidInput(
            f"--target {text}: {word.strip()!r} is no number; a target is in mm and takes no unit."
        ) from None
