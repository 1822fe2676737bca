"""The elements of one FOLD frame as lists, and how they stand to a crease pattern.

A file has polygons where a pattern has triangles; the edges that triangulate them are *added*.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from foldmill.pattern import Assignment, CreasePattern, Indices

Source = tuple[int, ...]
"""Which elements one stands for: (i,) repeats i, (i, j) lies midway between both, () is new."""


_LETTERS = {int(each): each.name for each in Assignment}


@dataclass
class Graph:
    """Edges and faces of a frame in a file, and what each repeats of the frame it was made from."""

    edges: list[tuple[int, int]]
    letters: list[str]
    angles: list[float]
    faces: list[list[int]]
    vertex_source: list[Source]
    edge_source: list[Source]
    face_source: list[Source]
    cuts: list[list[int] | None] = field(default_factory=list)
    """Per edge: None, or [a, b] where it stands for the cut from a to b, or [] for its copies."""
    owners: dict[int, int] = field(default_factory=dict)
    """The polygon of each triangle, where they differ in number."""

    def spread(self, key: str, value: Any) -> Any:
        """Return a per-element array of the original frame as one of this frame.

        Anything that is no array over the original's elements is returned as it is.
        """
        sources = self.sources(key)
        if key == "faceOrders" and self.owners and isinstance(value, list):
            return [self._order(order) for order in value]
        count = 1 + max((max(source) for source in sources if source), default=-1)
        if not isinstance(value, list) or len(value) != count:
            return value
        if key == "vertices_coords":
            return [middle([value[i] for i in source]) for source in sources]
        return [value[source[0]] if len(source) == 1 else None for source in sources]

    def _order(self, order: Any) -> Any:
        """Return [f, g, s] for the first triangles of the polygons f and g."""
        if not is_order(order):
            return order
        first = {polygon: face for face, polygon in reversed(self.owners.items())}
        return [first.get(order[0], order[0]), first.get(order[1], order[1]), order[2]]

    def sources(self, key: str) -> list[Source]:
        """Return the sources of the elements a key is about; none for any other key."""
        kinds = {
            "vertices": self.vertex_source,
            "edges": self.edge_source,
            "faces": self.face_source,
        }
        return kinds.get(key.split("_", 1)[0], []) if "_" in key else []


def middle(places: list[list[float]]) -> list[float]:
    """Return the place midway between several, or the only one."""
    if len(places) == 1:
        return places[0]
    return [sum(axis) / len(places) for axis in zip(*places, strict=True)]


def is_order(order: object) -> bool:
    """Tell whether a value is a layer order [f, g, s] of two faces."""
    return isinstance(order, list) and len(order) == 3 and all(isinstance(n, int) for n in order)


def numbered(count: int) -> list[Source]:
    """Return sources of elements that are their own originals."""
    return [(k,) for k in range(count)]


def side_faces(faces: Iterable[list[int]]) -> dict[tuple[int, int], int]:
    """Return the face to the left of every directed side."""
    return {
        (face[k - 1], face[k]): number
        for number, face in enumerate(faces)
        for k in range(len(face))
    }


def of_triangles(pattern: CreasePattern) -> Graph:
    """Return a pattern as it is, triangle by triangle; added edges stand for nothing."""
    added = _flags(pattern)
    numbers = iter(range(len(added)))
    owners = _owners(pattern)
    graph = Graph(
        _pairs(pattern.edges),
        list(pattern.letters()),
        pattern.fold_angles.tolist(),
        pattern.faces.tolist(),
        numbered(len(pattern.vertices)),
        [() if is_added else (next(numbers),) for is_added in added],
        [(owner,) for owner in owners],
    )
    graph.owners = dict(enumerate(owners))
    return graph


def of_polygons(pattern: CreasePattern, corners: list[int]) -> Graph | None:
    """Return a pattern with its polygons whole and the added edges left out.

    corners : the vertex each polygon begins with, where known. None where the added edges bound no
    simple polygons, or are not flat: then only the triangles tell the truth.
    """
    added = _flags(pattern)
    dropped = {frozenset(edge) for edge in pattern.edges[added].tolist()}
    loops: list[list[int] | None] = (
        [_rim(group, dropped) for group in _groups(pattern)] if dropped else pattern.faces.tolist()
    )
    if None in loops or any(added & (pattern.assignments != Assignment.F)):
        return None
    starts = corners if len(corners) == len(loops) else [-1] * len(loops)
    kept = np.flatnonzero(~added)
    return Graph(
        _pairs(pattern.edges[kept]),
        [_LETTERS[code] for code in pattern.assignments[kept].tolist()],
        pattern.fold_angles[kept].tolist(),
        [_turned(loop, start) for loop, start in zip(loops, starts, strict=True) if loop],
        numbered(len(pattern.vertices)),
        numbered(len(kept)),
        numbered(len(loops)),
    )


def _pairs(edges: Indices) -> list[tuple[int, int]]:
    first, second = edges.T.tolist()  # by columns: a list for each edge would be garbage to collect
    return list(zip(first, second, strict=True))


def _flags(pattern: CreasePattern) -> np.ndarray[Any, np.dtype[np.bool_]]:
    return np.asarray(pattern.added, bool)


def _owners(pattern: CreasePattern) -> list[int]:
    """Return the polygon of each triangle, numbered by first appearance."""
    owner: dict[int, int] = {}
    added = _flags(pattern)
    joined = list(range(len(pattern.faces)))

    def root(face: int) -> int:
        while joined[face] != face:
            face = joined[face]
        return face

    for left, right in pattern.edge_faces[added].tolist():
        if left >= 0 and right >= 0:
            first, second = sorted((root(left), root(right)))
            joined[second] = first
    return [owner.setdefault(root(face), len(owner)) for face in range(len(joined))]


def _groups(pattern: CreasePattern) -> list[list[list[int]]]:
    owners = _owners(pattern)
    groups: list[list[list[int]]] = [[] for _ in range(max(owners, default=-1) + 1)]
    for owner, face in zip(owners, pattern.faces.tolist(), strict=True):
        groups[owner].append(face)
    return groups


def _rim(group: list[list[int]], dropped: set[frozenset[int]]) -> list[int] | None:
    """Chain the sides of some triangles that are not dropped; None if they are no single loop."""
    if len(group) == 1:
        return group[0]
    sides = [(face[k - 1], face[k]) for face in group for k in range(3)]
    after = {a: b for a, b in sides if frozenset((a, b)) not in dropped}
    loop = [min(after)]
    while len(loop) <= len(after) and after.get(loop[-1], loop[0]) != loop[0]:
        loop.append(after[loop[-1]])
    return loop if len(loop) == len(after) == len(group) + 2 else None


def _turned(loop: list[int], start: int) -> list[int]:
    if start not in loop:
        return loop
    k = loop.index(start)
    return loop[k:] + loop[:k]
