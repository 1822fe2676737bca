"""Slits: cuts of no width. In the pattern their two banks lie upon each other.

A sheet that opens along a slit has two vertices wherever the slit has one place, so that each bank
can move by itself; the slit's end inside the sheet is one vertex. Both banks are boundary edges.
Whoever asks about the sheet as it lies flat (do lines cross? what is to be cut?) sews the slit up
first: then each pair of banks is one inner cut.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from foldmill.errors import InvalidPattern
from foldmill.pattern import Assignment, CreasePattern, Indices
from foldmill.tolerances import COINCIDENT_MM


@dataclass(frozen=True, eq=False)
class Sewn:
    """A pattern whose slits are sewn up: one inner cut (C) for each pair of banks."""

    pattern: CreasePattern
    """Vertices keep their numbers; the second one of a pair belongs to no edge any more."""
    edges: Indices
    """(E',) the edge of the opened pattern behind each edge: the first one of two banks."""
    pairs: Indices
    """(k, 2) vertices that are two in the opened pattern and one here, the one that is kept first,
    ascending."""


def banks(pattern: CreasePattern) -> Indices:
    """Return the pairs (s, 2) of boundary edges that are the two banks of a slit, ascending.

    They lie upon each other, and the paper is on opposite sides of them. Boundary edges upon each
    other with paper on one side only are paper upon paper, and no slit.
    """
    border = np.flatnonzero(pattern.assignments == Assignment.B)
    place = _places(pattern, np.unique(pattern.edges[border]))
    if place is None:
        return np.zeros((0, 2), np.intp)
    lies: dict[tuple[int, int], list[int]] = {}
    for edge, (a, b) in zip(border.tolist(), place[pattern.edges[border]].tolist(), strict=True):
        lies.setdefault((min(a, b), max(a, b)), []).append(edge)
    pairs = [own for own in lies.values() if len(own) == 2 and _face_away(pattern, place, own)]
    return np.array(sorted(pairs), np.intp).reshape(-1, 2)


def _places(pattern: CreasePattern, among: Indices) -> Indices | None:
    """Return for each vertex (V,) the lowest one of ``among`` at its place; None without any."""
    from scipy.spatial import cKDTree

    if not len(among):
        return None
    near = cKDTree(pattern.vertices[among]).query_pairs(COINCIDENT_MM, output_type="ndarray")
    if not len(near):
        return None
    place = np.arange(len(pattern.vertices))
    for low, high in among[np.sort(near, axis=1)].tolist():
        place[high] = min(place[high], place[low])
    return place


def _face_away(pattern: CreasePattern, place: Indices, pair: list[int]) -> bool:
    """Tell whether the paper of two edges at one place is on opposite sides of them."""
    runs = []
    for edge in pair:
        a, b = place[pattern.edges[edge]]
        runs.append((a, b) if pattern.edge_faces[edge, 0] >= 0 else (b, a))
    return bool(runs[0] == runs[1][::-1])


def sewn(pattern: CreasePattern) -> Sewn:
    """Sew up every slit of a pattern; one without slits, or that cannot be sewn, stays as it is."""
    pairs = banks(pattern)
    if len(pairs):
        try:
            return _sewn(pattern, pairs)
        except InvalidPattern:  # paper lies upon paper there; the checks say where
            pass
    return Sewn(pattern, np.arange(len(pattern.edges)), np.zeros((0, 2), np.intp))


def _sewn(pattern: CreasePattern, pairs: Indices) -> Sewn:
    kept = np.setdiff1d(np.arange(len(pattern.edges)), pairs[:, 1])
    vertices = _vertex_pairs(pattern, pairs)
    onto = np.arange(len(pattern.vertices))
    onto[vertices[:, 1]] = vertices[:, 0]
    codes = pattern.assignments.copy()
    codes[pairs[:, 0]] = Assignment.C
    added = None if pattern.added is None else pattern.added[kept]
    closed = CreasePattern(
        pattern.vertices,
        onto[pattern.edges[kept]],
        codes[kept],
        pattern.fold_angles[kept],
        onto[pattern.faces],
        added,
        pattern.polygons,
    )
    return Sewn(closed, kept, vertices)


def _vertex_pairs(pattern: CreasePattern, pairs: Indices) -> Indices:
    """Return the pairs (k, 2) of vertices at the ends of pairs of banks, where they are two."""
    found = set()
    for one, two in pairs.tolist():
        (a, b), (c, d) = pattern.edges[one].tolist(), pattern.edges[two].tolist()
        gap = pattern.vertices[[a, b]] - pattern.vertices[[c, d]]
        other = (c, d) if np.abs(gap).max() <= COINCIDENT_MM else (d, c)
        found |= {(min(p), max(p)) for p in zip((a, b), other, strict=True) if p[0] != p[1]}
    return np.array(sorted(found), np.intp).reshape(-1, 2)
