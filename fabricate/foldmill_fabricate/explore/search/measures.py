"""What a fold measures, in the words of the targets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill import Fold
from foldmill_fabricate.explore.search.fit import Room, room
from foldmill_fabricate.pictures.render import form_of

Floats = NDArray[np.float64]

LEVEL = 1e-6
"""Share of the form's size by which points of one level may differ in height."""


def measures(fold: Fold, sheet: Room, *, seat: bool = True) -> dict[str, float]:
    """Return the measures of a fold by name, mm, and ``over``: what is missing on the sheet.

    seat : whether to take the seat as well, which is the slowest. Raises InvalidInput where there
    is no folded form.
    """
    spots = form_of(fold).vertices
    x, y, z = (float(side) for side in np.ptp(spots, axis=0))
    taken = room(fold.pattern.vertices, sheet)
    found = {
        "height": z,
        "width": max(x, y),
        "width_x": x,
        "width_y": y,
        "footprint": footprint(spots),
        "sheet_x": taken.width,
        "sheet_y": taken.height,
        "over": taken.over,
        "crease": float(fold.pattern.edge_lengths.min()),
    }
    return found | ({"seat": seat_width(fold)} if seat else {})


def footprint(spots: Floats) -> float:
    """Return the diameter of the circle about the axis through the outermost lowest points, mm."""
    lowest = spots[spots[:, 2] <= spots[:, 2].min() + LEVEL * float(np.ptp(spots, axis=0).max())]
    return 2 * float(np.hypot(lowest[:, 0], lowest[:, 1]).max())


def seat_width(fold: Fold) -> float:
    """Return the diameter of the largest circle in the level facets at the top, mm; else 0.

    For a regular polygon that is its width across flats, of an even number of sides.
    """
    import shapely

    spots = form_of(fold).vertices
    level = spots[:, 2] >= spots[:, 2].max() - LEVEL * float(np.ptp(spots, axis=0).max())
    facets = fold.pattern.faces[level[fold.pattern.faces].all(axis=1)]
    if not len(facets):
        return 0.0
    top = shapely.union_all(shapely.polygons(spots[facets][:, :, :2]))
    if top.is_empty or top.area <= 0:
        return 0.0
    parts = getattr(top, "geoms", [top])
    return 2 * max(_radius(part) for part in parts if part.area > 0)


def _radius(part: object) -> float:
    """Return the radius of the largest circle inside a polygon, exactly where it is about its
    middle, as in every form that is the same when turned."""
    import shapely

    about = shapely.maximum_inscribed_circle(part).length
    middle = shapely.centroid(part)
    inside = (
        shapely.distance(shapely.boundary(part), middle) if shapely.contains(part, middle) else 0
    )
    return float(max(about, inside))
