"""Make a planar graph of any lines: nothing crosses, nothing lies on top of another, no idle joint.

Lines from other people's files cross, repeat each other and come in crumbs. A knife that follows
them as they are cuts twice and lifts without need. A pattern of our own is such a graph already and
comes back as it was.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill import CreasePattern
from foldmill.errors import InvalidInput
from foldmill_fabricate.toolpath.joints import merged_runs
from foldmill_fabricate.toolpath.splitting import split, weld

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]

TOUCH_MM = 1e-3
"""mm. Nearer than this lines meet. A twenty-fifth of a plotter step: the machine sees no
difference, and a file of four decimals is joined where it was meant to be."""
_ROUNDS = 5
"""Splitting moves lines by up to TOUCH_MM, which may make others meet; that settles at once."""

What = Literal["crossing", "overlap", "joint", "crumb"]


@dataclass(frozen=True)
class Change:
    """One thing that was mended, and where: mm."""

    what: What
    """"crossing": lines were split where they meet; "overlap": a stretch that lay on a longer line
    was dropped; "joint": two collinear lines became one; "crumb": a line shorter than TOUCH_MM."""
    x: float
    y: float
    line: int
    """Number of the line given, where one is meant; else -1."""


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
            ("crossing", "crossings split"),
            ("overlap", "overlapping stretches dropped"),
            ("joint", "collinear joints closed"),
            ("crumb", "crumbs dropped"),
        )
        found = [f"{self.count(what)} {text}" for what, text in names if self.count(what)]
        return ", ".join(found).capitalize() + "." if found else "Nothing had to be changed."


def planarise(segments: ArrayLike, roles: ArrayLike | None = None) -> Planar:
    """Return the planar graph of straight lines.

    segments : (n, 2, 2) mm; roles : (n,) whole numbers, by default all 0. Of lines that lie on each
    other the longer stays, with its role; of equal ones the first. Lines of different roles are
    split where they cross, and never joined. Raises InvalidInput for anything else.
    """
    given = np.asarray(segments, float)
    if given.ndim != 3 or given.shape[1:] != (2, 2) or not np.isfinite(given).all():
        raise InvalidInput(f"Lines are an (n, 2, 2) table of finite mm, not {given.shape}.")
    kinds = np.zeros(len(given), np.intp) if roles is None else np.asarray(roles, np.intp)
    points, ends = weld(given.reshape(-1, 2), TOUCH_MM)
    return _graph(points, ends.reshape(-1, 2), kinds, np.arange(len(given)))


def planarise_pattern(pattern: CreasePattern) -> Planar:
    """Return the planar graph of a pattern's edges; roles are their assignments."""
    kinds = pattern.assignments.astype(np.intp)
    points, same = weld(pattern.vertices, TOUCH_MM)
    return _graph(points, same[pattern.edges], kinds, np.arange(len(kinds)))


def _graph(points: Floats, ends: Indices, kinds: Indices, lines: Indices) -> Planar:
    lengths = np.hypot(*(points[ends[:, 1]] - points[ends[:, 0]]).T)
    whole = ends[:, 0] != ends[:, 1]
    changes = [Change("crumb", *_xy(points[ends[k, 0]]), int(k)) for k in np.flatnonzero(~whole)]
    edges, own, given = ends[whole], lines[whole], len(points)
    met: set[int] = set()
    for _ in range(_ROUNDS):
        points, edges, own, where = split(points, edges, own, TOUCH_MM)
        if not len(where):
            break
        met |= set(where.tolist())
    edges, own, lost = _without_overlaps(edges, own, lengths)
    changes += [Change("overlap", *_xy(points[e].mean(axis=0)), int(k)) for e, k in lost]
    edges, own, gone = merged_runs(points, edges, own, kinds, lengths, TOUCH_MM)
    crossings = sorted(met & set(np.unique(edges).tolist()))
    changes += [Change("crossing", *_xy(points[v]), -1) for v in crossings]
    doubled = {int(v) for _, k in lost for v in ends[k]}
    joints = [v for v in gone.tolist() if v < given and v not in doubled]
    changes += [Change("joint", *_xy(points[v]), -1) for v in joints]
    return Planar(points, edges, kinds[own], own, tuple(changes))


def _without_overlaps(
    edges: Indices, own: Indices, lengths: Floats
) -> tuple[Indices, Indices, list[tuple[Indices, int]]]:
    """Keep of equal edges that of the longest line; return what was dropped too."""
    best = np.lexsort((own, -lengths[own]))
    _, first = np.unique(np.sort(edges[best], axis=1), axis=0, return_index=True)
    kept = np.zeros(len(edges), bool)
    kept[best[first]] = True
    lost = [(edges[k], int(own[k])) for k in np.flatnonzero(~kept)]
    return edges[kept], own[kept], lost


def _xy(point: Floats) -> tuple[float, float]:
    return float(point[0]), float(point[1])
