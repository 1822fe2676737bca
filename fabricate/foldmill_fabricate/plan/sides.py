"""Which face of the sheet carries the score of which crease."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from foldmill import Assignment, CreasePattern
from foldmill_fabricate.errors import CannotPlan
from foldmill_fabricate.kinds import Unassigned
from foldmill_fabricate.materials import Score
from foldmill_fabricate.passes import Face

Indices = NDArray[np.intp]


def scored_edges(
    pattern: CreasePattern, score: Score, unassigned: Unassigned | None = None
) -> dict[Face, Indices]:
    """Return the edges scored on each face.

    A half-cut opens on the outside of its fold: mountains on the front, valleys on the reverse. A
    process that creases the inside does the opposite; one that goes through does it once, on the
    reverse pass. Flat edges are not scored. Raises CannotPlan for U edges without an order.
    """
    codes = pattern.assignments
    folds = np.abs(pattern.fold_angles) >= score.min_scored_angle
    mountains = np.flatnonzero((codes == Assignment.M) & folds)
    valleys = np.flatnonzero((codes == Assignment.V) & folds)
    if score.score_face == "either":
        faces = {Face.FRONT: mountains[:0], Face.REVERSE: np.append(mountains, valleys)}
    elif score.score_face == "outside":
        faces = {Face.FRONT: mountains, Face.REVERSE: valleys}
    else:
        faces = {Face.FRONT: valleys, Face.REVERSE: mountains}
    open_edges = np.flatnonzero(codes == Assignment.U)
    if len(open_edges) and unassigned is None:
        raise CannotPlan(
            f"{len(open_edges)} creases are neither mountain nor valley, so nobody can tell their "
            f"face. Say where they are scored with --unassigned front, reverse or skip."
        )
    if unassigned in {"front", "reverse"}:
        face = Face(unassigned)
        faces[face] = np.append(faces[face], open_edges)
    return {face: np.sort(edges) for face, edges in faces.items()}
