"""The search itself: many starts looked at, the best of them evolved in rounds, on all cores.

How much is done is counted in forms that are folded and measured, never in seconds, so that the
same seed gives the same results on any machine and any number of cores.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from joblib import Parallel, delayed

from foldmill import Design
from foldmill_fabricate.explore.search import starts
from foldmill_fabricate.explore.search.frame import Frame
from foldmill_fabricate.explore.search.island import MEMBERS, Island, evolve, settle
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
    can be started from.
    """
    begun = time.monotonic()
    judge = Judge.of_family(design, request)
    frames = starts.frames(design, request)
    steps = 1 + ROUNDS
    with Parallel(n_jobs=jobs) as workers:
        islands = _scouted(judge, frames, workers)
        used = len(islands) * (SAMPLES + 1)
        tell("starts", 1, steps, _least(islands))
        left: list[Island] = []
        stopped = False
        alive = _chosen(islands, request.evaluations)
        round_took = 0.0
        for stage, generations in enumerate(_plan(len(alive), request.evaluations - used)):
            now = time.monotonic()
            stopped = now + round_took > begun + seconds
            if stopped:
                break
            alive = list(workers(delayed(evolve)(judge, i, stage, generations) for i in alive))
            used += len(alive) * generations * MEMBERS
            round_took = time.monotonic() - now
            alive.sort(key=lambda island: (island.score, island.number))
            tell(f"round {stage + 1}", 2 + stage, steps, _least(alive))
            keep = _after(len(alive))
            left, alive = left + alive[keep:], alive[:keep]
    known = {island.number for island in (*alive, *left)}
    rest = [island for island in islands if island.number not in known]
    return Outcome(best(judge, [*alive, *left, *rest]), used, stopped)


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
    ranked = sorted(islands, key=lambda island: (island.score, island.number))
    first = {island.frame.title: island for island in reversed(ranked)}
    leading = [island for island in ranked if first[island.frame.title] is island]
    others = [island for island in ranked if first[island.frame.title] is not island]
    most = min(MOST_ISLANDS, max(LEAST_ISLANDS, evaluations // PER_ISLAND))
    return [*leading, *others][:most]


def _plan(islands: int, evaluations: int) -> Iterator[int]:
    """Yield the generations of each round, so that each takes about the same number of forms."""
    for _ in range(ROUNDS):
        yield max(1, evaluations // (ROUNDS * islands * MEMBERS))
        islands = _after(islands)


def _after(islands: int) -> int:
    """Return how many islands go on after a round."""
    return min(islands, max(LEAST_ISLANDS, 2 * islands // 3))


def _least(islands: list[Island]) -> float:
    return min(island.score for island in islands)
