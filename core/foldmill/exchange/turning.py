"""A sheet seen from its other side, or its mirror image."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from foldmill.design import Fold
from foldmill.folded import FoldedForm
from foldmill.pattern import Assignment, CreasePattern

_SWAPPED = {Assignment.M: Assignment.V, Assignment.V: Assignment.M}
_ABOUT_FACES = ("faceOrders", "edgeOrders")


def turned(fold: Fold, *, back: bool = False, mirror: bool = False) -> Fold:
    """Return the fold of a file that shows the back of the sheet, or a mirror image of it.

    Seen from the back, left is right and mountains are valleys: the object is the same one. In a
    mirror image left is right and mountains are mountains: the object is another one. What was
    computed for the sheet as it was, its design, symmetry and layer orders, is left out.
    """
    if not (back or mirror):
        return fold
    pattern = _pattern(fold.pattern, swap=back, flip=back != mirror)
    kept = dict(fold.meta.get("fold", {}))
    kept["frame"] = _without(kept.get("frame", {}))
    kept["frames"] = []
    meta: dict[str, Any] = {
        **{k: v for k, v in fold.meta.items() if k not in {"design", "designed"}},
        "fold": kept,
    }
    return replace(
        fold, pattern=pattern, folded=_folded(fold.folded, mirror), symmetry=None, meta=meta
    )


def _pattern(pattern: CreasePattern, *, swap: bool, flip: bool) -> CreasePattern:
    points, faces, codes = pattern.vertices, pattern.faces, pattern.assignments
    angles = pattern.fold_angles
    if flip:
        across = points[:, 0].min() + points[:, 0].max()
        points = np.stack([across - points[:, 0], points[:, 1]], axis=1)
        faces = faces[:, ::-1]
    if swap:
        codes = np.array([_SWAPPED.get(Assignment(c), c) for c in codes.tolist()], np.uint8)
        angles = -angles + 0.0
    return replace(pattern, vertices=points, faces=faces, assignments=codes, fold_angles=angles)


def _folded(folded: FoldedForm | None, mirror: bool) -> FoldedForm | None:
    if folded is None or not mirror:
        return folded
    return replace(folded, vertices=folded.vertices * [-1.0, 1.0, 1.0])


def _without(frame: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in frame.items() if key not in _ABOUT_FACES}
