"""What of the part's own shape is hard to make: what is narrow, and holes too tight for knives."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.plan import narrow

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

IN_LINE = 0.01
"""mm. Creases whose ends leave one straight line by less are one hinge."""


def findings(pattern: CreasePattern, spots: Floats, plan: Plan) -> Iterator[Finding]:
    """Yield a finding for all that is too narrow, and every tight hole; spots : (V, 2) mm."""
    hanging = list(flaps(pattern, spots))
    yield from _flaps(spots, hanging, plan.material.min_flap)
    free = [vertices for vertices, _ in hanging]
    yield from narrow.facets(pattern, spots, facets(pattern), free, plan)
    yield from narrow.cuts(pattern, spots, plan)
    yield from _tight_holes(plan)


def _flaps(
    spots: Floats, hanging: list[tuple[Indices, Indices]], least: float
) -> Iterator[Finding]:
    for vertices, hinge in hanging:
        a, b = spots[hinge]
        along = (b - a) / np.hypot(*(b - a))
        off = spots[vertices] - a
        width = float(np.abs(off[:, 0] * along[1] - off[:, 1] * along[0]).max())
        if width < least - IN_LINE:
            x, y = spots[vertices].mean(axis=0)
            yield Finding(
                "narrow-flap",
                Severity.WARNING,
                f"flap at ({x:.1f}, {y:.1f}) mm",
                f"It stands {width:.2f} mm free of its only fold; {least:g} mm bend well.",
                "Enlarge the design, or fold it with flat pliers along a ruler.",
                (float(x), float(y)),
            )


def flaps(pattern: CreasePattern, spots: Floats) -> Iterator[tuple[Indices, Indices]]:
    """Yield the facets that hang on one straight fold: their vertices, and two on the fold."""
    facet, sides = facets(pattern), _sides(pattern)
    hinged = np.isin(pattern.assignments[sides], (Assignment.M, Assignment.V))
    owner = np.repeat(np.repeat(facet, 3)[hinged.ravel()], 2)
    ends = pattern.edges[sides[hinged]].ravel()
    if not len(ends):
        return
    order = np.lexsort((ends, owner))
    owner, ends = owner[order], ends[order]
    first = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    size = np.diff(np.append(first, len(owner)))
    base = np.repeat(ends[first], size)
    far = spots[ends] - spots[base]
    farthest = np.lexsort((ends, -np.hypot(*far.T), owner))[first]
    line = np.repeat(far[farthest], size, axis=0)
    beside = np.abs(far[:, 0] * line[:, 1] - far[:, 1] * line[:, 0]) / np.hypot(*line.T)
    straight = np.flatnonzero(np.maximum.reduceat(beside, first) <= IN_LINE)
    by_facet = np.argsort(facet, kind="stable")
    starts = np.searchsorted(facet[by_facet], np.arange(facet.max() + 2))
    for k in straight.tolist():
        number = owner[first[k]]
        own = sides[by_facet[starts[number] : starts[number + 1]]]
        yield np.unique(pattern.edges[own]), np.array([ends[first[k]], ends[farthest[k]]])


def facets(pattern: CreasePattern) -> Indices:
    """Return for each triangle (F,) the number of its facet: flat edges join triangles."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    sides = _sides(pattern)
    count = len(pattern.faces)
    face = np.repeat(np.arange(count), 3)
    flat = pattern.assignments[sides.ravel()] == Assignment.F
    order = np.argsort(sides.ravel()[flat], kind="stable")
    edges, owners = sides.ravel()[flat][order], face[flat][order]
    same = np.flatnonzero(edges[1:] == edges[:-1])
    joined = coo_array((np.ones(len(same)), (owners[same], owners[same + 1])), (count, count))
    _, labels = connected_components(joined, directed=False)
    found: Indices = labels.astype(np.intp)
    return found


def _sides(pattern: CreasePattern) -> Indices:
    """Return the edges (F, 3) of each triangle."""
    count = len(pattern.vertices)
    known = pattern.edges.min(axis=1) * count + pattern.edges.max(axis=1)
    order = np.argsort(known, kind="stable")
    tails, heads = pattern.faces, np.roll(pattern.faces, 1, axis=1)
    wanted = np.minimum(tails, heads) * count + np.maximum(tails, heads)
    sides: Indices = order[np.searchsorted(known[order], wanted)].reshape(-1, 3)
    return sides


def _tight_holes(plan: Plan) -> Iterator[Finding]:
    tools = plan.machine.tools
    least = 2 * narrow.ROUND * tools.blade_offset
    tight = sorted({h.diameter for h in (*plan.holes, *plan.reliefs) if h.diameter < least})
    if tools.blade == "drag" and tight:
        yield Finding(
            "tight-hole",
            Severity.INFO,
            "holes",
            f"Holes of {', '.join(f'{d:g}' for d in tight)} mm come out less than round with a "
            f"blade offset of {tools.blade_offset:g} mm; {least:g} mm would be round.",
            "Punch them by hand, or take a blade with less offset.",
        )
