"""Closed strokes: at which of its vertices each begins, and what lies inside which.

A closed stroke may begin anywhere on it. It begins at one of its vertices, where blades turn
anyhow; overcut and repeats go on from there, as the plan says.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.passes import Stroke

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def begun(strokes: Sequence[Stroke], start: Floats, returns: bool) -> list[Stroke]:
    """Return strokes, each closed one begun where the whole travel in this order is least.

    start : (2,) where the tool is; returns : whether an open stroke leaves the tool where it began.
    The overcut, a millimetre or so, is not counted.
    """
    way = [_places(stroke) for stroke in strokes]
    cost, came = np.zeros(1), []
    at = np.asarray(start, float)[None]
    for stroke, spots in zip(strokes, way, strict=True):
        step = spots[:, None] - at[None, :]
        # Rounded, so that of starts that are equally near the first is taken on every machine.
        total = np.round(cost[None, :] + np.hypot(step[..., 0], step[..., 1]), 9)
        came.append(np.argmin(total, axis=1))
        cost = total[np.arange(len(spots)), came[-1]]
        at = spots if stroke.closed or returns else np.array(stroke.points[-1:], float)
    found: list[Stroke] = []
    best = int(np.argmin(cost)) if strokes else 0
    for stroke, back in zip(reversed(strokes), reversed(came), strict=True):
        found.append(_from(stroke, best))
        best = int(back[best])
    return found[::-1]


def _places(stroke: Stroke) -> Floats:
    """Return the points (n, 2) at which a stroke may begin."""
    points = np.array(stroke.points, float)
    return points[:-1] if stroke.closed else points[:1]


def _from(stroke: Stroke, vertex: int) -> Stroke:
    """Return a closed stroke begun at another of its vertices; an open one has but one."""
    rim = stroke.points[:-1]
    points = (*rim[vertex:], *rim[: vertex + 1])
    return replace(stroke, points=points) if vertex else stroke


def depths(strokes: Sequence[Stroke]) -> Indices:
    """Return inside how many closed strokes each one lies: the deepest are cut first.

    Once the outer of two is cut, what lies inside it is loose.
    """
    import shapely

    rims = [k for k, stroke in enumerate(strokes) if stroke.closed]
    found = np.zeros(len(strokes), np.intp)
    if not rims:
        return found
    areas = [shapely.Polygon(strokes[k].points) for k in rims]
    own = [shapely.LineString(stroke.points) for stroke in strokes]
    inner, outer = shapely.STRtree(areas).query(own, predicate="covered_by")
    np.add.at(found, inner[inner != np.array(rims)[outer]], 1)
    return found
