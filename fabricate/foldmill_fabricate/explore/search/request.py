"""What is asked of a search."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from foldmill import InvalidInput
from foldmill_fabricate.explore.search.fit import Room
from foldmill_fabricate.explore.search.targets import Target

EVALUATIONS = 2400
"""Forms that are folded and measured: half a minute to a minute for a stool on two cores."""
LEAST = 60
"""Fewer are no search."""


@dataclass(frozen=True)
class Request:
    """Targets, limits and effort. Raises InvalidInput where nothing on earth can meet them."""

    targets: tuple[Target, ...]
    sheet: Room
    least_crease: float
    """mm. Nothing in the pattern is shorter."""
    fixed: Mapping[str, float] = field(default_factory=dict)
    """Parameters that are given, by dotted name."""
    vary: tuple[str, ...] = ()
    """Which parameters vary, by dotted name, ``*`` standing for any; none: all that can."""
    presets: tuple[str, ...] = ()
    """Where to start; none: from every preset and the defaults."""
    seed: int = 0
    results: int = 5
    evaluations: int = EVALUATIONS

    def __post_init__(self) -> None:
        for holds, said in (
            (self.sheet.width > 0 and self.sheet.height > 0, "The sheet must be larger than 0 mm."),
            (math.isfinite(self.sheet.diagonal), "The sheet must have an end."),
            (self.least_crease >= 0, "The shortest crease cannot be below 0 mm."),
            (self.results >= 1, f"One result at least must be asked for, not {self.results}."),
            (
                self.evaluations >= LEAST,
                f"A search takes {LEAST} evaluations at least, not {self.evaluations}.",
            ),
            (self.seed >= 0, f"The seed must be 0 or more, not {self.seed}."),
            (bool(self.targets), "Name a target, such as height=150: what shall be searched for?"),
        ):
            if not holds:
                raise InvalidInput(said)
        self._refuse_doubles()
        self._refuse_larger_than_paper()

    def _refuse_doubles(self) -> None:
        names = [target.name for target in self.targets]
        for name in names:
            if names.count(name) > 1:
                raise InvalidInput(f"The target {name} is named twice; leave one of them out.")

    def _refuse_larger_than_paper(self) -> None:
        for target in self.targets:
            longest = self.sheet.diagonal
            if target.name == "footprint":
                continue  # twice a radius: its two ends need not be on paper
            if target.value - target.tolerance > longest:
                raise InvalidInput(
                    f"A {target.name} of {target.value:g} mm cannot be folded from a sheet of "
                    f"{self.sheet.width:g} × {self.sheet.height:g} mm: its diagonal is "
                    f"{longest:.1f} mm, {target.value - target.tolerance - longest:.1f} mm too few."
                )
