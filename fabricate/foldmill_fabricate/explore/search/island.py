"""A population of forms of one frame that evolves: differential evolution, seeded and in rounds.

Each member is pulled towards one of the best and pushed along the difference of two others
(current-to-pbest/1/bin: J. Zhang, A. Sanderson, JADE, IEEE Trans. Evol. Comput. 13, 2009); now and
then a member is made as large instead as suits the targets best. What is better replaces its
parent. A round depends on its seed alone, not on who computes it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.explore.search.frame import Frame
from foldmill_fabricate.explore.search.score import NOTHING, Judge, Verdict
from foldmill_fabricate.explore.search.shape import DISTINCT, Shape

Floats = NDArray[np.float64]

MEMBERS = 20
BEST = 4
"""Members towards which the others are pulled."""
RESIZE = 0.1
"""How often a member is resized instead."""
SPREAD = (-2.0, 0.0)
"""Decades of how far the first members lie from the start, in units of the vector."""
KEPT = 12
"""How many sound forms an island remembers, no two of them alike."""
DONE = 0.003
"""The score at which a form is good enough: the island turns to others."""
CLOSE = 0.02
"""Units. A population no wider than this has found its place; it is spread anew about it."""


@dataclass(frozen=True, eq=False)
class Member:
    """A vector and what became of it."""

    vector: Floats
    verdict: Verdict

    @property
    def score(self) -> float:
        """Lower is better."""
        return self.verdict.score


@dataclass(frozen=True, eq=False)
class Island:
    """A population of one frame, and what it has found."""

    number: int
    frame: Frame
    members: tuple[Member, ...]
    found: tuple[Member, ...] = ()
    """Sound forms that keep sheet and shortest crease, the best first."""
    done: tuple[Shape, ...] = ()
    """Shapes that are good enough, and not wanted again."""

    @property
    def score(self) -> float:
        """The best so far."""
        return min(each.score for each in (*self.members, *self.found[:1]))


def settle(judge: Judge, number: int, frame: Frame, samples: int) -> Island:
    """Return an island about a start: resized to suit the targets, and seeded samples around."""
    rng = np.random.default_rng([judge.request.seed, number])
    at, members = np.zeros(len(frame.variables)), []
    for k in range(samples):
        tried = at if k == 0 else at + _about(rng, len(at))
        member = Member(tried, judge.verdict(frame.at(tried)))
        factor = _fitting(judge, member)
        if k == 0 and factor is not None:
            at = frame.scaled(at, factor)
            members.append(Member(at, judge.verdict(frame.at(at))))
        members.append(member)
    return _remembering(judge, Island(number, frame, tuple(members)), members)


def evolve(judge: Judge, island: Island, stage: int, generations: int) -> Island:
    """Return the island some generations later; ``stage`` makes its random numbers its own."""
    rng = np.random.default_rng([judge.request.seed, island.number, stage])
    members = _peopled(judge, island, rng)
    seen: list[Member] = list(members)
    for _ in range(generations):
        best = min(members, key=lambda each: each.score)
        is_done = best.verdict.meets and best.score <= DONE
        if is_done and best.verdict.shape is not None:
            island = replace(island, done=(*island.done, best.verdict.shape))
        if is_done or _width(members) < CLOSE:
            members = _spread(judge, island, best, rng)
        else:
            members = _generation(judge, island, members, rng)
        seen += members
    return _remembering(judge, replace(island, members=tuple(members)), seen)


def _peopled(judge: Judge, island: Island, rng: np.random.Generator) -> list[Member]:
    """Return as many members as an island has, new ones near the best of those there are."""
    members = sorted(island.members, key=lambda each: each.score)[:MEMBERS]
    best = members[0].vector
    while len(members) < MEMBERS:
        vector = best + _about(rng, len(best))
        members.append(_judged(judge, island, vector))
    return members


def _spread(judge: Judge, island: Island, best: Member, rng: np.random.Generator) -> list[Member]:
    """Return new members around one, and that one as it is judged now."""
    vectors = [best.vector + _about(rng, len(best.vector)) for _ in range(MEMBERS - 1)]
    return [_judged(judge, island, vector) for vector in (best.vector, *vectors)]


def _judged(judge: Judge, island: Island, vector: Floats, beat: float = float("inf")) -> Member:
    verdict = judge.verdict(island.frame.at(vector), beat, island.done)
    return Member(vector, verdict)


def _generation(
    judge: Judge, island: Island, members: list[Member], rng: np.random.Generator
) -> list[Member]:
    """Return the next members."""
    order = sorted(range(len(members)), key=lambda k: (members[k].score, k))
    after = list(members)
    for k, parent in enumerate(members):
        vector = _child(judge, island.frame, members, order, k, rng)
        child = _judged(judge, island, vector, beat=parent.score)
        if child.score < parent.score:
            after[k] = child
    return after


def _child(
    judge: Judge,
    frame: Frame,
    members: list[Member],
    order: list[int],
    k: int,
    rng: np.random.Generator,
) -> Floats:
    parent = members[k]
    pull, push = rng.uniform(0.3, 0.9, 2).tolist()
    rate = (0.4, 0.9)[int(rng.integers(2))]
    guide = members[order[int(rng.integers(BEST))]].vector
    one, two = (members[int(j)].vector for j in rng.choice(len(members), 2, replace=False))
    crossed = rng.random(len(guide)) < rate
    if len(guide):
        crossed[int(rng.integers(len(guide)))] = True
    resized = rng.random() < RESIZE
    factor = _fitting(judge, parent) if resized else None
    if factor is not None:
        return frame.scaled(parent.vector, factor)
    moved = parent.vector + pull * (guide - parent.vector) + push * (one - two)
    child: Floats = np.where(crossed, moved, parent.vector)
    return child


def _about(rng: np.random.Generator, count: int) -> Floats:
    step: Floats = 10 ** rng.uniform(*SPREAD) * rng.standard_normal(count)
    return step


def _width(members: list[Member]) -> float:
    vectors = np.array([each.vector for each in members])
    return float(np.ptp(vectors, axis=0).max(initial=0.0))


def _fitting(judge: Judge, member: Member) -> float | None:
    """Return how many times as large a form should be; None where it does not fold."""
    figures = member.verdict.figures
    if figures is None:
        return None
    sheet, wanted = judge.request.sheet, judge.request.targets
    ratios = [t.value / figures[t.name] for t in wanted if figures[t.name] > 0]
    if not ratios:
        return None
    beside = 2 * sheet.clearance
    most = min(
        (sheet.width - beside) / max(figures["sheet_x"] - beside, 1e-9),
        (sheet.height - beside) / max(figures["sheet_y"] - beside, 1e-9),
    )
    return float(min(np.exp(np.mean(np.log(ratios))), most))


def _remembering(judge: Judge, island: Island, seen: list[Member]) -> Island:
    """Return the island with the best of what was seen that is sound, fits, and is not alike."""
    sound = [member for member in (*island.found, *seen) if _fits(judge, member)]
    kept: dict[int, tuple[Member, Shape]] = {}
    for member in sorted(sound, key=lambda each: (not each.verdict.meets, each.score)):
        shape = member.verdict.shape
        if shape is None or len(kept) == KEPT:
            continue
        if all(shape.apart(other) > DISTINCT for _, other in kept.values()):
            kept[len(kept)] = member, shape
    return replace(island, found=tuple(member for member, _ in kept.values()))


def _fits(judge: Judge, member: Member) -> bool:
    figures = member.verdict.figures
    return figures is not None and member.score < NOTHING and judge.excess(figures) == 0
