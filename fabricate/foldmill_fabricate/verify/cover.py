"""Which lines cover which: straight pieces, the stretches they share, and how often.

Everything is interval arithmetic on pairs of straight pieces that come near each other (found with
an R-tree), so the work grows with the number of pieces, not with its square.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from shapely import STRtree

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_PLACES = 9
"""Decimals of mm to which places along lines are equal: a sum of lengths has noise of 1e-12."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """The straight pieces of numbered lines; every place on them is (line, mm from its start)."""

    ends: Floats
    """(n, 2, 2) mm: piece, end, coordinate."""
    line: Indices
    """(n,) number of the line."""
    start: Floats
    """(n,) mm along its line at which the piece starts."""

    @property
    def lengths(self) -> Floats:
        """(n,) mm."""
        lengths: Floats = np.hypot(*(self.ends[:, 1] - self.ends[:, 0]).T)
        return lengths

    @cached_property
    def outlines(self) -> NDArray[np.object_]:
        """(n,) the pieces as geometries, made once."""
        import shapely

        return np.asarray(shapely.linestrings(self.ends))

    @cached_property
    def tree(self) -> STRtree:
        """An R-tree of them, made once."""
        import shapely

        return shapely.STRtree(self.outlines)

    def take(self, which: NDArray[np.bool_]) -> Pieces:
        """Return the chosen pieces; lines keep their numbers."""
        return Pieces(self.ends[which], self.line[which], self.start[which])

    def at(self, line: int, place: float) -> tuple[float, float]:
        """Return the point of a line at ``place`` mm from its start."""
        mine = np.flatnonzero(self.line == line)
        k = mine[max(0, int(np.searchsorted(self.start[mine], place, "right")) - 1)]
        length = float(self.lengths[k])
        share = 0.0 if length == 0 else min(1.0, (place - float(self.start[k])) / length)
        x, y = self.ends[k, 0] + share * (self.ends[k, 1] - self.ends[k, 0])
        return float(x), float(y)


def pieces(polylines: Sequence[Floats]) -> Pieces:
    """Cut polylines (n, 2) mm into their straight pieces; those without length are left out."""
    sizes = np.array([len(points) for points in polylines], np.intp)
    spots = np.concatenate([np.zeros((0, 2)), *polylines])
    owner = np.repeat(np.arange(len(sizes)), sizes)
    within = owner[1:] == owner[:-1]
    line = owner[:-1][within].astype(np.intp)
    flat = np.stack([spots[:-1][within], spots[1:][within]], axis=1)
    lengths = np.hypot(*(flat[:, 1] - flat[:, 0]).T)
    reached = np.concatenate([[0.0], np.cumsum(lengths)])[:-1]
    first = np.searchsorted(line, line)
    start = reached - reached[first] if len(flat) else reached
    kept = lengths > 0
    return Pieces(flat[kept], line[kept], start[kept])


@dataclass(frozen=True, eq=False)
class Stretches:
    """Stretches of lines, each with a count (how often) or a difference."""

    line: Indices
    low: Floats
    """mm from the line's start"""
    high: Floats
    count: Floats

    @property
    def lengths(self) -> Floats:
        """(n,) mm."""
        return self.high - self.low

    def take(self, which: NDArray[np.bool_]) -> Stretches:
        """Return the chosen ones."""
        return Stretches(self.line[which], self.low[which], self.high[which], self.count[which])

    def total(self, lines: int) -> Floats:
        """Return the sum (lines,) of length times count for each line."""
        weights = self.lengths * self.count
        sums: Floats = np.bincount(self.line, weights, minlength=lines).astype(float)
        return sums


