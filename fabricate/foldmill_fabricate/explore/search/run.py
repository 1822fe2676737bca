"""The search itself: many starts looked at, the best of them evolved in rounds, on all cores.

How much is done is counted in forms that are folded and measured, never in seconds, so that the
same seed gives the same results on any machine and any number of cores.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from joblib import Parallel, delayed

from foldmill import Design, InvalidInput
from foldmill_fabricate.explore.search import starts
from foldmill_fabricate.explore.search.frame import Frame
from foldmill_fabricate.explore.search.island import MEMBERS, Island, evolve, settle
from foldmill_fabricate.explore.search.measures import seat_width
from foldmill_fabricate.explore.search.request import Request
from foldmill_fabricate.explore.search.results import Result, best
from foldmill_fabricate.explore.search.score import Judge

SCOUTING = 0.25
"""Share of the evaluations that goes into looking at starts."""
SAMPLES = 8
"""Forms looked at per start or variant."""
PER_ISLAND = 300
"""Evaluations that an island is worth: with few of them, few islands."""
MOST_ISLANDS, LEAST_ISLANDS, ROUNDS = 8, 2, 5
"""Islands that evolve in the first round; in each later one, the worst third is left behind."""

Tell = Callable[[str, int, int, float], None]
"""Told of every step: stage, step, steps in all, best score so far."""


@dataclass(frozen=True)
class Outcome:
    """What a search found."""

    results: list[Result]
    evaluations: int
    """About how many forms were folded and measured."""
    stopped: bool
    """Whether time ran out before the work was done; then another run may find other results."""


def search(
    design: Design[Any],
    request: Request,
    *,
    jobs: int = 1,
    seconds: float = float("inf"),
    tell: Tell = lambda *_: None,
) -> Outcome:
    """Look for parameters of a family that meet a request.

    jobs : processes, -1 for one per core; seconds : no round begins that would end later, going by
    the one before. Raises UnknownName for a preset there is not, InvalidParameters where nothing
    can be started from, InvalidInput for a seat that no start has.
    """
    begun = time.monotonic()
    frames = starts.frames(design, request)
    _refuse_no_seat(design, request, frames)
    judge = Judge.of_family(design, request)
    with Parallel(n_jobs=jobs) as workers:
        islands = _scouted(judge, frames, workers)
        used = len(islands) * (SAMPLES + 1)
        alive = _chosen(islands, request.evaluations)
        plan = _plan(len(alive), request.evaluations - used)
        tell("starts", 1, 1 + len(plan), _least(islands))
        took = 0.0
        for stage, generations in enumerate(plan, 1):
            now = time.monotonic()
            if now + took > begun + seconds:
                return Outcome(best(judge, islands), used, True)
            alive = list(workers(delayed(evolve)(judge, i, stage, generations) for i in alive))
            used += len(alive) * generations * MEMBERS
            islands = _renewed(islands, alive)
            tell(f"round {stage}", 1 + stage, 1 + len(plan), _least(alive))
            alive = sorted(alive, key=_rank)[: _after(len(alive))]
            took = time.monotonic() - now
    return Outcome(best(judge, islands), used, False)


def _refuse_no_seat(design: Design[Any], request: Request, frames: list[Frame]) -> None:
    """Refuse a seat where no start has one: level facets are never met by chance."""
    wanted = [target.name for target in request.targets]
    if "seat" not in wanted:
        return
    if not any(seat_width(design.run(frame.values)) for frame in frames):
        raise InvalidInput(
            f"No form of {design.slug} to start from has a seat: none has level facets at its top. "
            "Leave the target seat out, take another family, or state the parameters that make "
            "its top level."
        )


def _renewed(islands: list[Island], evolved: list[Island]) -> list[Island]:
    """Return all islands, each as it is now."""
    newer = {island.number: island for island in evolved}
    return [newer.get(island.number, island) for island in islands]


def _rank(island: Island) -> tuple[float, int]:
    return island.score, island.number


def _scouted(judge: Judge, frames: list[Frame], workers: Any) -> list[Island]:
    """Look at every start, and at random variants of them in turn."""
    request = judge.request
    count = max(len(frames), int(SCOUTING * request.evaluations) // (SAMPLES + 1))
    tried = list(frames)
    for number in range(len(frames), count):
        rng = np.random.default_rng([request.seed, number, len(frames)])
        tried.append(starts.variant(judge.design, request, frames[number % len(frames)], rng))
    return list(workers(delayed(settle)(judge, k, each, SAMPLES) for k, each in enumerate(tried)))


def _chosen(islands: list[Island], evaluations: int) -> list[Island]:
    """Return the islands that evolve: the best of each start first, then the best of the rest."""
    ranked = sorted(islands, key=_rank)
    first = {island.frame.title: island for island in reversed(ranked)}
    leading = [island for island in ranked if first[island.frame.title] is island]
    others = [island for island in ranked if first[island.frame.title] is not island]
    most = min(MOST_ISLANDS, max(LEAST_ISLANDS, evaluations // PER_ISLAND))
    return [*leading, *others][:most]


def _plan(islands: int, evaluations: int) -> list[int]:
    """Return the generations of each round, so that each takes about the same number of forms."""
    rounds = min(ROUNDS, max(1, evaluations // (islands * MEMBERS)))
    plan = []
    for _ in range(rounds):
        plan.append(max(1, evaluations // (rounds * islands * MEMBERS)))
        islands = _after(islands)
    return plan


def _after(islands: int) -> int:
    """Return how many islands go on after a round."""
    return min(islands, max(LEAST_ISLANDS, 2 * islands // 3))


def _least(islands: list[Island]) -> float:
    return min(island.score for island in islands)
