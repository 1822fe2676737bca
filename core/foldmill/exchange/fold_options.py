"""Read a FOLD file as a person says: which frame, how large, laid flat where it is folded only."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from foldmill.design import Fold
from foldmill.exchange import fold as fold_file
from foldmill.exchange import frames, json_text
from foldmill.exchange.angle_units import in_degrees
from foldmill.exchange.elements import array, coordinates
from foldmill.exchange.json_text import Frame
from foldmill.exchange.keys import MILLIMETRES
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.options import Options
from foldmill.exchange.scaling import factor
from foldmill.exchange.unfolding import laid_flat
from foldmill.finding import Finding, Severity

_COUNTED = ("vertices_coords", "edges_vertices", "faces_vertices")


def read(content: bytes, options: Options, limits: Limits = DEFAULT) -> tuple[Fold, bool]:
    """Return the fold of a FOLD file, and whether it is known how large it is.

    What had to be supposed is told by its findings. Raises UnreadableFile or InvalidPattern.
    """
    limits.check_size(len(content))
    data = json_text.parse(content.decode("utf-8", errors="replace"))
    for frame in frames.frames_of(data):
        for key in _COUNTED:
            if isinstance(frame.get(key), list):
                limits.check_lines(len(frame[key]))
    data, doubted = in_degrees(data, options.angles)
    notes: list[str] = []
    flat = laid_flat(data, options.frame, notes)
    options = options if flat is data else replace(options, frame=0)
    data, every = flat, frames.frames_of(flat)
    said = _about_frames(every, options)
    unit = _unit(every, options)
    if _is_scaled(options):
        data = _scaled(data, every, options, unit)
    fold = fold_file.read_data(
        data, planarise=options.planarise, frame=options.frame, limits=limits
    )
    notes += fold.meta["fold"]["notes"]
    findings = [
        *said,
        *doubted,
        *(Finding("import-note", Severity.INFO, "", note) for note in notes),
    ]
    told = Fold(
        fold.pattern,
        fold.folded,
        fold.symmetry,
        meta=fold.meta,
        findings=(*findings, *fold.findings),
    )
    return told, unit is not None or _is_scaled(options)


def _is_scaled(options: Options) -> bool:
    return any(each is not None for each in (options.unit, options.scale, options.width))


def _about_frames(every: list[Frame], options: Options) -> list[Finding]:
    able = frames.patterns(every)
    if options.frame is not None or len(able) < 2:
        return []
    listed = ", ".join(str(k) for k in able)
    message = f"{len(able)} frames of the file are patterns ({listed}); frame {able[0]} was taken."
    return [Finding("import-frame", Severity.INFO, "", message, "--frame takes another.")]


def _unit(every: list[Frame], options: Options) -> float | None:
    """Return the mm in the unit that the pattern's frame states; None where it states none."""
    first, _ = frames.pick(every, options.frame)
    unit = frames.resolved(every, first).get("frame_unit")
    return MILLIMETRES.get(unit) if isinstance(unit, str) else None


def _scaled(data: Frame, every: list[Frame], options: Options, unit: float | None) -> Frame:
    """Return the object with all its coordinates in mm, as the person says."""
    first, _ = frames.pick(every, options.frame)
    points = np.array(coordinates(frames.resolved(every, first), 2), float)
    times = factor(points[:, None, :], [""] * len(points), unit, options)
    own = unit or 1.0
    scaled = [_in_mm(every, k, times, own) for k in range(len(every))]
    head = {key: value for key, value in data.items() if key.startswith("file_")}
    return {**head, **scaled[0], **({"file_frames": scaled[1:]} if scaled[1:] else {})}


def _in_mm(every: list[Frame], number: int, times: float, unit: float) -> Frame:
    """Return a frame in mm; one in another unit than the pattern's keeps its proportion to it."""
    frame = every[number]
    if "vertices_coords" not in frame:
        return {**frame, "frame_unit": "mm"} if "frame_unit" in frame or number == 0 else frame
    stated: Any = frames.resolved(every, number).get("frame_unit", "unit")
    share = MILLIMETRES.get(stated, unit) / unit if isinstance(stated, str) else 1.0
    places = [
        [x * times * share for x in place] if isinstance(place, list) else place
        for place in _checked(frame)
    ]
    return {**frame, "frame_unit": "mm", "vertices_coords": places}


def _checked(frame: Frame) -> list[Any]:
    coordinates(frame, 3)
    return array(frame, "vertices_coords")