def stretches(items: Iterable[tuple[int, float, float, float]]) -> Stretches:
    """Make stretches from (line, low, high, count)."""
    table = np.array(list(items), float).reshape(-1, 4)
    return Stretches(table[:, 0].astype(np.intp), table[:, 1], table[:, 2], table[:, 3])


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs of pieces, one of ``these`` and one of ``those``, nearer than a tolerance somewhere."""

    these: Pieces
    those: Pieces
    i: Indices
    j: Indices
    tolerance: float

    def along(self) -> tuple[Stretches, Stretches, Indices, Indices]:
        """Return where two pieces run along each other: on these, on those, and which pieces.

        Neither direction nor sense of the count: 1 for every stretch. A pair counts where both stay
        within the tolerance and their directions agree as far as it can tell directions.
        """
        frame = _Frame(self)
        low, high = frame.beside(self.tolerance)
        shorter = np.minimum(frame.this_length, frame.that_length)
        parallel = np.abs(frame.rise) * shorter <= 2 * self.tolerance
        kept = (high > low) & parallel
        i, j, low, high = self.i[kept], self.j[kept], low[kept], high[kept]
        x0, run = frame.x0[kept], frame.run[kept]
        one, two = x0 + low * run, x0 + high * run
        on_these = _on(self.these, i, low, high)
        on_those = _on(self.those, j, np.minimum(one, two), np.maximum(one, two))
        return on_these, on_those, i, j

    def near(self) -> Stretches:
        """Return the stretches of these that are within the tolerance of those."""
        frame = _Frame(self)
        low, high = frame.around(self.tolerance)
        kept = high >= low
        return _on(self.these, self.i[kept], low[kept], high[kept])


def pairs(these: Pieces, those: Pieces, tolerance: float) -> Pairs:
    """Find the pairs of pieces that come within the tolerance (mm) of each other."""
    i, j = those.tree.query(these.outlines, predicate="dwithin", distance=tolerance)
    return Pairs(these, those, i.astype(np.intp), j.astype(np.intp), tolerance)


def _on(owner: Pieces, which: Indices, low: Floats, high: Floats) -> Stretches:
    start = owner.start[which]
    return Stretches(owner.line[which], start + low, start + high, np.ones(len(which)))


class _Frame:
    """Each pair's first piece as seen along the second: x along it from its start, y beside it.

    At t mm along the first piece x = x0 + run·t and y = y0 + rise·t.
    """

    def __init__(self, found: Pairs) -> None:
        this, that = found.these.ends[found.i], found.those.ends[found.j]
        self.this_length = np.hypot(*(this[:, 1] - this[:, 0]).T)
        self.that_length = np.hypot(*(that[:, 1] - that[:, 0]).T)
        u = (this[:, 1] - this[:, 0]) / self.this_length[:, None]
        v = (that[:, 1] - that[:, 0]) / self.that_length[:, None]
        w = this[:, 0] - that[:, 0]
        self.x0, self.y0 = (w * v).sum(axis=1), v[:, 0] * w[:, 1] - v[:, 1] * w[:, 0]
        self.run, self.rise = (u * v).sum(axis=1), v[:, 0] * u[:, 1] - v[:, 1] * u[:, 0]

    def beside(self, tolerance: float) -> tuple[Floats, Floats]:
        """Return from where to where (mm) the first runs beside the second; low > high: nowhere."""
        low, high = _slab(self.x0, self.run, np.zeros_like(self.x0), self.that_length)
        low2, high2 = _slab(self.y0, self.rise, -tolerance, tolerance)
        low = np.maximum(np.maximum(low, low2), 0.0)
        return low, np.minimum(np.minimum(high, high2), self.this_length)

    def around(self, tolerance: float) -> tuple[Floats, Floats]:
        """Return from where to where the first is within the tolerance of the second, mm.

        That region is convex, so what lies in the strip and round both ends is one stretch.
        """
        parts = [self.beside(tolerance)]
        parts += [self._round(x, tolerance) for x in (np.zeros_like(self.x0), self.that_length)]
        lows = np.array([np.where(high >= low, low, np.inf) for low, high in parts])
        highs = np.array([np.where(high >= low, high, -np.inf) for low, high in parts])
        low, high = lows.min(axis=0), highs.max(axis=0)
        return np.maximum(low, 0.0), np.minimum(high, self.this_length)

    def _round(self, x: Floats, tolerance: float) -> tuple[Floats, Floats]:
        gap = self.x0 - x
        middle = -(gap * self.run + self.y0 * self.rise)
        apart = gap * self.rise - self.y0 * self.run
        inside = tolerance**2 - apart**2
        half = np.sqrt(np.maximum(inside, 0.0))
        low = np.where(inside >= 0, np.maximum(middle - half, 0.0), np.inf)
        return low, np.minimum(middle + half, self.this_length)


def _slab(
    start: Floats, slope: Floats, low: Floats | float, high: Floats | float
) -> tuple[Floats, Floats]:
    """Return for which t start + slope·t lies in [low, high]."""
    flat = slope == 0
    safe = np.where(flat, 1.0, slope)
    one, two = (low - start) / safe, (high - start) / safe
    inside = (start >= low) & (start <= high)
    enter = np.where(flat, np.where(inside, -np.inf, np.inf), np.minimum(one, two))
    leave = np.where(flat, np.where(inside, np.inf, -np.inf), np.maximum(one, two))
    return enter, leave


def difference(found: Stretches, wanted: Stretches) -> Stretches:
    """Return where lines are covered more (+) or less (-) often than wanted, and by how much."""
    line = np.concatenate([found.line, found.line, wanted.line, wanted.line])
    place = np.concatenate([found.low, found.high, wanted.low, wanted.high])
    change = np.concatenate([found.count, -found.count, -wanted.count, wanted.count])
    if not len(line):
        return stretches(())
    place = np.round(place, _PLACES)
    order = np.lexsort((place, line))
    line, place = line[order], place[order]
    level = np.round(np.cumsum(change[order]), _PLACES)
    kept = (level[:-1] != 0) & (place[1:] > place[:-1]) & (line[1:] == line[:-1])
    return _joined(Stretches(line[:-1][kept], place[:-1][kept], place[1:][kept], level[:-1][kept]))


def uncovered(whole: Pieces, covered: Stretches) -> Stretches:
    """Return the stretches of lines that nothing covers; their count is the times, here -1."""
    everything = Stretches(
        whole.line, whole.start, whole.start + whole.lengths, np.ones(len(whole.line))
    )
    level = difference(covered, everything)
    return level.take(level.count < 0)


def _joined(parts: Stretches) -> Stretches:
    """Join stretches of one line and one level that touch."""
    if not len(parts.line):
        return parts
    new = np.ones(len(parts.line), bool)
    new[1:] = (
        (parts.line[1:] != parts.line[:-1])
        | (parts.count[1:] != parts.count[:-1])
        | (parts.low[1:] > parts.high[:-1])
    )
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(new)) - 1
    return Stretches(parts.line[first], parts.low[first], parts.high[last], parts.count[first])
