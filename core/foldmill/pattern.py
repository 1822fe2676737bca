"""The crease pattern: one frozen, validated value that crosses every border of foldmill.

Terminology: a *crease* is an interior edge; the *outline* is the loop of boundary edges. Faces are
triangles, counter-clockwise seen from the front. Millimetres, degrees, x right, y up.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foldmill import planar
from foldmill.errors import InvalidPattern
from foldmill.tolerances import COINCIDENT_MM, FLAT_DEG
from foldmill.triangulation import triangulate
from foldmill.vectors import lengths

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Codes = NDArray[np.uint8]
Flags = NDArray[np.bool_]


class Assignment(IntEnum):
    """What an edge is, by the letters of the FOLD format."""

    B = 0
    """boundary"""
    M = 1
    """mountain"""
    V = 2
    """valley"""
    F = 3
    """flat: a line that does not fold"""
    U = 4
    """unassigned"""
    C = 5
    """inner cut"""


@dataclass(frozen=True, eq=False)
class CreasePattern:
    """Vertices, edges and triangles of a sheet, with what each edge is and how far it folds.

    Raises InvalidPattern, naming the index and the reason, for anything that is no such graph.
    Whether edges cross or the outline is single is a question for ``foldmill.check``.
    """

    vertices: Floats
    """(V, 2) mm."""
    edges: Indices
    """(E, 2) vertex indices."""
    assignments: Codes
    """(E,) values of Assignment."""
    fold_angles: Floats
    """(E,) deg in [-180, 180]: valley positive, mountain negative, 0 for all others."""
    faces: Indices
    """(F, 3) vertex indices, counter-clockwise from the front."""
    added: Flags | None = None
    """(E,) True for the flat edges that only triangulate a polygon of an imported file."""
    polygons: Indices | None = None
    """(F,) the imported polygon each triangle is part of; None where every face is its own."""

    def __post_init__(self) -> None:
        added = np.zeros(len(self.edges), bool) if self.added is None else self.added
        polygons = np.arange(len(self.faces)) if self.polygons is None else self.polygons
        for name, value, dtype, shape in (
            ("vertices", self.vertices, np.float64, (-1, 2)),
            ("edges", self.edges, np.intp, (-1, 2)),
            ("assignments", self.assignments, np.uint8, (-1,)),
            ("fold_angles", self.fold_angles, np.float64, (-1,)),
            ("faces", self.faces, np.intp, (-1, 3)),
            ("added", added, np.bool_, (-1,)),
            ("polygons", polygons, np.intp, (-1,)),
        ):
            object.__setattr__(self, name, _frozen(name, value, dtype, shape))
        _validate(self)

    @classmethod
    def from_lines(
        cls,
        vertices: ArrayLike,
        edges: ArrayLike,
        assignments: str | Iterable[str],
        fold_angles: ArrayLike | None = None,
    ) -> CreasePattern:
        """Build a pattern from lines alone; its faces are found and triangulated.

        vertices : (V, 2) mm; edges : (E, 2); assignments : E letters of "BMVFUC";
        fold_angles : (E,) deg, by default -180 for M, 180 for V, 0 for the others.
        The lines must not cross between vertices; raises InvalidPattern where they do.
        """
        points = _frozen("vertices", vertices, np.float64, (-1, 2))
        lines = _frozen("edges", edges, np.intp, (-1, 2))
        codes = codes_of(assignments)
        if len(codes) != len(lines):
            raise InvalidPattern(f"{len(lines)} edges need as many assignments, not {len(codes)}.")
        given = default_angles(codes) if fold_angles is None else fold_angles
        angles = _frozen("fold_angles", given, np.float64, (-1,))
        _validate_ends(points, lines)
        polygons = planar.polygons(points, lines)
        faces, owners, extra = triangulate(points, polygons)
        return cls(
            points,
            np.vstack([lines, extra]) if len(extra) else lines,
            np.append(codes, np.full(len(extra), Assignment.F)).astype(np.uint8),
            np.append(angles, np.zeros(len(extra))),
            faces,
            np.append(np.zeros(len(lines), bool), np.ones(len(extra), bool)),
            owners,
        )

    @cached_property
    def edge_faces(self) -> Indices:
        """(E, 2) the face left and right of each edge, -1 where there is none."""
        return planar.edge_faces(self.edges, self.faces)

    @cached_property
    def edge_lengths(self) -> Floats:
        """(E,) mm."""
        ends = self.vertices[self.edges]
        return lengths(ends[:, 1] - ends[:, 0])

    @cached_property
    def interior_vertices(self) -> Indices:
        """Indices of the vertices that lie on no boundary and no cut."""
        border = (self.assignments == Assignment.B) | (self.assignments == Assignment.C)
        inner = np.zeros(len(self.vertices), bool)
        inner[self.edges] = True
        inner[self.edges[border]] = False
        return np.flatnonzero(inner)

    @cached_property
    def size(self) -> float:
        """The larger side of the bounding box, mm."""
        return float(np.ptp(self.vertices, axis=0).max())

    def letters(self) -> str:
        """Return the assignments as FOLD letters, one per edge."""
        return "".join(Assignment(code).name for code in self.assignments)

    def count(self, assignment: Assignment) -> int:
        """Return how many edges carry the assignment."""
        return int(np.count_nonzero(self.assignments == assignment))

    def outline(self) -> list[Indices]:
        """Return the boundary loops as vertex indices, outermost first, counter-clockwise."""
        return [loop.copy() for loop in self._loops]

    @cached_property
    def _loops(self) -> list[Indices]:
        return planar.loops(self.vertices, self.edges[self.assignments == Assignment.B])


def codes_of(letters: str | Iterable[str]) -> Codes:
    """Turn FOLD letters into assignment codes; raises InvalidPattern for an unknown letter."""
    try:
        return np.array([Assignment[letter] for letter in letters], dtype=np.uint8)
    except KeyError as error:
        raise InvalidPattern(f"An edge is one of B M V F U C, not {error.args[0]!r}.") from None


def default_angles(codes: Codes) -> Floats:
    """Return the angles of a pattern folded flat: -180 for M, 180 for V, 0 for all others, deg."""
    sign = (codes == Assignment.V).astype(float) - (codes == Assignment.M)
    angles: Floats = 180.0 * sign
    return angles


Number = TypeVar("Number", bound=np.generic)


def _frozen(
    name: str, value: ArrayLike, dtype: type[Number], shape: tuple[int, ...]
) -> NDArray[Number]:
    try:
        with np.errstate(invalid="ignore"):  # nan has no whole number; the comparison says so
            array = np.array(value, dtype=dtype)
        is_same = getattr(value, "dtype", None) == array.dtype
        whole = is_same or not np.issubdtype(dtype, np.integer)
        if not whole and not np.array_equal(array, np.asarray(value)):
            raise ValueError("its numbers must be whole and in range")
        array = array.reshape(shape) if array.size == 0 else array
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidPattern(f"{name}: {str(error).rstrip('.')}.") from None
    if array.ndim != len(shape) or (len(shape) > 1 and array.shape[1] != shape[1]):
        wanted = "(n,)" if len(shape) == 1 else f"(n, {shape[1]})"
        raise InvalidPattern(f"{name} has the shape {array.shape}, not {wanted}.")
    array.flags.writeable = False
    return array


def _validate(pattern: CreasePattern) -> None:
    _validate_ends(pattern.vertices, pattern.edges)
    _validate_edges(pattern)
    _validate_faces(pattern)


def _validate_ends(vertices: Floats, edges: Indices) -> None:
    _refuse(~np.isfinite(vertices).all(axis=1), "vertex {} is not finite")
    _refuse(((edges < 0) | (edges >= len(vertices))).any(axis=1), "edge {} names no vertex")


def _validate_edges(pattern: CreasePattern) -> None:
    edges, codes, angles = pattern.edges, pattern.assignments, pattern.fold_angles
    for name in ("assignments", "fold_angles", "added"):
        if len(getattr(pattern, name)) != len(edges):
            raise InvalidPattern(f"{len(edges)} edges need as many {name}.")
    _refuse(pattern.edge_lengths < COINCIDENT_MM, "edge {} has no length")
    is_repeated = np.ones(len(edges), bool)
    is_repeated[planar.unique_pairs(edges)[1]] = False
    _refuse(is_repeated, "edge {} repeats an earlier edge")
    _refuse(codes > max(Assignment), "edge {} has an unknown assignment")
    _refuse(~(np.abs(angles) <= 180), "edge {} folds by more than 180 degrees")
    wrong = ((codes == Assignment.M) & (angles > 0)) | ((codes == Assignment.V) & (angles < 0))
    _refuse(wrong, "edge {}: a mountain folds by a negative angle, a valley by a positive one")
    is_crease = (codes == Assignment.M) | (codes == Assignment.V) | (codes == Assignment.U)
    still = ~is_crease & (np.abs(angles) > FLAT_DEG)
    _refuse(still, "edge {} is no crease and yet has a fold angle")


def _validate_faces(pattern: CreasePattern) -> None:
    faces, points = pattern.faces, pattern.vertices
    if len(pattern.polygons if pattern.polygons is not None else faces) != len(faces):
        raise InvalidPattern(f"{len(faces)} faces need as many polygon numbers.")
    _refuse(((faces < 0) | (faces >= len(points))).any(axis=1), "face {} names no vertex")
    corners = points[faces]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    _refuse(area <= 0, "face {} does not run counter-clockwise")
    # Every side of a face is a side of one edge of its own, unless something is wrong.
    if np.count_nonzero(pattern.edge_faces >= 0) != faces.size:
        fault = planar.topology_fault(pattern.edges, faces)
        raise InvalidPattern(f"In the crease pattern, {fault}.")
    if len(faces):
        sides = (pattern.edge_faces >= 0).sum(axis=1)
        border = pattern.assignments == Assignment.B
        _refuse(border & (sides != 1), "edge {} is boundary, but has not a face on just one side")
        inner = ~border & (pattern.assignments != Assignment.C)
        _refuse(inner & (sides != 2), "edge {} is a crease, but has not a face on either side")


def _refuse(faults: ArrayLike, sentence: str) -> None:
    where = np.flatnonzero(faults)
    if len(where):
        more = f" (and {len(where) - 1} more)" if len(where) > 1 else ""
        raise InvalidPattern(f"In the crease pattern, {sentence.format(where[0])}{more}.")
