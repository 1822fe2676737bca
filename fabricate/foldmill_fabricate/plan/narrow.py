"""What is too narrow: facets between folds, strips between cuts, and edges too short for the knife.

The width of a facet is the least distance of two parallel lines that it fits between: of a triangle
its smallest height, of a strip its breadth.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.materials import ThroughCut
from foldmill_fabricate.passes import Plan

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

NEARLY = 0.01
"""mm less than asked for that nobody is told of."""
ROUND = 3.0
"""A trailing knife rounds well what has a radius of so many times its offset."""


def facets(
    pattern: CreasePattern, spots: Floats, number: Indices, flaps: Sequence[Indices], plan: Plan
) -> Iterator[Finding]:
    """Yield a finding for every facet between folds that is too narrow to be folded well.

    spots : (V, 2) mm; number : (F,) the facet of each triangle; flaps : the vertices of facets that
    hang on one fold, which have a rule of their own.
    """
    least = plan.material.min_feature
    free = {frozenset(vertices.tolist()) for vertices in flaps}
    every = list(_vertices(pattern, number))
    for own, width in zip(every, _widths(spots, every), strict=True):
        if width < least - NEARLY and frozenset(own.tolist()) not in free:
            x, y = spots[own].mean(axis=0).tolist()
            yield Finding(
                "narrow-facet",
                Severity.WARNING,
                f"facet at ({x:.1f}, {y:.1f}) mm",
                f"It is {width:.2f} mm wide between its folds; {least:g} mm stay flat.",
                "Enlarge the design, or take a thinner material.",
                (x, y),
            )


def _widths(spots: Floats, facets: Sequence[Indices]) -> Floats:
    """Return the width of each facet, mm; triangles, of which there may be many, all at once."""
    widths = np.zeros(len(facets))
    three = [k for k, own in enumerate(facets) if len(own) == 3]
    if three:
        corners = spots[np.array([facets[k] for k in three])]
        step = np.roll(corners, -1, axis=1) - corners
        arms = np.roll(corners, 1, axis=1) - corners
        off = np.abs(arms[..., 0] * step[..., 1] - arms[..., 1] * step[..., 0])
        widths[three] = (off / np.hypot(step[..., 0], step[..., 1])).min(axis=1)
    for k, own in enumerate(facets):
        if len(own) != 3:
            widths[k] = width_of(spots[own])
    return widths


def width_of(points: Floats) -> float:
    """Return the width (mm) of the convex hull of points (n, 2): one side of it lies on a line."""
    from scipy.spatial import ConvexHull

    hull = points if len(points) == 3 else points[ConvexHull(points).vertices]
    step = np.roll(hull, -1, axis=0) - hull
    arms = points[None] - hull[:, None]
    off = np.abs(arms[..., 0] * step[:, 1:] - arms[..., 1] * step[:, :1])
    return float((off.max(axis=1) / np.hypot(*step.T)).min())


def _vertices(pattern: CreasePattern, number: Indices) -> Iterator[Indices]:
    """Yield the vertices of each facet; none of a sheet without folds."""
    order = np.argsort(number, kind="stable")
    starts = np.flatnonzero(np.diff(number[order], prepend=-1))
    if not (np.isin(pattern.assignments, (Assignment.M, Assignment.V))).any():
        return
    corners = np.sort(pattern.faces, axis=1)
    for own in np.split(order, starts[1:]):
        yield corners[own[0]] if len(own) == 1 else np.unique(corners[own])


def cuts(pattern: CreasePattern, spots: Floats, plan: Plan) -> Iterator[Finding]:
    """Yield a finding for every strip between cuts that is narrower than the sheet is thick.

    And for every side of the outline that a trailing knife cannot come round on; spots : (V, 2) mm.
    """
    if isinstance(plan.material.cut, ThroughCut):
        yield from _strips(pattern, spots, plan.material.thickness)
    if plan.machine.tools.blade == "drag":
        yield from _short_sides(pattern, spots, ROUND * plan.machine.tools.blade_offset)


def _strips(pattern: CreasePattern, spots: Floats, least: float) -> Iterator[Finding]:
    import shapely

    edges = pattern.edges[np.isin(pattern.assignments, (Assignment.B, Assignment.C))]
    lines = shapely.linestrings(spots[edges])
    one, two = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=least - NEARLY)
    for i, j in zip(one[one < two].tolist(), two[one < two].tolist(), strict=True):
        if set(edges[i].tolist()) & set(edges[j].tolist()):
            continue
        gap = float(shapely.distance(lines[i], lines[j]))
        between = shapely.shortest_line(lines[i], lines[j])
        x, y = np.array(between.coords).mean(axis=0).tolist()
        yield Finding(
            "thin-strip",
            Severity.WARNING,
            f"cuts at ({x:.1f}, {y:.1f}) mm",
            f"They leave a strip of {gap:.2f} mm; narrower than the sheet is thick ({least:g} mm) "
            f"it tears.",
            "Move the cuts apart, or enlarge the design.",
            (x, y),
        )


def _short_sides(pattern: CreasePattern, spots: Floats, least: float) -> Iterator[Finding]:
    sides = pattern.edges[pattern.assignments == Assignment.B]
    straight = _straight(pattern, spots)
    for a, b in sides.tolist():
        length = float(np.hypot(*(spots[b] - spots[a])))
        if length < least and not (straight[a] or straight[b]):
            x, y = spots[[a, b]].mean(axis=0).tolist()
            yield Finding(
                "short-side",
                Severity.WARNING,
                f"outline at ({x:.1f}, {y:.1f}) mm",
                f"Its side is {length:.2f} mm long; a blade that trails its holder needs "
                f"{least:g} mm to come round.",
                "Round it off by hand, or merge the vertices at its ends.",
                (x, y),
            )


def _straight(pattern: CreasePattern, spots: Floats) -> NDArray[np.bool_]:
    """Tell at which vertices (V,) the outline goes straight on."""
    found = np.zeros(len(spots), bool)
    for loop in pattern.outline():
        rim = spots[loop]
        one, two = rim - np.roll(rim, 1, axis=0), np.roll(rim, -1, axis=0) - rim
        cross = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
        found[loop] = np.abs(np.degrees(np.arctan2(cross, (one * two).sum(axis=1)))) < 1e-3
    return found
