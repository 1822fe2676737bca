"""The frames of a FOLD file: inheritance, and which of them are the pattern and its folded form."""

from __future__ import annotations

from typing import Any

import numpy as np

from foldmill.errors import UnreadableFile
from foldmill.exchange.elements import brief, coordinates
from foldmill.exchange.json_text import Frame

PATTERN, FOLDED, OTHERS = 0, 1, 2
"""The numbers frames get in memory and in our files: pattern, folded form, all others."""

_COORDS = "vertices_coords"
_FLAT_SHARE = 1e-6
"""Share of the size by which the vertices of a flat sheet may leave their plane: files are rounded,
and a folded form leaves it by far more."""


def frames_of(data: Frame) -> list[Frame]:
    """Return the key frame and the frames after it, as they stand in the file."""
    others = data.get("file_frames", [])
    if not isinstance(others, list) or not all(isinstance(frame, dict) for frame in others):
        raise UnreadableFile("file_frames must be a list of frames.")
    key = {name: value for name, value in data.items() if not name.startswith("file_")}
    return [key, *others]


def resolved(frames: list[Frame], number: int) -> Frame:
    """Return a frame with everything it inherits; raises UnreadableFile for a bad parent."""
    chain, frame = [frames[number]], frames[number]
    while frame.get("frame_inherit") is True:
        parent = _parent(frame)
        if parent is None or not 0 <= parent < len(frames) or len(chain) > len(frames):
            raise UnreadableFile(
                f"Frame {number} inherits from frame {brief(frame.get('frame_parent'))}, which is "
                f"not there, or from itself."
            )
        frame = frames[parent]
        chain.append(frame)
    merged: Frame = {}
    for each in reversed(chain):
        merged |= each
    return {k: v for k, v in merged.items() if k not in {"frame_parent", "frame_inherit"}}


def _parent(frame: Frame) -> int | None:
    parent = frame.get("frame_parent")
    return parent if isinstance(parent, int) and not isinstance(parent, bool) else None


def pick(frames: list[Frame], wanted: int | None = None) -> tuple[int, int | None]:
    """Return the numbers of the pattern's frame and of its folded form's; raises UnreadableFile.

    wanted : the frame that is to be the pattern; by default the first that can be.
    """
    whole = [resolved(frames, k) for k in range(len(frames))]
    drawn = [k for k, frame in enumerate(whole) if frame.get("vertices_coords")]
    if not drawn:
        raise UnreadableFile("There are no vertices (vertices_coords) in this file.")
    if wanted is not None and wanted not in drawn:
        known = ", ".join(str(k) for k in drawn)
        raise UnreadableFile(f"There are no vertices in a frame {wanted}; those with any: {known}.")
    if wanted is not None and not is_flat(whole[wanted]):
        raise UnreadableFile(f"Frame {wanted} is not flat, so it is no crease pattern.")
    flat = next((k for k in drawn if _is_pattern(whole[k])), None) if wanted is None else wanted
    if flat is None:
        raise UnreadableFile(
            "This file holds a folded form without its flat pattern, and a sheet is cut from the "
            "pattern. Give a file with a creasePattern frame, or unfold this one."
        )
    return flat, next((k for k in drawn if _is_folded_form_of(whole[k], whole[flat])), None)


def patterns(frames: list[Frame]) -> list[int]:
    """Return the numbers of all frames that can be the pattern, each with vertices of its own."""
    whole = {k: resolved(frames, k) for k, frame in enumerate(frames) if frame.get(_COORDS)}
    return [k for k, frame in whole.items() if _is_pattern(frame)]


def _classes(frame: Frame) -> list[Any]:
    classes = frame.get("frame_classes", [])
    return classes if isinstance(classes, list) else [classes]


def _is_pattern(frame: Frame) -> bool:
    classes = _classes(frame)
    return ("creasePattern" in classes or "foldedForm" not in classes) and is_flat(frame)


def is_flat(frame: Frame) -> bool:
    """Tell whether all vertices of a frame lie at one height; raises UnreadableFile."""
    places = np.array(coordinates(frame, 3))
    return bool(np.ptp(places[:, 2]) <= _FLAT_SHARE * np.ptp(places, axis=0).max())


def _is_folded_form_of(frame: Frame, pattern: Frame) -> bool:
    """Tell whether a frame is the pattern folded as the pattern says, not a step on the way."""
    same = ("edges_vertices", "faces_vertices", "edges_assignment", "edges_foldAngle")
    return (
        "foldedForm" in _classes(frame)
        and isinstance(frame["vertices_coords"], list)
        and len(frame["vertices_coords"]) == len(pattern["vertices_coords"])
        and all(frame.get(key) == pattern.get(key) for key in same)
    )


def others(frames: list[Frame], pattern: int, folded: int | None) -> list[Frame]:
    """Return the further frames, their parents numbered as in memory."""
    rest = [k for k in range(len(frames)) if frames[k] and k not in {pattern, folded}]
    numbers = {k: OTHERS + n for n, k in enumerate(rest)} | {pattern: PATTERN}
    numbers |= {} if folded is None else {folded: FOLDED}
    return [_renumbered(frames[k], numbers) for k in rest]


def without_folded(frames: list[Frame]) -> list[Frame]:
    """Return further frames as they are numbered in a file that has no folded form."""
    numbers = {OTHERS + k: OTHERS + k - 1 for k in range(len(frames))} | {FOLDED: PATTERN}
    return [_renumbered(frame, numbers) for frame in frames]


def _renumbered(frame: Frame, numbers: dict[int, int]) -> Frame:
    parent = _parent(frame)
    return frame if parent is None else {**frame, "frame_parent": numbers.get(parent, parent)}
