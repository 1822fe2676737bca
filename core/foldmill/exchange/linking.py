"""Slits that end inside the sheet and holes that no crease reaches, tied to the lines about them.

A crease pattern is faces between lines, each with one rim. A cut that ends within a face, or a loop
within one, leaves a face without such a rim; flat lines that nothing scores give it one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.meshing import meshed, within
from foldmill.pattern import Flags, Floats, Indices

_TRIED = 200
"""Nearest vertices that a free end is tied to if it sees them."""
_MOST_FILLED = 250
"""Vertices up to which all of a sheet is filled with flat lines where few do not do."""
_MOST_TIED = 200
"""Slits and holes up to which each is tied by lines of its own; more are meshed all at once."""
_ALONG = 1e-9
"""Sine of the angle below which two lines run along each other."""


def links(
    points: Floats, edges: Indices, letters: Sequence[str], loose: Flags
) -> list[tuple[int, int]]:
    """Return flat lines (a, b) that tie free cuts and floating loops to the rest of the sheet.

    points : (V, 2) mm; edges : (E, 2), a planar graph; loose : (E,) whether an edge hangs on the
    rest by one end only. Creases that end inside the sheet are left as they are.
    """
    group = _groups(len(points), edges)
    own = group[edges[:, 0]]
    groups = np.unique(own).tolist()
    leaves = _cut_leaves(len(points), edges, letters, loose)
    if len(groups) == 1 and not leaves.any():
        return []
    main = max(groups, key=lambda k: float(np.ptp(points[edges[own == k]], axis=(0, 1)).prod()))
    core = ~loose & (own == main)
    inside = within(points, edges[core], points)
    leaves &= inside
    known = np.isin(np.arange(len(points)), edges[core])
    if len(groups) > _MOST_TIED or leaves.sum() > 2 * _MOST_TIED:
        made = meshed(points, edges, inside | known, core)
        if made is not None:
            return made
    is_cut = np.isin(letters, ["B", "C"])
    floating = [
        group == k
        for k in groups
        if k != main and inside[edges[own == k]].all() and is_cut[own == k].any()
    ]
    if not floating and not (leaves & (group == main)).any():
        return []
    try:
        return _tied(points, edges, known, floating, leaves & (group == main), loose, leaves)
    except UnreadableFile:
        made = meshed(points, edges, inside | known, core)
        if made is not None:
            return made
        if len(known) > _MOST_FILLED:
            raise
        return _filled(points, edges, core)


def _tied(
    points: Floats,
    edges: Indices,
    known: Flags,
    floating: list[Flags],
    free: Flags,
    loose: Flags,
    leaves: Flags,
) -> list[tuple[int, int]]:
    """Return as few lines as do: one for each free end, two for each loop."""
    work = _Work(points, edges)
    for part in sorted(floating, key=lambda part: _gap(points, known, part)):
        work.tie_all(_anchors(points, part, leaves), known)
        known = known | part
    trees = _groups(len(points), edges[loose])
    for leaf in np.flatnonzero(free).tolist():
        work.tie(leaf, known & (trees != trees[leaf]), set())
    return work.made


def _filled(points: Floats, edges: Indices, core: Flags) -> list[tuple[int, int]]:
    """Return all lines that cross nothing, the shortest first: they leave triangles only."""
    used = np.unique(edges)
    one, two = np.triu_indices(len(used), 1)
    pairs = np.stack([used[one], used[two]], axis=1)
    middle = points[pairs].mean(axis=1)
    pairs = pairs[within(middle, edges[core], points)]
    order = np.argsort(np.hypot(*(points[pairs[:, 0]] - points[pairs[:, 1]]).T), kind="stable")
    work = _Work(points, edges)
    for a, b in pairs[order].tolist():
        if work.sees(a, b):
            work.add(a, b)
    return work.made


def _groups(count: int, edges: Indices) -> Indices:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    ties = coo_array((np.ones(len(edges)), edges.T), shape=(count, count))
    found: Indices = connected_components(ties, directed=False)[1].astype(np.intp)
    return found


def _cut_leaves(count: int, edges: Indices, letters: Sequence[str], loose: Flags) -> Flags:
    """Tell which of so many vertices are free ends of cuts."""
    degree = np.bincount(edges.ravel(), minlength=count)
    is_cut = np.isin(letters, ["B", "C"]) & loose
    ends = np.zeros(count, bool)
    ends[edges[is_cut]] = True
    free: Flags = ends & (degree == 1)
    return free


def _gap(points: Floats, known: Flags, own: Flags) -> float:
    steps = points[own][:, None] - points[known][None, :200]
    return float(np.hypot(*np.moveaxis(steps, -1, 0)).min())


def _anchors(points: Floats, own: Flags, leaves: Flags) -> list[int]:
    """Return the vertices by which a floating group is tied: its free ends, or two of its rim."""
    free = np.flatnonzero(own & leaves).tolist()
    if len(free) >= 2:
        return free
    mine = np.flatnonzero(own)
    start = free[0] if free else int(mine[points[mine, 0].argmin()])
    away = np.hypot(*(points[mine] - points[start]).T)
    return [start, int(mine[away.argmax()])]


class _Work:
    """Lines made so far, and what each vertex sees."""

    def __init__(self, points: Floats, edges: Indices) -> None:
        self.points, self.edges = points, edges
        self.made: list[tuple[int, int]] = []

    def add(self, a: int, b: int) -> None:
        """Make a line."""
        self.made.append((a, b))
        self.edges = np.vstack([self.edges, [(a, b)]]).astype(np.intp)

    def tie_all(self, anchors: list[int], targets: Flags) -> None:
        """Tie several vertices to others, each to one of its own."""
        taken: set[int] = set()
        for anchor in anchors:
            taken.add(self.tie(anchor, targets, taken))

    def tie(self, vertex: int, targets: Flags, taken: set[int]) -> int:
        """Tie a vertex to the nearest target it sees; raises where it sees none."""
        for other in self._near(vertex, targets):
            if other not in taken and self.sees(vertex, other):
                self.add(vertex, other)
                return other
        x, y = self.points[vertex]
        raise UnreadableFile(
            f"The cut at ({x:.4g}, {y:.4g}) mm ends inside the sheet, and cannot be tied to any "
            f"line about it. Draw it on to another line."
        )

    def _near(self, vertex: int, targets: Flags) -> Iterator[int]:
        able = np.flatnonzero(targets)
        away = np.hypot(*(self.points[able] - self.points[vertex]).T)
        yield from able[np.argsort(away, kind="stable")[:_TRIED]].tolist()

    def sees(self, a: int, b: int) -> bool:
        """Tell whether a line between two vertices meets others at its ends only."""
        p, q = self.points[[a, b]]
        one, two = self.points[self.edges[:, 0]], self.points[self.edges[:, 1]]
        near = (np.maximum(one, two) >= np.minimum(p, q)).all(axis=1)
        near &= (np.minimum(one, two) <= np.maximum(p, q)).all(axis=1)
        edges, one, two = self.edges[near], one[near], two[near]
        at = np.isin(edges, [a, b])
        free = ~at.any(axis=1)
        apart = _turn(p, q, one) * _turn(p, q, two) > 0
        apart |= _turn(one, two, p) * _turn(one, two, q) > 0
        if (free & ~apart).any() or at.all(axis=1).any():
            return False
        return not self._runs_along(edges[~free], at[~free], a, b)

    def _runs_along(self, edges: Indices, at: Flags, a: int, b: int) -> bool:
        """Tell whether a line leaves one of its ends in the direction of an edge that does."""
        shared = edges[at]
        far = edges[~at]
        own = self.points[np.where(shared == a, b, a)] - self.points[shared]
        other = self.points[far] - self.points[shared]
        sizes = np.hypot(*own.T) * np.hypot(*other.T)
        across = np.abs(own[:, 0] * other[:, 1] - own[:, 1] * other[:, 0])
        ahead = (own * other).sum(axis=1) > 0
        return bool((ahead & (across <= _ALONG * sizes)).any())


def _turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return the sine of the turn from ab to ac, for arrays (…, 2)."""
    u, v = b - a, c - a
    cross = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    size = np.hypot(u[..., 0], u[..., 1]) * np.hypot(v[..., 0], v[..., 1])
    sine: Floats = cross / np.where(size > 0, size, 1.0)
    sine[np.abs(sine) < _ALONG] = 0.0
    return sine
