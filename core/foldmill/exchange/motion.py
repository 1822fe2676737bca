"""A motion as the frames of a FOLD file: the pattern once, then where its vertices are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foldmill.design import Fold
from foldmill.folded import fold_angles
from foldmill.motion import Motion
from foldmill.tolerances import CLOSED_DEG

Floats = NDArray[np.float64]


def with_frames(fold: Fold, motion: Motion, steps: int) -> Fold:
    """Return the fold with a frame for each of ``steps`` + 1 places of the motion.

    Each frame inherits the pattern and states vertices_coords and edges_foldAngle, the form that
    readers of animated FOLD files agree on. Write it with ``exchange.write``.
    """
    kept = dict(fold.meta.get("fold", {}))
    places = [motion.reach * k / steps for k in range(steps + 1)]
    kept["frames"] = [_frame(fold, motion, t) for t in places]
    kept["frame"] = {**kept.get("frame", {}), "file_classes": ["animation"]}
    return replace(fold, meta={**fold.meta, "fold": kept})


def _frame(fold: Fold, motion: Motion, t: float) -> dict[str, Any]:
    vertices = motion.at(t)
    return {
        "frame_title": f"{motion.name} t={t:.6g}",
        "frame_classes": ["foldedForm"],
        "frame_attributes": ["3D"],
        "frame_parent": 0,
        "frame_inherit": True,
        "vertices_coords": vertices.tolist(),
        "edges_foldAngle": _angles(fold, vertices).tolist(),
    }


def _angles(fold: Fold, vertices: Floats) -> Floats:
    """Return the fold angles (E,) deg on the way; near ±180 with the sign of the pattern."""
    pattern = fold.pattern
    angles = fold_angles(vertices, pattern.edges, pattern.faces, pattern.edge_faces)
    closed = np.abs(angles) >= 180 - CLOSED_DEG
    angles[closed] = 180 * np.sign(pattern.fold_angles[closed])
    return angles
