"""Holes at vertices: they take away the material in which grooves meet and folds would tear.

    D = max(relief_diameter, k·t, 1.5 mm),   k = 2.5 up to five creases at the vertex, 3 from six on

Scores run out into the rim of such a hole, as they do at the outline.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from foldmill import CreasePattern
from foldmill.finding import Finding, Severity
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.materials import Material
from foldmill_fabricate.passes import Face, Hole, Stroke
from foldmill_fabricate.plan import spacing
from foldmill_fabricate.plan.registration import hole_rim
from foldmill_fabricate.toolpath import order

Floats = NDArray[np.float64]
ByFace = Mapping[Face, NDArray[np.intp]]
Relief = Literal["none", "needed", "all"]

SMALLEST = 1.5
"""mm. A knife that trails its axis makes no smaller hole round."""
TOUCH = 1e-6
"""mm. An inner cut that ends in the middle of a hole is meant to."""
MANY = 6
"""Creases from which on the hole is the larger one."""
SHARES = (2.5, 3.0)
"""Diameter over thickness, for few creases and for many."""


def diameters(
    pattern: CreasePattern,
    spots: Floats,
    by_face: ByFace,
    stops: Mapping[int, float],
    material: Material,
    relief: Relief,
) -> dict[int, float]:
    """Return the diameter of the hole at each vertex that gets one, mm, by vertex.

    "needed" are the vertices at which grooves of both faces end too near each other, "all" are
    those that scores stop short of. Raises CannotPlan where the outline is not cut through.
    """
    if relief == "none":
        return {}
    if relief == "all":
        where = sorted(stops)
    else:
        where = sorted(spacing.tight_vertices(pattern, spots, by_face, stops, material))
    if where and not material.cut.goes_through:
        raise CannotPlan(
            f"{len(where)} relief holes are wanted, and {material.cut.title} makes none. Plan with "
            f"--outline through-cut on a machine that offers it, or without --relief."
        )
    edges = pattern.edges[np.concatenate(list(by_face.values()))]
    creases = np.bincount(edges.ravel(), minlength=len(pattern.vertices))
    return {v: diameter(int(creases[v]), material) for v in where}


def diameter(creases: int, material: Material) -> float:
    """Return the diameter of a relief hole at a vertex where so many creases are scored, mm."""
    share = SHARES[creases >= MANY]
    return round(max(material.relief_diameter, share * material.thickness, SMALLEST), 6)


def holes(found: Mapping[int, float], spots: Floats) -> tuple[Hole, ...]:
    """Return the holes on the sheet, by vertex."""
    return tuple(
        Hole(x=float(spots[v, 0]), y=float(spots[v, 1]), diameter=d) for v, d in found.items()
    )


def strokes(
    relief: tuple[Hole, ...], repeats: int, start: Floats, offset: float
) -> tuple[Stroke, ...]:
    """Return the rims of relief holes in order of work.

    start : (2,) where the tool is; offset : of the blade that programs make up for, mm.
    """
    rims = [hole_rim(hole, offset) for hole in relief]
    return order.sorted_strokes(rims, repeats, start, nested=True)


def findings(relief: tuple[Hole, ...], pattern: CreasePattern, spots: Floats) -> Iterator[Finding]:
    """Yield a finding for every hole that comes too near another, or too near a cut."""
    import shapely

    rims = [shapely.Point(hole.x, hole.y).buffer(hole.diameter / 2) for hole in relief]
    open_edges = (pattern.assignments == 0) | (pattern.assignments == 5)
    ends = spots[pattern.edges[open_edges]]
    gaps = np.array([_from_cuts(hole, rim, ends) for hole, rim in zip(relief, rims, strict=True)])
    earlier, later = np.triu_indices(0)
    if len(rims) > 1:
        reach = max(hole.diameter for hole in relief) / 2
        earlier, later = shapely.STRtree(rims).query(rims, predicate="dwithin", distance=reach)
        earlier, later = earlier[earlier < later], later[earlier < later]
    np.minimum.at(gaps, later, shapely.distance(np.array(rims)[earlier], np.array(rims)[later]))
    for hole, gap in zip(relief, gaps.tolist(), strict=True):
        if gap < hole.diameter / 2:
            yield Finding(
                "relief-too-near",
                Severity.ERROR if gap == 0 else Severity.WARNING,
                f"relief hole at ({hole.x:.1f}, {hole.y:.1f}) mm",
                f"Its rim is {gap:.2f} mm from the next hole or cut; {hole.diameter / 2:.2f} mm "
                f"should remain.",
                "Enlarge the design, or plan with --relief needed or none.",
                (hole.x, hole.y),
            )


def _from_cuts(hole: Hole, rim: Any, ends: Floats) -> float:
    """Return how far a hole's rim is from the cuts (n, 2, 2) that do not begin in it, mm."""
    import shapely

    middle = np.array([hole.x, hole.y])
    away = np.hypot(*(ends - middle).transpose(2, 0, 1))
    others = ends[~(away < TOUCH).any(axis=1)]
    if not len(others):
        return np.inf
    reach = np.hypot(*(others - middle).transpose(2, 0, 1)).min(axis=1)
    near = reach <= reach.min() + np.hypot(*(others[:, 1] - others[:, 0]).T)
    return float(shapely.distance(rim, shapely.MultiLineString(list(others[near]))))
