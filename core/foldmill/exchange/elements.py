"""Vertices, edges and faces of one frame, read with care: every refusal names the element."""

from __future__ import annotations

from typing import Any

from foldmill.errors import UnreadableFile
from foldmill.exchange.graph import Graph, numbered, side_faces
from foldmill.exchange.json_text import Frame

_LETTERS = "BMVFUCJ"
_CLOSED = 180.0
_LARGEST = 1e9
"""In any unit; no sheet is larger, and areas beyond overflow."""


def coordinates(frame: Frame, width: int) -> list[list[float]]:
    """Return the vertices' coordinates, ``width`` numbers each, 0 where the file has fewer."""
    return [_place(k, place)[:width] for k, place in enumerate(array(frame, "vertices_coords"))]


def _place(number: int, place: Any) -> list[float]:
    fits = isinstance(place, list) and len(place) in {2, 3}
    if not fits or not all(_is_finite(x) for x in place):
        raise UnreadableFile(
            f"Vertex {number} must be 2 or 3 numbers within a billion, not {brief(place)}."
        )
    return [float(x) for x in place] + [0.0] * (3 - len(place))


def _is_finite(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return -_LARGEST <= value <= _LARGEST


def array(frame: Frame, key: str, count: int | None = None) -> list[Any]:
    """Return a list of a frame, of ``count`` entries if given; raises UnreadableFile."""
    value = frame.get(key)
    if not isinstance(value, list):
        raise UnreadableFile(f"{key} must be a list, not {brief(value)}.")
    if count is not None and len(value) != count:
        raise UnreadableFile(f"{key} has {len(value)} entries for {count} {key.split('_')[0]}.")
    return value


def brief(value: object) -> str:
    """Return a value as it stands in the file, cut short for a sentence."""
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."


def faces_of(frame: Frame) -> list[list[int]]:
    """Return the faces of a frame as lists of vertices; none where the file lists none."""
    count = len(array(frame, "vertices_coords"))
    return _loops(frame, "face", "faces_vertices", 3, count) if "faces_vertices" in frame else []


def graph_of(frame: Frame, faces: list[list[int]], notes: list[str]) -> Graph:
    """Return the edges of a frame with its oriented faces.

    What had to be supposed is added to ``notes``.
    """
    count = len(array(frame, "vertices_coords"))
    if "edges_vertices" in frame:
        pairs = _loops(frame, "edge", "edges_vertices", 2, count)
        edges = [(pair[0], pair[1]) for pair in pairs]
    else:
        edges = sorted({(min(side), max(side)) for side in side_faces(faces)})
        notes.append("The file lists no edges; they are the sides of its faces.")
    if not edges:
        raise UnreadableFile("There are no edges (edges_vertices) in this file.")
    stated = _angles(frame, len(edges))
    letters = _letters(frame, edges, faces, stated, notes)
    return Graph(
        edges,
        [{"J": "F"}.get(letter, letter) for letter in letters],
        [_angle(letter, angle) for letter, angle in zip(letters, stated, strict=True)],
        faces,
        numbered(count),
        numbered(len(edges)),
        numbered(len(faces)),
    )


def _loops(frame: Frame, kind: str, key: str, least: int, vertices: int) -> list[list[int]]:
    loops: list[list[int]] = array(frame, key)
    for number, loop in enumerate(loops):
        if not isinstance(loop, list) or len(loop) < least or (kind == "edge" and len(loop) > 2):
            size = "two" if kind == "edge" else "at least three"
            raise UnreadableFile(f"The {kind} {number} must name {size} vertices.")
        for vertex in loop:
            is_index = isinstance(vertex, int) and not isinstance(vertex, bool)
            if not is_index or not 0 <= vertex < vertices:
                raise UnreadableFile(
                    f"The {kind} {number} names the vertex {brief(vertex)}, but the file has "
                    f"vertices 0 to {vertices - 1}."
                )
        if len(set(loop)) < len(loop):
            raise UnreadableFile(f"The {kind} {number} meets one vertex twice: {brief(loop)}.")
    return [list(loop) for loop in loops]


def _angles(frame: Frame, count: int) -> list[float | None]:
    """Return the stated fold angles; the key had an s at its end in FOLD 1.0."""
    key = next((k for k in ("edges_foldAngle", "edges_foldAngles") if k in frame), None)
    if key is None:
        return [None] * count
    angles = array(frame, key, count)
    for edge, angle in enumerate(angles):
        if angle is not None and not _is_finite(angle):
            raise UnreadableFile(f"The fold angle of edge {edge} is {brief(angle)}, no number.")
    return angles


def _letters(
    frame: Frame,
    edges: list[tuple[int, int]],
    faces: list[list[int]],
    angles: list[float | None],
    notes: list[str],
) -> list[str]:
    if "edges_assignment" in frame:
        letters = array(frame, "edges_assignment", len(edges))
        for edge, letter in enumerate(letters):
            if not isinstance(letter, str) or len(letter) != 1 or letter not in _LETTERS:
                raise UnreadableFile(
                    f"The assignment of edge {edge} is {brief(letter)}, "
                    f"not one of {' '.join(_LETTERS)}."
                )
        return letters
    if not faces:
        raise UnreadableFile(
            "Nothing says which edges are boundary, mountain or valley: the file needs "
            "edges_assignment, or at least faces_vertices."
        )
    notes.append("The file assigns no edges; what is beside one face only is boundary.")
    left = side_faces(faces)
    return [
        _letter_of(angle) if (a, b) in left and (b, a) in left else "B"
        for (a, b), angle in zip(edges, angles, strict=True)
    ]


def _letter_of(angle: float | None) -> str:
    if angle is None:
        return "U"
    return "V" if angle > 0 else "M" if angle < 0 else "F"


def _angle(letter: str, angle: float | None) -> float:
    """Return a fold angle in deg; where nothing is stated a mountain or valley folds flat."""
    if letter in "BCJ":
        return 0.0  # no crease, so a number here means nothing
    if angle is None:
        return {"M": -_CLOSED, "V": _CLOSED}.get(letter, 0.0)
    return float(angle)
