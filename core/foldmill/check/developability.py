"""Can the sheet be flat at every vertex? The angles of the faces round it must sum to 360 degrees.

Once for the pattern, where less is a gap in the paper and more is paper upon paper, and once for
the folded form, where another sum means that no flat sheet folds to it.
"""

from __future__ import annotations

import numpy as np

from foldmill.check.limits import limits
from foldmill.check.report import Figure, Report, not_checked, vertex_name
from foldmill.design import Fold
from foldmill.finding import Finding, Severity
from foldmill.pattern import CreasePattern, Floats, Indices
from foldmill.vectors import cross, lengths


def angle_sums(points: Floats, faces: Indices) -> Floats:
    """Return the sum (V,) of the face angles at every vertex, rad.

    points : (V, 2) or (V, 3); faces : (F, 3).
    """
    solid = np.zeros((len(points), 3))
    solid[:, : points.shape[1]] = points
    corner = solid[faces]
    u, v = corner[:, [1, 2, 0]] - corner, corner[:, [2, 0, 1]] - corner
    angles = np.arctan2(lengths(cross(u, v)), (u * v).sum(axis=2))
    sums: Floats = np.bincount(faces.T.ravel(), angles.T.ravel(), len(points)).astype(np.float64)
    return sums


def developability(fold: Fold) -> Report:
    """Compare the angle sums of the pattern, and of the folded form, with 2π."""
    pattern = fold.pattern
    limit = limits(fold).angle_sum_rad
    flat = _measure(pattern, pattern.vertices, limit, "angle_sum", "pattern")
    if fold.folded is None:
        names = ("folded_angle_sum_rad", "folded_angle_sum_vertex")
        return Report.joined([flat, not_checked("the angle sums in space", *names)])
    solid = _measure(pattern, fold.folded.vertices, limit, "folded_angle_sum", "folded form")
    return Report.joined([flat, solid])


def _measure(
    pattern: CreasePattern, points: Floats, limit: float, figure: str, place: str
) -> Report:
    inner = pattern.interior_vertices
    gaps = angle_sums(points, pattern.faces)[inner] - 2 * np.pi
    if not len(inner):
        return Report((), {f"{figure}_rad": 0.0, f"{figure}_vertex": "none"})
    worst = int(np.abs(gaps).argmax())
    figures: dict[str, Figure] = {
        f"{figure}_rad": abs(float(gaps[worst])),
        f"{figure}_limit_rad": limit,
        f"{figure}_vertex": int(inner[worst]),
    }
    wrong = int(np.count_nonzero(np.abs(gaps) > limit))
    if not wrong:
        return Report((), figures)
    gap = float(gaps[worst])
    finding = Finding(
        figure.replace("_", "-"),
        Severity.ERROR,
        vertex_name(pattern, int(inner[worst])),
        f"The angles round {wrong} of {len(inner)} inner vertices of the {place} do not sum to "
        f"360°; here they are {abs(np.degrees(gap)):.3g}° too {'many' if gap > 0 else 'few'}.",
        "No flat sheet does this; move the vertex, or cut the sheet there.",
    )
    return Report((finding,), figures)
