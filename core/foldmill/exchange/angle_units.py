"""Fold angles in radians: FOLD states degrees, and programs that state radians do not say so.

A file tells by its numbers: a crease that folds flat has ±180 in degrees and ±3.14159 in radians,
and no sheet is folded whose creases all fold by 3.14 degrees or less, the farthest by just π.
"""

from __future__ import annotations

from math import degrees, pi
from typing import Any

from foldmill.errors import UnreadableFile
from foldmill.exchange import frames
from foldmill.exchange.json_text import Frame
from foldmill.exchange.options import RADIANS
from foldmill.finding import Finding, Severity

_KEYS = ("edges_foldAngle", "edges_foldAngles")
_NEAR = 2e-3
"""Of π: files of two decimals have 3.14."""
_LARGEST = 1e9
"""What is larger is no angle, and refused where angles are read."""
_OWN = "foldmill"
"""Begins the file_creator of our own files, which state degrees."""


def in_degrees(data: Frame, said: str | None) -> tuple[Frame, list[Finding]]:
    """Return the object of a FOLD file with its fold angles in deg, and what there is to tell.

    said : what the person says they are in; None where nothing is said. Raises UnreadableFile where
    nothing is said and they can only be radians.
    """
    if said == RADIANS:
        return _converted(data), []
    if said is not None or str(data.get("file_creator", "")).startswith(_OWN):
        return data, []
    largest = max((abs(each) for each in _angles(data)), default=0.0)
    if abs(largest - pi) <= _NEAR:
        raise UnreadableFile(
            f"The fold angles of this file go up to {largest:.6g}, which is π: they are radians, "
            f"and FOLD states degrees. Say --angles radians, or --angles degrees where a crease "
            f"is to fold by {largest:.3g}°."
        )
    return data, [_doubted(largest)] if 0 < largest < pi else []


def _doubted(largest: float) -> Finding:
    message = f"No crease of the file folds by more than {largest:.3g}°."
    remedy = "If its angles are radians, say --angles radians."
    return Finding("import-angles", Severity.WARNING, "", message, remedy)


def _angles(data: Frame) -> list[float]:
    """Return every fold angle of every frame that is a number."""
    return [
        angle
        for frame in frames.frames_of(data)
        for key in _KEYS
        if isinstance(frame.get(key), list)
        for angle in frame[key]
        if _is_number(angle)
    ]


def _is_number(angle: object) -> bool:
    is_plain = isinstance(angle, int | float) and not isinstance(angle, bool)
    return is_plain and -_LARGEST <= angle <= _LARGEST  # type: ignore[operator]


def _converted(data: Frame) -> Frame:
    """Return the object with deg for rad in all its frames; what is no number stays."""
    others = [_frame(frame) for frame in frames.frames_of(data)[1:]]
    return {**_frame(data), **({"file_frames": others} if others else {})}


def _frame(frame: Frame) -> Frame:
    listed = [key for key in _KEYS if isinstance(frame.get(key), list)]
    return {**frame, **{key: [_degrees(angle) for angle in frame[key]] for key in listed}}


def _degrees(angle: Any) -> Any:
    """Return an angle in deg; of ±π as files round it, ±180."""
    if not _is_number(angle):
        return angle
    if abs(abs(angle) - pi) <= _NEAR:
        return 180.0 if angle > 0 else -180.0
    return degrees(angle)
