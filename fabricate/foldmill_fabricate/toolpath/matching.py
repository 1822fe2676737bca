"""Match points in pairs at the least total distance (Edmonds 1965): the shortest pen-up moves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

COMPLETE = 300
"""Up to so many points every pair is a candidate."""
NEIGHBOURS = 12
"""Candidates of each point beyond that. On some thousand random points the total may be 0.06 % more
than with all pairs; ``proven`` finds those that are missing."""
_WHOLE = 1e6
"""Costs are matched in whole millionths, so that sums are exact."""


def cheapest(count: int, i: Indices, j: Indices, cost: Floats) -> Indices:
    """Return a matching (m, 2) of 0 … count−1 with the most pairs and, of those, the least cost.

    i, j : (n,) the pairs that may be made; cost : (n,) of each, not negative.
    """
    import rustworkx

    if not len(i):
        return np.zeros((0, 2), np.intp)
    whole = np.round(np.asarray(cost) * _WHOLE).astype(np.int64)
    weight = whole.max() + 1 - whole
    graph = rustworkx.PyGraph(multigraph=False)
    graph.add_nodes_from([None] * count)
    graph.add_edges_from(list(zip(i.tolist(), j.tolist(), weight.tolist(), strict=True)))
    found = rustworkx.max_weight_matching(graph, max_cardinality=True, weight_fn=int)
    pairs = np.sort(np.array(sorted(found), np.intp).reshape(-1, 2), axis=1)
    return pairs[np.argsort(pairs[:, 0])]


def neighbours(points: Floats, count: int) -> tuple[Indices, Indices, Floats]:
    """Return pairs i < j of points (n, 2) that are among each other's nearest, and gaps, mm.

    Up to COMPLETE points these are all pairs.
    """
    return nearest(points, len(points) if len(points) <= COMPLETE else count)


def nearest(points: Floats, count: int) -> tuple[Indices, Indices, Floats]:
    """Return pairs i < j of points (n, 2), one among the ``count`` nearest of the other; gaps, mm.

    Of fewer points these are all pairs.
    """
    from scipy.spatial import cKDTree

    if count >= len(points):
        i, j = np.triu_indices(len(points), 1)
    else:
        near = cKDTree(points).query(points, k=count + 1)[1]
        own = np.repeat(np.arange(len(points)), count + 1)
        both = np.sort(np.stack([own, near.ravel()], axis=1), axis=1)
        i, j = np.unique(both[both[:, 0] < both[:, 1]], axis=0).T
    return i.astype(np.intp), j.astype(np.intp), np.hypot(*(points[i] - points[j]).T)
