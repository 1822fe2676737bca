"""Close joints at which a line goes straight on and nothing else meets it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BEND_DEG = 0.05
"""deg. A joint may bend so little and be rounding: 4 decimals on pieces of 0.2 mm. Whether a whole
run is one straight line is then judged by its distance from the chord."""


def merged_runs(
    points: Floats, edges: Indices, owner: Indices, roles: Indices, lengths: Floats, touch: float
) -> tuple[Indices, Indices, Indices]:
    """Join collinear edges of one role that meet where no other does.

    edges : (E, 2); owner : (E,) line each is part of; roles, lengths : of the lines; touch : mm
    that a joint may lie off the joined line. Returns edges, owners (the longest line of each
    run) and the vertices that are joints no more. Edges keep their order, a run that of its first.
    """
    around = _at_joints(points, edges, roles[owner])
    kept = np.ones(len(edges), bool)
    edges, owner, gone = edges.copy(), owner.copy(), []
    for first in sorted({min(pair) for pair in around.values()}):
        if not kept[first]:
            continue
        for side in (1, 0):
            members, inner, end = _run(points, edges, around, kept, first, side, touch)
            if not inner:
                continue
            kept[members] = False
            owner[first] = max([owner[first], *owner[members]], key=lambda k: (lengths[k], -k))
            edges[first, side] = end
            gone += inner
            for joint in [v for v in (end,) if v in around]:
                around[joint] = {*around[joint], first} - set(members)
    return edges[kept], owner[kept], np.array(sorted(gone), np.intp)


def _at_joints(points: Floats, edges: Indices, roles: Indices) -> dict[int, set[int]]:
    """Return vertex → its two edges, for every vertex at which one line goes straight on."""
    ends = edges.ravel()
    order = np.argsort(ends, kind="stable")
    pairs = np.flatnonzero(np.bincount(ends, minlength=len(points)) == 2)
    at = np.searchsorted(ends[order], pairs)
    e, f = order[at] // 2, order[at + 1] // 2
    away = points[edges[e].sum(axis=1) - pairs] - points[pairs]
    on = points[pairs] - points[edges[f].sum(axis=1) - pairs]
    turn = np.arctan2(on[:, 0] * away[:, 1] - on[:, 1] * away[:, 0], (on * away).sum(axis=1))
    straight = (np.abs(np.degrees(turn)) <= BEND_DEG) & (roles[e] == roles[f]) & (e != f)
    return {
        int(v): {int(a), int(b)}
        for v, a, b in zip(pairs[straight], e[straight], f[straight], strict=True)
    }


def _run(
    points: Floats,
    edges: Indices,
    around: dict[int, set[int]],
    kept: NDArray[np.bool_],
    first: int,
    side: int,
    touch: float,
) -> tuple[list[int], list[int], int]:
    """Return the edges that go straight on from one end of an edge, the joints, and the far end."""
    start, at, edge = edges[first, 1 - side], int(edges[first, side]), first
    members: list[int] = []
    inner: list[int] = []
    while at in around:
        [following] = around[at] - {edge}
        far = int(edges[following].sum() - at)
        if not kept[following] or following == first or far == start:
            break
        if _off(points[[*inner, at]], points[start], points[far]) > touch:
            break
        members.append(following)
        inner.append(at)
        at, edge = far, following
    return members, inner, at


def _off(joints: Floats, a: Floats, b: Floats) -> float:
    """Return how far the farthest joint lies off the line from a to b, mm."""
    along, steps = b - a, joints - a
    beside = np.abs(along[0] * steps[:, 1] - along[1] * steps[:, 0])
    return float(beside.max() / np.hypot(*along))
