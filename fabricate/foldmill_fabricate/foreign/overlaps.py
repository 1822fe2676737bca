"""Lines that run along each other: cut as drawn, the knife would go over them twice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.passes import Stroke

Floats = NDArray[np.float64]

BESIDE_MM = 0.02
"""mm. Lines this near to each other are one line: less than a plotter step."""
ALONG_MM = 0.1
"""mm. Two lines may run along each other for as long as this: where they cross at a small angle."""


def refuse(strokes: Sequence[Stroke]) -> None:
    """Raise CannotPlan where two lines, or two parts of one, run along each other."""
    import shapely

    lines = np.concatenate([_pieces(stroke) for stroke in strokes])
    shapes = shapely.linestrings(lines)
    i, j = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=BESIDE_MM)
    first = i < j
    along = _along(lines[i[first]], lines[j[first]])
    if not len(along) or along.max() <= ALONG_MM:
        return
    worst = int(np.argmax(along))
    (x, y), (u, v) = lines[i[first][worst]].tolist()
    count = int((along > ALONG_MM).sum())
    more = f", and {count - 1} more do" if count > 1 else ""
    raise CannotPlan(
        f"Two lines run along each other for {along[worst]:.2f} mm, from ({x:.2f}, {y:.2f}) to "
        f"({u:.2f}, {v:.2f}) mm of the blank{more}: they would be cut twice. Draw each line once; "
        "how often the knife repeats it comes from the material."
    )


def _pieces(stroke: Stroke) -> Floats:
    """Return the straight pieces (n, 2, 2) of a stroke, mm."""
    points = np.asarray(stroke.points, float)
    return np.stack([points[:-1], points[1:]], axis=1)


def _along(these: Floats, those: Floats) -> Floats:
    """Return for how long (n,) mm pieces run beside others, near and in one direction."""
    course = these[:, 1] - these[:, 0]
    length = np.hypot(*course.T)
    unit = course / np.maximum(length, 1e-12)[:, None]
    arms = those - these[:, :1]
    place = (arms * unit[:, None]).sum(axis=-1)
    beside = np.abs(arms[..., 0] * unit[:, None, 1] - arms[..., 1] * unit[:, None, 0])
    low, high = np.maximum(place.min(axis=1), 0), np.minimum(place.max(axis=1), length)
    across = np.abs(those[:, 1] - those[:, 0]).sum(axis=-1)
    steep = np.ptp(arms[..., 0] * unit[:, None, 1] - arms[..., 1] * unit[:, None, 0], axis=1)
    near = (beside.min(axis=1) <= BESIDE_MM) & (steep <= 0.05 * np.maximum(across, 1e-12))
    shared: Floats = np.where(near, high - low, 0.0)
    return shared
