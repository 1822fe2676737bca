"""Make a planar graph of any lines: nothing crosses, nothing lies on top of another, no idle joint.

Lines from other people's files cross, repeat each other and come in crumbs. A knife that follows
them as they are cuts twice and lifts without need. A pattern of our own is such a graph already and
comes back as it was.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill.errors import InvalidInput
from foldmill.pattern import CreasePattern
from foldmill.planarise.joints import merged_runs
from foldmill.planarise.splitting import split, weld

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

TOUCH_MM = 1e-3
"""mm. Nearer than this lines meet. A twenty-fifth of a plotter step: the machine sees no
difference, and a file of four decimals is joined where it was meant to be."""
_ROUNDS = 5
"""Splitting moves lines by up to TOUCH_MM, which may make others meet; that settles at once."""

What = Literal["weld", "crossing", "overlap", "joint", "crumb"]


@dataclass(frozen=True)
class Change:
    """One thing that was mended, and where: mm."""

    what: What
    """"weld": a vertex became one with another at its place; "crossing": lines were split where
    they meet; "overlap": a stretch that lay on another line was dropped; "joint": two collinear
    lines became one; "crumb": a line shorter than TOUCH_MM."""
    x: float
    y: float
    line: int
    """Number of the line given, where one is meant; else -1."""
    under: int = -1
    """Of an overlap, the number of the line that stays."""


@dataclass(frozen=True, eq=False)
class Planar:
    """A planar graph of lines, and what was changed to get it."""

    points: Floats
    """(V, 2) mm."""
    edges: Indices
    """(E, 2) vertices."""
    roles: Indices
    """(E,) the role of the line that each edge is part of."""
    lines: Indices
    """(E,) number of that line; the longest where several were joined."""
    changes: tuple[Change, ...]

    def count(self, what: What) -> int:
        """Return how many changes are of one kind."""
        return sum(change.what == what for change in self.changes)

    def report(self) -> str:
        """Return one sentence for a person."""
        names: tuple[tuple[What, str], ...] = (
            ("weld", "vertices welded"),
            ("crossing", "crossings split"),
            ("overlap", "overlapping stretches dropped"),
            ("joint", "collinear joints closed"),
            ("crumb", "crumbs dropped"),
        )
        found = [f"{self.count(what)} {text}" for what, text in names if self.count(what)]
        return ", ".join(found).capitalize() + "." if found else "Nothing had to be changed."


def planarise(
    segments: ArrayLike,
    roles: ArrayLike | None = None,
    ranks: ArrayLike | None = None,
    touch: float = TOUCH_MM,
    most: int | None = None,
) -> Planar:
    """Return the planar graph of straight lines.

    segments : (n, 2, 2) mm; roles, ranks : (n,) whole numbers, by default all 0; touch : mm within
    which lines meet. Of lines that lie on each other that of the highest rank stays, with its role;
    of those the longest, and of equal ones the first. Lines of different roles are split where they
    cross, and never joined. most : pieces that may come of them, by default any number. Raises
    InvalidInput for anything else, InvalidPattern for lines that meet so often that they would
    become more pieces, with the number.
    """
    given = np.asarray(segments, float)
    if given.ndim != 3 or given.shape[1:] != (2, 2) or not np.isfinite(given).all():
        raise InvalidInput(f"Lines are an (n, 2, 2) table of finite mm, not {given.shape}.")
    none = np.zeros(len(given), np.intp)
    kinds = none if roles is None else np.asarray(roles, np.intp)
    order = none if ranks is None else np.asarray(ranks, np.intp)
    points, ends = weld(given.reshape(-1, 2), touch)
    return _graph(points, ends.reshape(-1, 2), kinds, order, touch, most)


def planarise_graph(
    points: Floats,
    edges: Indices,
    roles: ArrayLike,
    ranks: ArrayLike | None = None,
    most: int | None = None,
) -> Planar:
    """Return the planar graph of lines between vertices, which are welded where they coincide.

    points : (V, 2) mm; edges : (E, 2); roles, ranks : (E,), and most, as of ``planarise``.
    """
    kinds = np.asarray(roles, np.intp)
    order = np.zeros(len(edges), np.intp) if ranks is None else np.asarray(ranks, np.intp)
    own, same = weld(points, TOUCH_MM)
    found = _graph(own, same[edges], kinds, order, most=most)
    used = np.unique(edges)
    _, first = np.unique(same[used], return_index=True)
    spare = np.delete(used, first)
    welds = tuple(Change("weld", *_xy(points[v]), -1) for v in spare)
    return replace(found, changes=welds + found.changes)


def planarise_pattern(pattern: CreasePattern) -> Planar:
    """Return the planar graph of a pattern's edges; roles are their assignments."""
    return planarise_graph(pattern.vertices, pattern.edges, pattern.assignments)


def _graph(
    points: Floats,
    ends: Indices,
    kinds: Indices,
    ranks: Indices,
    touch: float = TOUCH_MM,
    most: int | None = None,
) -> Planar:
    lengths = np.hypot(*(points[ends[:, 1]] - points[ends[:, 0]]).T)
    whole = ends[:, 0] != ends[:, 1]
    changes = [Change("crumb", *_xy(points[ends[k, 0]]), int(k)) for k in np.flatnonzero(~whole)]
    edges, own, given = ends[whole], np.flatnonzero(whole), len(points)
    met: set[int] = set()
    for _ in range(_ROUNDS):
        points, edges, own, where = split(points, edges, own, touch, most)
        if not len(where):
            break
        met |= set(where.tolist())
    edges, own, lost = _without_overlaps(edges, own, lengths, ranks)
    changes += [Change("overlap", *_xy(points[e].mean(axis=0)), k, on) for e, k, on in lost]
    edges, own, gone = merged_runs(points, edges, own, kinds, lengths, touch)
    crossings = sorted(met & set(np.unique(edges).tolist()))
    changes += [Change("crossing", *_xy(points[v]), -1) for v in crossings]
    doubled = {int(v) for _, k, _ in lost for v in ends[k]}
    joints = [v for v in gone.tolist() if v < given and v not in doubled]
    changes += [Change("joint", *_xy(points[v]), -1) for v in joints]
    return Planar(points, edges, kinds[own], own, tuple(changes))


def _without_overlaps(
    edges: Indices, own: Indices, lengths: Floats, ranks: Indices
) -> tuple[Indices, Indices, list[tuple[Indices, int, int]]]:
    """Keep of equal edges that of the best line; return each one dropped, its line and the best."""
    best = np.lexsort((own, -lengths[own], -ranks[own]))
    _, first, same = np.unique(
        np.sort(edges[best], axis=1), axis=0, return_index=True, return_inverse=True
    )
    stays = np.zeros(len(edges), np.intp)
    stays[best] = best[first[same.reshape(-1)]]
    kept = stays == np.arange(len(edges))
    lost = [(edges[k], int(own[k]), int(own[stays[k]])) for k in np.flatnonzero(~kept)]
    return edges[kept], own[kept], lost


def _xy(point: Floats) -> tuple[float, float]:
    return float(point[0]), float(point[1])
