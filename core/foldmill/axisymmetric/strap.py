"""A strap that closes a slit: a piece of the sheet itself, cut once more, to be glued over it.

A slit without width leaves no paper for a tab, and beside it lies the next wedge. But whatever lies
flush upon the closed form on both sides of the slit holds it together, and that is the strip of the
unslit sheet about the line of the slit: it has the creases of the sheet, the one along the slit
among them, and folds as the sheet does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foldmill import planar
from foldmill.design import Fold
from foldmill.errors import ImpossibleGeometry
from foldmill.folded import FoldedForm
from foldmill.pattern import Assignment, CreasePattern
from foldmill.tolerances import COINCIDENT_MM
from foldmill.triangulation import triangulate

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SPREAD = 0.8
"""Share of the half wedge that a strap takes at its inner end: so it stays clear of the creases on
the next lines, and of the centre where all creases meet."""


@dataclass(frozen=True, eq=False)
class _Patch:
    """What a face of the sheet leaves within the strap."""

    face: int
    flat: Floats
    """(k, 2) its corners, counter-clockwise, mm."""
    spatial: Floats
    """(k, 3)"""


def cut(fold: Fold, folded: FoldedForm, mouth: Floats, order: int, width: float) -> Fold:
    """Return the strap of a closed sheet as a fold of its own.

    fold : the sheet without a slit; mouth : (2,) where the slit ends at the outline, in its
    pattern; order : N; width : mm on either side of the slit.
    Raises ImpossibleGeometry where a strap so wide has no room between the lines beside the slit.
    """
    away = float(np.hypot(*mouth))
    start = width / np.tan(SPREAD * np.pi / order)
    if start >= away - width:
        widest = away / (1 + 1 / np.tan(SPREAD * np.pi / order))
        raise ImpossibleGeometry(
            f"A strap {width:g} mm wide on either side has no room beside the slit, which is "
            f"{away:.4g} mm long: it must be narrower than {widest:.4g} mm. Make strap smaller."
        )
    along = mouth / away
    across = np.array([-along[1], along[0]])
    # Half planes n·x >= d that bound the strap; the outline bounds its outer end.
    bounds = [(along, start), (across, -width), (-across, -width)]
    patches = [
        patch
        for face in range(len(fold.pattern.faces))
        if (patch := _patch(fold, folded, face, bounds))
    ]
    strap = _joined(fold.pattern, patches)
    return replace(strap, meta={"title": f"Strap over a slit, {width:g} mm to either side"})


def _patch(
    fold: Fold, folded: FoldedForm, face: int, bounds: list[tuple[Floats, float]]
) -> _Patch | None:
    corners = fold.pattern.faces[face]
    both = np.hstack([fold.pattern.vertices[corners], folded.vertices[corners]])
    for normal, distance in bounds:
        both = _clipped(both, both[:, :2] @ normal - distance)
    if len(both) < 3 or planar.signed_area(both[:, :2]) <= COINCIDENT_MM:
        return None
    return _Patch(face, both[:, :2], both[:, 2:])


def _clipped(corners: Floats, inside: Floats) -> Floats:
    """Return the part of a convex polygon (k, n) where ``inside`` (k,) is not negative."""
    kept = []
    for k in range(len(corners)):
        here, after = inside[k], inside[(k + 1) % len(corners)]
        if here >= 0:
            kept.append(corners[k])
        if here * after < 0:
            share = here / (here - after)
            kept.append(corners[k] + share * (corners[(k + 1) % len(corners)] - corners[k]))
    return np.array(kept).reshape(-1, corners.shape[1])


def _joined(sheet: CreasePattern, patches: list[_Patch]) -> Fold:
    """Weld patches to one sheet whose creases are those of the sheet they are from."""
    flat, spatial, every = _welded(patches)
    solid = [(patch, loop) for patch, loop in zip(patches, every, strict=True) if len(loop) > 2]
    loops = [loop for _, loop in solid]
    owner = {(loop[k - 1], loop[k]): patch.face for patch, loop in solid for k in range(len(loop))}
    edges = sorted({(min(side), max(side)) for side in owner})
    known = {frozenset(pair): e for e, pair in enumerate(sheet.edge_faces.tolist())}
    crease = [
        known.get(frozenset((owner.get((a, b), -1), owner.get((b, a), -1)))) for a, b in edges
    ]
    inner = np.array([(a, b) in owner and (b, a) in owner for a, b in edges])
    own = np.array([0 if e is None else e for e in crease])
    faces, owners, extra = triangulate(flat, loops)
    none = np.zeros(len(extra))
    pattern = CreasePattern(
        flat,
        np.vstack([np.array(edges, np.intp), extra]),
        np.append(np.where(inner, sheet.assignments[own], Assignment.B), none + Assignment.F),
        np.append(np.where(inner, sheet.fold_angles[own], 0.0), none),
        faces,
        np.append(np.zeros(len(edges), bool), none == 0),
        owners,
    )
    return Fold(pattern, FoldedForm(spatial))


def _welded(patches: list[_Patch]) -> tuple[Floats, Floats, list[list[int]]]:
    """Return the vertices flat and in space, and each patch as a loop of their numbers."""
    from scipy.spatial import cKDTree

    flat, spatial = (np.vstack([getattr(p, name) for p in patches]) for name in ("flat", "spatial"))
    near = cKDTree(flat).query_ball_point(flat, COINCIDENT_MM)
    first = np.array([min(group) for group in near])
    kept, number = np.unique(first, return_inverse=True)
    ends = np.cumsum([len(patch.flat) for patch in patches])
    loops = [part.tolist() for part in np.split(number, ends[:-1])]
    single = [[v for k, v in enumerate(loop) if v != loop[k - 1]] for loop in loops]
    return flat[kept], spatial[kept], single
