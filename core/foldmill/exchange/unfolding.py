"""A file that holds a folded form only: its facets are laid out flat, and so is the pattern.

A sheet folds without stretching. So each facet has its true shape in the folded form, and laying
one beside the other along their common edges gives the flat sheet, the same by whatever way.
"""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange import frames
from foldmill.exchange.elements import coordinates, faces_of, graph_of
from foldmill.exchange.graph import Graph, side_faces
from foldmill.exchange.json_text import Frame
from foldmill.pattern import Floats
from foldmill.tolerances import FOLD_ANGLE_READ_DEG, NEARLY_CLOSED_DEG

_SHARE = 1e-5
"""Share of the size by which facets may bend, and the sheet may fail to close: files are rounded.
"""
_CARRIED = ("vertices_coords", "faceOrders", "edgeOrders", "frame_parent", "frame_inherit")


def laid_flat(data: Frame, wanted: int | None, notes: list[str]) -> Frame:
    """Return the object of a FOLD file with a pattern, where it has a folded form only.

    wanted : the frame that is asked for. Any other file is returned as it is. What was done is
    added to ``notes``. Raises UnreadableFile for a form that no flat sheet folds into.
    """
    every = frames.frames_of(data)
    number = _folded_only(every, wanted)
    if number is None:
        return data
    frame = frames.resolved(every, number)
    faces = faces_of(frame)
    if not faces:
        raise UnreadableFile("The folded form lists no faces, so it cannot be laid flat.")
    graph = graph_of(frame, faces, [])
    solid = np.array(coordinates(frame, 3))
    size = _size(solid)
    said = list(graph.letters), list(graph.angles)
    letters, angles = _believed(solid, graph, notes)
    flat = _flat(solid, graph, size)
    if not any(angles) and any(said[1]):
        notes.append("The sheet of the file stands in space but is not folded: it is the pattern.")
        return _unfolded(data, frame, _upright(flat, solid, graph), graph, *said)
    notes.append("The file holds a folded form only; its facets were laid flat.")
    return _with_pattern(data, frame, _level(flat, graph), graph, letters, angles)


def _folded_only(every: list[Frame], wanted: int | None) -> int | None:
    """Return the number of the frame to lay flat; None where there is a pattern."""
    if wanted is None and _any_pattern(every):
        return None
    numbers = range(len(every)) if wanted is None else [wanted]
    for number in numbers:
        if 0 <= number < len(every):
            frame = frames.resolved(every, number)
            is_form = "foldedForm" in frame.get("frame_classes", [])
            if frame.get("vertices_coords") and (is_form or _stands(frame, wanted)):
                return number
    return None


def _stands(frame: Frame, wanted: int | None) -> bool:
    """Tell whether a frame of no said class, or said to be a pattern, lies in no level plane.

    Some programs have y upward, so that their patterns stand upright.
    """
    return wanted is None and bool(frame.get("faces_vertices")) and not frames.is_flat(frame)


def _any_pattern(every: list[Frame]) -> bool:
    return bool(frames.patterns(every))


def _flat(solid: Floats, graph: Graph, size: float) -> Floats:
    """Return the places (V, 2) of the vertices in the flat sheet."""
    left = side_faces(graph.faces)
    shapes = [_shape(solid[face], number, size) for number, face in enumerate(graph.faces)]
    hinges = {
        side
        for (a, b), letter in zip(graph.edges, graph.letters, strict=True)
        if letter not in "BC"
        for side in ((a, b), (b, a))
    }
    flat = np.full((len(solid), 2), np.nan)
    flat[graph.faces[0]] = shapes[0]
    waiting, laid = deque([0]), {0}
    while waiting:
        face = graph.faces[waiting.popleft()]
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            other = left.get((b, a))
            if other is None or other in laid or (a, b) not in hinges:
                continue
            loop = graph.faces[other]
            placed = _beside(shapes[other], loop.index(b), loop.index(a), flat[b], flat[a])
            _lay(flat, loop, placed, size)
            laid.add(other)
            waiting.append(other)
    if len(laid) < len(graph.faces):
        raise UnreadableFile(
            f"The folded form falls into parts: face {min(set(range(len(shapes))) - laid)} hangs "
            f"on no other by a crease."
        )
    flat[np.isnan(flat)] = 0.0  # of vertices in no face
    return flat


