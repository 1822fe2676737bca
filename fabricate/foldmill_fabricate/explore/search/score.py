"""How good a form is: one number, 0 where every target is met to the point and nothing is amiss."""

from __future__ import annotations

from dataclasses import dataclass
from math import fsum
from typing import Any

from foldmill import Design, Fold, InvalidInput
from foldmill.check import check
from foldmill_fabricate.explore.search.frame import Values
from foldmill_fabricate.explore.search.measures import measures
from foldmill_fabricate.explore.search.request import Request
from foldmill_fabricate.explore.search.shape import DISTINCT, Shape

NOTHING = 1e3
"""The score of parameters that fold to nothing."""
OVER, SHORT, BROKEN = 2.0, 0.5, 1.0
"""What a sheet that is exceeded, a crease that is too short and a form that fails its checks cost;
the first two in shares of the sheet and of the shortest crease."""
ALIKE = 0.05
"""What a form costs that is the very shape of a preset or of one that was found before; the less,
the farther it is away."""
COMFORT, EASE = 10.0, 0.002
"""A shortest crease of so many times the least one leaves nothing to wish for, and how much one
that is shorter may cost: no more than a fifth of a percent of one target."""


@dataclass(frozen=True)
class Verdict:
    """What became of parameters."""

    score: float
    """Lower is better."""
    figures: dict[str, float] | None = None
    """Measures, mm; None where nothing folds."""
    is_sound: bool = False
    """Whether the checks found no error; False also where they were not asked."""
    meets: bool = False
    """Whether it is sound, fits, and is within the tolerance of every target."""
    shape: Shape | None = None
    """Its shape where it is sound."""


@dataclass(frozen=True, eq=False)
class Judge:
    """Scores parameters of one family for one request."""

    design: Design[Any]
    request: Request
    presets: tuple[Shape, ...] = ()
    """Shapes that are there already: a result is none of them."""

    @classmethod
    def of_family(cls, design: Design[Any], request: Request) -> Judge:
        """Return a judge who knows the family's presets."""
        folds = [design.run(params) for params in design.presets.values()]
        return cls(design, request, tuple(Shape.of(fold) for fold in folds if fold.folded))

    def fold(self, values: Values) -> Fold | None:
        """Return the fold; None where there is none."""
        try:
            return self.design.run(values)
        except InvalidInput:
            return None

    def verdict(
        self, values: Values, beat: float = float("inf"), found: tuple[Shape, ...] = ()
    ) -> Verdict:
        """Score parameters; the checks are asked only where the rest is better than ``beat``.

        found : shapes that are not wanted again.
        """
        fold = self.fold(values)
        if fold is None or fold.folded is None:
            return Verdict(NOTHING)
        return self._of(fold, beat, found)

    def _of(self, fold: Fold, beat: float, found: tuple[Shape, ...]) -> Verdict:
        wanted = {target.name for target in self.request.targets}
        figures = measures(fold, self.request.sheet, seat="seat" in wanted)
        shape = Shape.of(fold)
        score = self.distance(figures) + self.excess(figures) + self._unease(figures)
        score += _likeness(shape, (*self.presets, *found))
        if score >= beat:
            return Verdict(score, figures)
        report = check(fold)
        if report.has_errors:
            pairs = float(report.figures.get("penetrations", 0))
            return Verdict(score + BROKEN + pairs / len(fold.pattern.faces), figures)
        meets = self.excess(figures) == 0
        meets &= all(target.is_met(figures) for target in self.request.targets)
        return Verdict(score, figures, True, meets, shape)

    def distance(self, figures: dict[str, float]) -> float:
        """Return how far the targets are missed, in shares of their values."""
        return fsum(target.error(figures) for target in self.request.targets)

    def excess(self, figures: dict[str, float]) -> float:
        """Return what sheet and shortest crease cost; 0 where both are kept."""
        sheet, least = self.request.sheet, self.request.least_crease
        over = OVER * figures["over"] / max(sheet.width, sheet.height)
        lacking = max(0.0, least - figures["crease"])
        return over + (SHORT * (lacking / least) if lacking else 0.0)

    def _unease(self, figures: dict[str, float]) -> float:
        comfort = COMFORT * self.request.least_crease
        return EASE * max(0.0, 1 - figures["crease"] / comfort) if comfort else 0.0


def _likeness(shape: Shape, known: tuple[Shape, ...]) -> float:
    nearest = min((shape.apart(other) for other in known), default=DISTINCT)
    return ALIKE * max(0.0, 1 - nearest / DISTINCT)
