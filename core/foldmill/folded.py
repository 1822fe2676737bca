"""The folded form: where each vertex of a pattern ends up, and what that says of each crease."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill import planar
from foldmill.errors import InvalidPattern
from foldmill.pattern import Assignment, Codes, CreasePattern, Floats, Indices
from foldmill.tolerances import CLOSED_DEG, FLAT_DEG
from foldmill.vectors import cross, units


def _no_seams() -> Indices:
    return np.zeros((0, 2), np.intp)


@dataclass(frozen=True, eq=False)
class FoldedForm:
    """The vertices of a pattern in space, over the same edges and faces."""

    vertices: Floats
    """(V, 3) mm."""
    seams: Indices = field(default_factory=_no_seams)
    """(S, 2) pairs of vertices that are two in the pattern and one in space."""

    def __post_init__(self) -> None:
        for name, value, dtype, width in (
            ("vertices", self.vertices, np.float64, 3),
            ("seams", self.seams, np.intp, 2),
        ):
            array = np.array(value, dtype)
            if array.ndim != 2 or array.shape[1] != width or not np.isfinite(array).all():
                raise InvalidPattern(f"The folded form's {name} must be finite, (n, {width}).")
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        if ((self.seams < 0) | (self.seams >= len(self.vertices))).any():
            raise InvalidPattern("The folded form's seams name a vertex that is not there.")

    @property
    def size(self) -> float:
        """The largest side of the bounding box, mm."""
        return float(np.ptp(self.vertices, axis=0).max())


def face_normals(vertices: Floats, faces: Indices) -> Floats:
    """Return the unit normals (F, 3) of triangles (F, 3) over vertices (V, 3)."""
    first = vertices[faces[:, 0]]
    return units(cross(vertices[faces[:, 1]] - first, vertices[faces[:, 2]] - first))


def fold_angles(
    vertices: ArrayLike, edges: Indices, faces: Indices, edge_faces: Indices
) -> NDArray[np.float64]:
    """Return the fold angle of every edge, deg: valley positive, mountain negative, borders 0.

    For an edge a→b with unit direction ê, left face f and right face g:
    −atan2((n_f × n_g)·ê, n_f·n_g). Near ±180 the sign is noise.
    """
    points = np.asarray(vertices, np.float64)
    normals = face_normals(points, faces)
    inner = (edge_faces >= 0).all(axis=1)
    f, g = normals[edge_faces[inner, 0]], normals[edge_faces[inner, 1]]
    along = units(points[edges[inner, 1]] - points[edges[inner, 0]])
    sine = np.einsum("ij,ij->i", cross(f, g), along)
    angles = np.zeros(len(edges))
    angles[inner] = -np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", f, g)))
    return angles


def assign(angles: Floats, edge_faces: Indices, closed_sign: ArrayLike) -> tuple[Codes, Floats]:
    """Return the assignment and the clean angle of every edge from its measured fold angle.

    angles : (E,) deg; edge_faces : (E, 2);
    closed_sign : (E,) +1 (valley), -1 (mountain) or 0 (not stated) where an edge folds to ±180.
    An edge folded to ±180 without a stated sign becomes U.
    """
    stated = np.asarray(closed_sign, int)
    codes = np.where(angles > 0, Assignment.V, Assignment.M).astype(np.uint8)
    clean = np.array(angles, float)
    flat = np.abs(angles) <= FLAT_DEG
    codes[flat], clean[flat] = Assignment.F, 0.0
    closed = np.abs(angles) >= 180.0 - CLOSED_DEG
    codes[closed] = np.choose(stated[closed] + 1, (Assignment.M, Assignment.U, Assignment.V))
    clean[closed] = 180.0 * stated[closed]
    border = (edge_faces < 0).any(axis=1)
    codes[border], clean[border] = Assignment.B, 0.0
    return codes, clean


def fold_pattern(
    flat: Floats, spatial: Floats, edges: Indices, faces: Indices, closed_sign: ArrayLike
) -> tuple[CreasePattern, FoldedForm]:
    """Make a pattern and its folded form, with mountain, valley and flat read off the form.

    flat : (V, 2) mm; spatial : (V, 3) mm; edges : (E, 2); faces : (F, 3);
    closed_sign : (E,) as for ``assign``.
    """
    around = planar.edge_faces(edges, faces)
    codes, angles = assign(fold_angles(spatial, edges, faces, around), around, closed_sign)
    return CreasePattern(flat, edges, codes, angles, faces), FoldedForm(spatial)