def _upright(flat: Floats, solid: Floats, graph: Graph) -> Floats:
    """Return the sheet turned so that x points right, as it is seen in space."""
    places, x = flat - flat.mean(axis=0), solid[:, 0] - solid[:, 0].mean()
    right = np.linalg.lstsq(places, x, rcond=None)[0]
    size = np.hypot(*right)
    if size < 0.5:  # the sheet stands across the x axis
        return _level(flat, graph)
    u, v = right / size
    upright: Floats = places @ np.array([[u, -v], [v, u]])
    return upright


def _level(flat: Floats, graph: Graph) -> Floats:
    """Return the sheet turned so that its longest side of the outline lies at the bottom."""
    sides = {*side_faces(graph.faces)}
    rim = [side for side in sorted(sides) if side[::-1] not in sides]
    if not rim:
        return flat
    steps = np.array([flat[b] - flat[a] for a, b in rim])
    lengths = np.hypot(*steps.T)
    x, y = steps[int(np.argmax(lengths > lengths.max() * (1 - _SHARE)))] / lengths.max()
    level: Floats = flat @ np.array([[x, -y], [y, x]])
    return level


def _shape(corners: Floats, number: int, size: float) -> Floats:
    """Return a facet (n, 2) in its own plane, counter-clockwise; raises where it is not plane."""
    normal = _normal(corners, number, size)
    sides = np.roll(corners, -1, axis=0) - corners
    side = sides[np.linalg.norm(sides, axis=1).argmax()]
    along = side / np.linalg.norm(side)
    off = float(np.ptp(corners @ normal))
    if off > _SHARE * size:
        raise UnreadableFile(f"The face {number} is not plane: its corners are {off:.4g} off.")
    across = np.cross(normal, along)
    shape: Floats = np.stack([corners @ along, corners @ across], axis=1)
    return shape


def _beside(shape: Floats, i: int, j: int, a: Floats, b: Floats) -> Floats:
    """Return a shape turned and moved so that its corners i and j come to a and b."""
    own, there = shape[j] - shape[i], b - a
    turn = complex(*there) / complex(*own)
    turn /= abs(turn)
    moved: Floats = np.array([[turn.real, turn.imag], [-turn.imag, turn.real]])
    placed: Floats = (shape - shape[i]) @ moved + a
    return placed


def _lay(flat: Floats, loop: list[int], placed: Floats, size: float) -> None:
    """Give the corners of a face their places; raises where they have others already."""
    known = ~np.isnan(flat[loop, 0])
    off = np.hypot(*(flat[loop] - placed).T)
    off[~known] = 0.0
    worst = int(off.argmax())
    if off[worst] > _SHARE * size:
        raise UnreadableFile(
            f"The folded form cannot be laid flat: round vertex {loop[worst]} the facets miss each "
            f"other by {off[worst]:.4g}. No flat sheet folds into it without a cut."
        )
    flat[np.array(loop)[~known]] = placed[~known]


def _believed(solid: Floats, graph: Graph, notes: list[str]) -> tuple[list[str], list[float]]:
    """Return letters and fold angles; turns the sheet over where its letters say so throughout.

    Letters are those of the file for what folds by 180°, and measured for all else.
    """
    letters, angles = _measured(solid, graph)
    disputed = _disputed(graph.letters, letters)
    agreed = _open(angles) - disputed
    if disputed and not agreed:
        notes.append("By its letters the sheet is seen from its back, so it is turned over.")
        graph.faces = [face[:1] + face[:0:-1] for face in graph.faces]
        return _measured(solid, graph)
    if disputed:
        notes.append(
            f"{disputed} creases fold the other way than their letters say; the form was believed."
        )
    return letters, angles


