"""Is the outline of a flat pattern simple? Then the whole pattern lies flat without overlap.

An isometric disk whose angles sum to 360° everywhere is locally one to one, so that its boundary
decides for all of it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment
from foldmill_plugins.waterbomb.topology import Indices, Topology

Floats = NDArray[np.float64]


def outline(topology: Topology) -> Indices:
    """Return the boundary of an opened topology as a loop of vertices (n,)."""
    edges = topology.edges[topology.assignments == Assignment.B]
    ends = np.concatenate([edges, edges[:, ::-1]])
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    pairs = dict(zip(ends[::2, 0].tolist(), ends[:, 1].reshape(-1, 2).tolist(), strict=True))
    loop, before = [int(edges[0, 0])], -1
    while True:
        one, two = pairs[loop[-1]]
        after = two if one == before else one
        before = loop[-1]
        if after == loop[0]:
            return np.array(loop, np.intp)
        loop.append(after)


def is_simple(topology: Topology, flat: Floats) -> bool:
    """Tell whether the outline of the flat places (V, 2) meets itself nowhere; O(n log n)."""
    import shapely

    ring = shapely.linearrings(flat[outline(topology)])
    return bool(shapely.is_simple(ring)) and bool(
        shapely.is_ccw(ring) == _turns_left(topology, flat)
    )


def _turns_left(topology: Topology, flat: Floats) -> bool:
    """Tell whether the loop as chained runs counter-clockwise by the sum of the facets' areas."""
    x, y = flat[outline(topology)].T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) > 0
