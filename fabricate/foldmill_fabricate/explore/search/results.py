"""What a search hands back: the best forms, no two of them alike, and no preset."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from foldmill import Fold
from foldmill.check import check
from foldmill_fabricate.errors import DoesNotFit
from foldmill_fabricate.explore.search.fit import require_place
from foldmill_fabricate.explore.search.frame import Values
from foldmill_fabricate.explore.search.island import Island, Member
from foldmill_fabricate.explore.search.measures import measures
from foldmill_fabricate.explore.search.score import Judge
from foldmill_fabricate.explore.search.shape import DISTINCT, Shape
from foldmill_fabricate.explore.search.targets import Target


@dataclass(frozen=True, eq=False)
class Result:
    """One form that was found."""

    start: str
    """The preset it comes from."""
    params: Values
    fold: Fold
    figures: dict[str, float]
    """Measures, mm."""
    error: float
    """How far the targets are missed in all, in shares of their values."""
    missed: tuple[Target, ...]
    """The targets whose tolerance is exceeded; none where all is well."""


def best(judge: Judge, islands: Iterable[Island]) -> list[Result]:
    """Return the best forms of all islands, those that meet every target first."""
    candidates = [(island, member) for island in islands for member in island.found]
    candidates.sort(key=lambda each: (not each[1].verdict.meets, each[1].score, each[0].number))
    known = list(judge.presets)
    chosen: list[Result] = []
    for island, member in candidates:
        if len(chosen) == judge.request.results:
            break
        result = _result(judge, island, member)
        if result is None:
            continue
        shape = Shape.of(result.fold)
        if all(shape.apart(other) > DISTINCT for other in known):
            known.append(shape)
            chosen.append(result)
    return chosen


def _result(judge: Judge, island: Island, member: Member) -> Result | None:
    """Make a form anew and look at all of it again; None where anything is amiss."""
    values = island.frame.at(member.vector)
    fold = judge.design.run(values)
    if check(fold).has_errors:
        return None
    try:
        require_place(fold.pattern.vertices, judge.request.sheet)
    except DoesNotFit:
        return None
    figures = measures(fold, judge.request.sheet)
    targets = judge.request.targets
    missed = tuple(target for target in targets if not target.is_met(figures))
    stated = fold.meta["design"]["params"]
    return Result(island.frame.title, stated, fold, figures, judge.distance(figures), missed)
