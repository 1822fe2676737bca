"""Join edges to trails that turn as little as possible."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.toolpath import corners, routing

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def straightest(points: Floats, edges: Indices) -> list[list[int]]:
    """Return trails (lists of vertices) that use every edge exactly once.

    points : (V, 2) mm; edges : (E, 2). At each vertex as many edges as can be continue each other,
    with the fewest turns over ``corners.TURN_DEG``. A trail that returns to its start repeats it.
    """
    found = routing.route(points, edges, None, corners.fewest_turns())
    return [list(trail) for trail in found.trails]
