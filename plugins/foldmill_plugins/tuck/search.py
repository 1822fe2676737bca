"""Find corners for every blank so that no flap passes through anything.

A blank with one corner is sampled over all of its t, and the middle of the longest free run taken.
One with several is sampled evenly over all its corners' intervals at once, on every combination of
sides; where nothing is free, more samples gather round those that pass through least; of what is
free, the choice farthest from what is not is taken. All samples follow from the numbers of the
blank alone: the same parameters give the same flaps.

Several blanks are filled one after another, each against the surface and the flaps already there;
where nothing is left for a later one, an earlier one takes its next best place.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice, product

import numpy as np
from numpy.typing import NDArray

from foldmill_plugins.tuck import refusals
from foldmill_plugins.tuck.blanks import Blank
from foldmill_plugins.tuck.clearance import Surroundings, depths
from foldmill_plugins.tuck.corners import Corners, place
from foldmill_plugins.tuck.params import Lies, Tuck
from foldmill_plugins.tuck.refusals import NoPlace
from foldmill_plugins.tuck.seams import TORN, misfits, sides

Floats = NDArray[np.float64]

RUNS = (96, 4096)
"""Places of t that are tried in turn for a blank with one corner."""
SPREAD = 1024
"""Shares tried per combination of sides, for a blank with several corners."""
ROUNDS, ROUND, BEST = 6, 512, 24
"""Rounds of more samples about the best so far, how many in each, and how many those are."""
OPTIONS = 6
"""Places of one blank that are tried where another one finds none beside it."""
SEED = 4


@dataclass(frozen=True, eq=False)
class Placed:
    """A blank and the corners of its flap."""

    blank: Blank
    corners: Corners
    """One choice."""
    side: int
    """1 below the surface, -1 above, 0 flush with it."""
    run: tuple[float, float] | None = None
    """For one corner: the free run of t it was taken from, mm."""


@dataclass(frozen=True, eq=False)
class Wish:
    """What is asked of one blank's flap."""

    given: tuple[float | None, ...]
    sides: tuple[int | None, ...]
    side: int | None
    """1 below the surface, -1 above, None wherever it fits."""

    @classmethod
    def of(cls, blank: Blank, tucks: Mapping[int, Tuck], inside: int) -> Wish:
        """Gather a blank's tucks; ``inside`` is 1 where the inside is below, else -1."""
        mine = [tucks.get(i, Tuck(point=i)) for i in blank.points]
        asked: set[Lies] = {tuck.lies for tuck in mine if tuck.lies is not None}
        if len(asked) > 1:
            raise refusals.both_sides(blank)
        side = None if not asked else inside * (1 if asked == {"inside"} else -1)
        return cls(tuple(tuck.t for tuck in mine), tuple(tuck.side for tuck in mine), side)

    @property
    def is_given(self) -> bool:
        """Whether every t is given."""
        return None not in self.given


@dataclass(frozen=True, eq=False)
class _Found:
    """Samples, and what became of them."""

    shares: Floats
    corners: Corners
    depth: Floats
    side: NDArray[np.int_]

    def free(self, wish: Wish) -> NDArray[np.bool_]:
        free: NDArray[np.bool_] = (self.depth == 0) & (self.side != TORN)
        return free if wish.side is None else free & ((self.side == 0) | (self.side == wish.side))


def arrange(wishes: list[tuple[Blank, Wish]], around: Surroundings, inside: int) -> list[Placed]:
    """Return a flap for every blank; raises NoPlace (an ImpossibleGeometry) with the reason."""
    if not wishes:
        return []
    (blank, wish), others = wishes[0], wishes[1:]
    reason: NoPlace | None = None
    for option in islice(_options(blank, wish, around, inside), OPTIONS if others else 1):
        try:
            beside = around.beside(blank, option.corners.spots[0]) if others else around
            return [option, *arrange(others, beside, inside)]
        except NoPlace as error:
            reason = reason or error
    raise reason or refusals.no_place(blank, wish.given, {}, wish.side, inside)


def _options(blank: Blank, wish: Wish, around: Surroundings, inside: int) -> Iterator[Placed]:
    """Yield places of one flap, the best first; raises NoPlace where there is none."""
    patterns = _patterns(blank, wish, around)
    refusals.check_given(blank, wish.given)
    if wish.is_given:
        found = [_tried(blank, np.ones((1, len(blank.points))), p, wish, around) for p in patterns]
        options = [Placed(blank, f.corners, int(f.side[0])) for f in found if f.free(wish)[0]]
    elif len(blank.points) == 1:
        options = _single(blank, wish, around, patterns)
    else:
        options = _several(blank, wish, around, patterns)
    if not options:
        refusals.check_reach(blank, wish.given, patterns)
        raise _refusal(blank, wish, around, inside)
    # The rim of an open blank folds to either side; it is hidden where it can be.
    yield from sorted(options, key=lambda each: blank.is_open and each.side == -inside)


def _refusal(blank: Blank, wish: Wish, around: Surroundings, inside: int) -> NoPlace:
    """Say why there is no option, and what there is beside it."""
    if wish.side is None and not any(wish.given):
        return refusals.no_place(blank, wish.given, {}, None, inside)
    loose = Wish(tuple(None for _ in wish.given), wish.sides, None)
    solve = _single if len(blank.points) == 1 else _several
    options = solve(blank, loose, around, _patterns(blank, loose, around))
    ranges: dict[int, tuple[float, float]] = {}
    for option in options:
        t = float(option.corners.t[0, 0])
        ranges.setdefault(option.side, option.run or (t, t))
    return refusals.no_place(blank, wish.given, ranges, wish.side, inside)