def _disputed(said: list[str], measured: list[str]) -> int:
    return sum({one, two} == {"M", "V"} for one, two in zip(said, measured, strict=True))


def _open(angles: list[float]) -> int:
    return sum(0 < abs(angle) < 180 for angle in angles)


def _measured(solid: Floats, graph: Graph) -> tuple[list[str], list[float]]:
    left = side_faces(graph.faces)
    size = _size(solid)
    normals = [_normal(solid[face], number, size) for number, face in enumerate(graph.faces)]
    letters: list[str] = []
    angles: list[float] = []
    for (a, b), letter in zip(graph.edges, graph.letters, strict=True):
        f, g = left.get((a, b)), left.get((b, a))
        if letter in "BC" or f is None or g is None:
            letters.append("C" if letter == "C" else "B")
            angles.append(0.0)
            continue
        along = (solid[b] - solid[a]) / np.linalg.norm(solid[b] - solid[a])
        sine, cosine = np.cross(normals[f], normals[g]) @ along, normals[f] @ normals[g]
        meant, turn = _settled(letter, -float(np.degrees(np.arctan2(sine, cosine))))
        letters.append(meant)
        angles.append(turn)
    return letters, angles


def _settled(letter: str, angle: float) -> tuple[str, float]:
    if abs(angle) >= 180 - NEARLY_CLOSED_DEG:
        return {"M": ("M", -180.0), "V": ("V", 180.0)}.get(letter, ("U", 180.0))
    if abs(angle) <= FOLD_ANGLE_READ_DEG:
        return "F", 0.0
    return ("V" if angle > 0 else "M"), angle


def _normal(corners: Floats, number: int, size: float) -> Floats:
    """Return the unit normal of a face, to whose tip it runs counter-clockwise."""
    normal: Floats = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    length = float(np.linalg.norm(normal))
    if length <= (_SHARE * size) ** 2:
        raise UnreadableFile(f"The face {number} has no area.")
    return normal / length


def _size(solid: Floats) -> float:
    return float(np.ptp(solid, axis=0).max()) or 1.0


def _with_pattern(
    data: Frame, frame: Frame, flat: Floats, graph: Graph, letters: list[str], angles: list[float]
) -> Frame:
    """Return an object whose key frame is the pattern, the folded form after it."""
    unit = {"frame_unit": frame["frame_unit"]} if "frame_unit" in frame else {}
    solid: dict[str, Any] = {
        key: frame[key] for key in ("faceOrders", "edgeOrders") if key in frame
    }
    form = {
        "frame_classes": ["foldedForm"],
        "frame_attributes": ["3D"],
        "frame_parent": 0,
        "frame_inherit": True,
        **unit,
        "vertices_coords": [[*place, 0.0][:3] for place in frame["vertices_coords"]],
        **solid,
    }
    pattern = _unfolded(data, frame, flat, graph, letters, angles)
    return {**pattern, "file_frames": [form]}


def _unfolded(
    data: Frame, frame: Frame, flat: Floats, graph: Graph, letters: list[str], angles: list[float]
) -> Frame:
    """Return an object whose one frame is the pattern."""
    head = {k: v for k, v in data.items() if k.startswith("file_") and k != "file_frames"}
    other = {k: v for k, v in frame.items() if k not in _CARRIED and not k.startswith("frame_")}
    unit = {"frame_unit": frame["frame_unit"]} if "frame_unit" in frame else {}
    return {
        **head,
        **other,
        **unit,
        "frame_classes": ["creasePattern"],
        "vertices_coords": (flat - flat.min(axis=0)).tolist(),
        "edges_vertices": [list(edge) for edge in graph.edges],
        "edges_assignment": letters,
        "edges_foldAngle": angles,
        "faces_vertices": graph.faces,
    }