def _patterns(blank: Blank, wish: Wish, around: Surroundings) -> list[tuple[int, ...]]:
    """Return the combinations of sides to try; one where the surroundings are mirrored."""
    k = len(blank.points)
    choices = [(1, -1) if side is None else (side,) for side in wish.sides]
    if blank.is_open and k > 1:
        choices[-1] = (1,)
    if around.is_mirrored and wish.sides[0] is None and not (blank.is_open and k == 1):
        choices[0] = (1,)
    return list(product(*choices))


def _tried(
    blank: Blank, shares: Floats, pattern: tuple[int, ...], wish: Wish, around: Surroundings
) -> _Found:
    signs = np.broadcast_to(np.array(pattern, float), shares.shape)
    corners = place(blank, shares, signs, wish.given)
    side = sides(blank, corners)
    return _Found(shares, corners, depths(blank, corners, around), side)


def _single(
    blank: Blank, wish: Wish, around: Surroundings, patterns: list[tuple[int, ...]]
) -> list[Placed]:
    """Sample the one t; the finer sampling only where the coarse one finds nothing."""
    for count in RUNS:
        even = (np.arange(count) + 0.5) / count
        shares = np.append(even, 1.0)[::-1][:, None] if blank.is_open else even[:, None]
        found = [_tried(blank, shares, pattern, wish, around) for pattern in patterns]
        runs = [run for each in found for run in _runs(blank, each, wish)]
        if runs:
            return [run for _, run in sorted(runs, key=lambda each: each[0])]
    return []


def _runs(blank: Blank, found: _Found, wish: Wish) -> Iterator[tuple[tuple[float, int], Placed]]:
    """Yield every free run of t on one side of the surface: a key to sort by, and its middle."""
    label = np.where(found.free(wish), found.side, TORN)
    breaks = np.flatnonzero(np.diff(label)) + 1
    for part in np.split(np.arange(len(label)), breaks):
        side = int(label[part[0]])
        if side == TORN:
            continue
        t = found.corners.t[part, 0]
        low, high = float(t.min()), float(t.max())
        if blank.is_open:
            best, key = int(part[0]), (int(part[0]), -side)  # the straight rim comes first
        else:
            best = int(part[len(part) // 2])
            key = (-len(part), -side)
        corners = found.corners.chosen(np.array([best]))
        yield key, Placed(blank, corners, side, (low, high))


def _several(
    blank: Blank, wish: Wish, around: Surroundings, patterns: list[tuple[int, ...]]
) -> list[Placed]:
    shares = evenly(SPREAD, len(blank.points))
    if blank.is_open:
        shares[:, -1] = 1.0
    found = [_tried(blank, shares, pattern, wish, around) for pattern in patterns]
    if not any(each.free(wish).any() for each in found):
        pairs = zip(found, patterns, strict=True)
        found = [_refined(blank, each, pattern, wish, around) for each, pattern in pairs]
    best = [_farthest(each, wish) for each in found]
    ranked = sorted((entry for entries in best for entry in entries), key=lambda entry: -entry[0])
    return [Placed(blank, corners, side) for _, corners, side in ranked]


def _refined(
    blank: Blank, found: _Found, pattern: tuple[int, ...], wish: Wish, around: Surroundings
) -> _Found:
    """Gather more samples about those that pass through least, ever nearer."""
    rng = np.random.default_rng(SEED)
    shares, penalty = found.shares, _penalty(blank, found, wish)
    width = 0.1
    for _ in range(ROUNDS):
        best = np.argsort(penalty, kind="stable")[:BEST]
        if not np.isfinite(penalty[best[0]]):
            break
        best = best[np.isfinite(penalty[best])]
        chosen = best[np.arange(ROUND) % len(best)]
        near = shares[chosen] + width * rng.standard_normal((ROUND, shares.shape[1]))
        near = np.clip(near, 1e-6, 1 - 1e-6)
        if blank.is_open:
            near[:, -1] = 1.0
        found = _tried(blank, near, pattern, wish, around)
        if found.free(wish).any():
            break
        shares = np.concatenate([shares, near])
        penalty = np.concatenate([penalty, _penalty(blank, found, wish)])
        width *= 0.6
    return found


def _penalty(blank: Blank, found: _Found, wish: Wish) -> Floats:
    """Return how far from free each sample is: what it passes through, and where it is torn, mm."""
    below, above = misfits(blank, found.corners)
    misfit = {1: below, -1: above, None: np.minimum(below, above)}[wish.side]
    penalty: Floats = found.depth + (blank.end - blank.start) * np.nan_to_num(misfit, nan=np.inf)
    return penalty


def _farthest(found: _Found, wish: Wish) -> list[tuple[float, Corners, int]]:
    """Return, for each side of the surface, the free choice farthest from all that is not."""
    free = found.free(wish)
    entries = []
    for side in np.unique(found.side[free]):
        mine = free & (found.side == side)
        away = np.min([found.shares[mine], 1 - found.shares[mine]], axis=(0, 2))
        others = found.shares[~mine]
        if len(others):
            gaps = found.shares[mine][:, None] - others[None]
            away = np.minimum(np.abs(away), np.linalg.norm(gaps, axis=2).min(axis=1))
        best = np.flatnonzero(mine)[int(np.argmax(away))]
        entries.append((float(away.max()), found.corners.chosen(np.array([best])), int(side)))
    return entries


def evenly(count: int, width: int) -> Floats:
    """Return points (count, width) spread evenly in the unit cube (Roberts' R sequence)."""
    root = 2.0
    for _ in range(64):
        root = (1 + root) ** (1 / (width + 1))
    steps = root ** -np.arange(1.0, width + 1)
    spread: Floats = (0.5 + np.arange(count)[:, None] * steps) % 1.0
    return spread
