"""FOLD 1.2, out and in, in the profile that every known reader accepts.

Always numbers for the fold angles, never the letters J and C, coordinates in mm. The folded form is
a second frame. Reading marks ``Fold.meta["read"]``, and keeps in ``Fold.meta["fold"]`` whatever
foldmill does not understand; writing gives it back:

``frame``, ``folded``
    the other keys of the pattern's frame and of the folded form's; arrays over the elements fit the
    pattern's vertices, edges that are not added, and polygons
``frames``
    all further frames as they are, except that parents are numbered 0 for the pattern, 1 for the
    folded form, and from 2 on for these
``corners``
    the vertex with which each polygon begins
``notes``
    sentences for people about what had to be supposed; they are not written
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from foldmill.design import Fold, Symmetry
from foldmill.errors import InvalidPattern, UnreadableFile
from foldmill.exchange import cuts, frames, json_text, mending
from foldmill.exchange.elements import array, coordinates
from foldmill.exchange.graph import Graph, middle, of_polygons, of_triangles
from foldmill.exchange.json_text import Frame, plains
from foldmill.exchange.keys import ADDED, DESIGN, DESIGNED, POLYGON, SEAMS, SYMMETRY
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.sheet import Sheet, read_sheet, scale
from foldmill.folded import FoldedForm
from foldmill.pattern import Floats

_CLASSES = ("creasePattern", "foldedForm")


def read(text: str, name: str = "", *, planarise: bool = False) -> Fold:
    """Return the fold in the text of a FOLD file; ``name`` is for the sentences of refusals.

    planarise : whether lines that cross or lie on each other are mended first, and
    ``Fold.findings`` then tell how; what needs no mending is read as without. Raises
    UnreadableFile, saying which element is wrong and how.
    """
    try:
        return read_data(json_text.parse(text), planarise=planarise)
    except (UnreadableFile, InvalidPattern) as error:
        place = f"{name}: " if name else ""
        raise UnreadableFile(f"{place}{error}") from None


def read_data(
    data: Frame,
    *,
    planarise: bool = False,
    frame: int | None = None,
    limits: Limits = DEFAULT,
) -> Fold:
    """Return the fold in the object of a FOLD file, as ``read`` does.

    frame : the number of the frame that is the pattern; by default the first that can be. Raises
    UnreadableFile or InvalidPattern.
    """
    every = frames.frames_of(data)
    first, second = frames.pick(every, frame)
    return _read(data, every, first, second, limits.lines if planarise else None)


def _read(
    data: Frame, every: list[Frame], first: int, second: int | None, most: int | None
) -> Fold:
    """most : edges that may come of mending its lines; None where they are not mended."""
    notes: list[str] = []
    frame = frames.resolved(every, first)
    frame |= {key: value for key, value in data.items() if key.startswith("file_")}
    mended = mending.Mended(frame, ()) if most is None else mending.mend(frame, notes, most)
    if mended.changes:
        # What else the file holds is about lines that are no longer those.
        frame, every, first, second = mended.frame, [mended.frame], 0, None
        notes.append("Its lines were mended; its other frames and its faces are left out.")
    sheet = read_sheet(frame, notes)
    kept: dict[str, Any] = {"frame": sheet.foreign(frame), "corners": sheet.corners, "notes": notes}
    meta: dict[str, Any] = {"fold": kept, "read": True}
    folded = None
    if second is not None:
        solid = frames.resolved(every, second)
        folded = _folded(solid, sheet)
        own = {key: value for key, value in solid.items() if frame.get(key) != value}
        kept["folded"] = sheet.foreign(own)
    kept["frames"] = [_kept(each, sheet, frame) for each in frames.others(every, first, second)]
    if isinstance(frame.get("file_title"), str):
        meta["title"] = frame["file_title"]
    if isinstance(frame.get(DESIGN), dict):
        meta["design"] = kept["frame"].pop(DESIGN)
    if _is_said(frame.get(DESIGNED)):
        meta["designed"] = kept["frame"].pop(DESIGNED)
    symmetry = _symmetry(frame, sheet)
    return Fold(sheet.pattern, folded, symmetry, meta=meta, findings=mended.findings())


def _is_said(stated: Any) -> bool:
    """Tell whether a value is names with plain values, as a family says of its result."""
    return isinstance(stated, dict) and all(
        isinstance(value, str | int | float) for value in stated.values()
    )


def _kept(other: Frame, sheet: Sheet, pattern: Frame) -> Frame:
    """Return a further frame, changed only where it leans on what the pattern's frame was."""
    if other.get("frame_inherit") is not True:
        return other
    kept = {key: sheet.kept(key, value) for key, value in other.items()}
    unit = pattern.get("frame_unit", "mm")
    return kept if unit in {"mm", "unit"} else {"frame_unit": unit, **kept}


def _folded(frame: Frame, sheet: Sheet) -> FoldedForm:
    places = np.array(coordinates(frame, 3)) * scale(frame, [])
    seams = array(frame, SEAMS) if SEAMS in frame else []
    try:
        pairs = np.array(seams, np.intp).reshape(-1, 2)
    except (TypeError, ValueError, OverflowError):
        raise UnreadableFile(f"{SEAMS} must be a list of pairs of vertices.") from None
    return FoldedForm(places[: len(sheet.pattern.vertices)], pairs)


def _symmetry(frame: Frame, sheet: Sheet) -> Symmetry | None:
    stated, count = frame.get(SYMMETRY), len(sheet.pattern.faces)
    if stated is None:
        return None
    order, wedge, one_sided = _stated_symmetry(stated)
    if order < 1 or any(not 0 <= face < count for face in wedge):
        raise UnreadableFile(f"{SYMMETRY} names faces that are not there, or an order below 1.")
    return Symmetry(order, np.array(wedge, np.intp), one_sided)


def _stated_symmetry(stated: Any) -> tuple[int, list[int], bool]:
    frame: Frame = stated if isinstance(stated, dict) else {}
    order, wedge, one_sided = (frame.get(key) for key in ("order", "wedge", "one_sided"))
    numbers: list[Any] = [order, *wedge] if isinstance(wedge, list) else [None]
    is_whole = all(isinstance(n, int) and not isinstance(n, bool) for n in numbers)
    if not is_whole or not isinstance(one_sided, bool):
        raise UnreadableFile(
            f"{SYMMETRY} must have a whole order, a wedge of face numbers and a true or false "
            f"one_sided."
        )
    return numbers[0], numbers[1:], one_sided


def write(fold: Fold, *, triangulated: bool = False) -> str:
    """Return a fold as the text of a FOLD file; the same fold gives the same text.

    Polygons that came with an imported file are written whole. They stay triangles, with keys that
    tell which edges were added, where ``triangulated`` asks for it or the fold's symmetry names
    triangles.
    """
    kept = dict(fold.meta.get("fold", {}))
    graph = cuts.split(_graph(fold, kept.get("corners", []), triangulated))
    data = _head(fold, kept) | _pattern_frame(fold, graph) | _marks(graph) | _about(fold)
    data |= _foreign(kept.get("frame", {}), graph, data)
    further = _further_frames(fold, kept, graph)
    return json_text.dump(data | ({"file_frames": further} if further else {}))


def pattern_alone(fold: Fold, *, opened: bool = True) -> Frame:
    """Return the one frame of a file that holds the pattern and nothing beside it.

    No folded form, no other frames, no keys but those of the format itself, polygons whole where
    they can be. opened : whether inner cuts become two boundaries each, as simulators want them.
    """
    graph = _graph(fold, list(fold.meta.get("fold", {}).get("corners", [])), False)
    return _head(fold, {}) | _pattern_frame(fold, cuts.split(graph) if opened else graph)


def _graph(fold: Fold, corners: list[int], triangulated: bool) -> Graph:
    names_triangles = fold.symmetry is not None and bool(np.any(fold.pattern.added))
    whole = None if triangulated or names_triangles else of_polygons(fold.pattern, corners)
    return whole or of_triangles(fold.pattern)


def _marks(graph: Graph) -> Frame:
    marks: Frame = cuts.marks(graph)
    if graph.owners:
        marks[ADDED] = [not source for source in graph.edge_source]
        marks[POLYGON] = list(graph.owners.values())
    return marks


def _head(fold: Fold, kept: Frame) -> Frame:
    other = kept.get("frame", {})
    title = {"file_title": str(fold.meta["title"])} if fold.meta.get("title") else {}
    return {
        "file_spec": 1.2,
        "file_creator": "foldmill",
        **title,
        "file_classes": other.get("file_classes", ["singleModel"]),
        **_kind("creasePattern", "2D", other),
        "frame_unit": "mm",
    }


def _kind(name: str, space: str, other: Frame) -> Frame:
    """Return a frame's classes and attributes: what we know, and what came from elsewhere."""
    classes = [each for each in _listed(other, "frame_classes") if each not in _CLASSES]
    known = [space, "manifold", "orientable", "noCuts", "noJoins"]
    custom = [each for each in _listed(other, "frame_attributes") if ":" in str(each)]
    return {"frame_classes": [name, *classes], "frame_attributes": [*known, *custom]}


def _listed(frame: Frame, key: str) -> list[Any]:
    value = frame.get(key, [])
    return value if isinstance(value, list) else [value]


def _pattern_frame(fold: Fold, graph: Graph) -> Frame:
    return {
        "vertices_coords": _places(fold.pattern.vertices, graph),
        "edges_vertices": graph.edges,
        "edges_assignment": graph.letters,
        "edges_foldAngle": plains(graph.angles),
        "faces_vertices": graph.faces,
    }


def _places(vertices: Floats, graph: Graph) -> list[Sequence[float]]:
    size = vertices.shape[1]
    flat = iter(plains(_spread(vertices, graph)))
    return list(zip(*[flat] * size, strict=True))


def _spread(vertices: Floats, graph: Graph) -> ArrayLike:
    """Return the places of a graph's vertices: more than a pattern's where cuts were opened."""
    if len(graph.vertex_source) == len(vertices):
        return vertices  # what is split off comes behind all others
    places = vertices.tolist()
    return [middle([places[i] for i in source]) for source in graph.vertex_source]


def _about(fold: Fold) -> Frame:
    known = {DESIGN: fold.meta.get("design"), DESIGNED: fold.meta.get("designed")}
    about: Frame = {key: value for key, value in known.items() if value is not None}
    if fold.symmetry is not None:
        about[SYMMETRY] = {
            "order": fold.symmetry.order,
            "wedge": fold.symmetry.wedge.tolist(),
            "one_sided": fold.symmetry.one_sided,
        }
    return about


def _foreign(other: Frame, graph: Graph, taken: Frame) -> Frame:
    return {key: graph.spread(key, other[key]) for key in sorted(other) if key not in taken}


def _further_frames(fold: Fold, kept: Frame, graph: Graph) -> list[Frame]:
    others = [
        {key: graph.spread(key, value) for key, value in frame.items()}
        if frame.get("frame_inherit") is True
        else frame
        for frame in kept.get("frames", [])
    ]
    if fold.folded is not None:
        return [_folded_frame(fold.folded, kept.get("folded", {}), graph), *others]
    return frames.without_folded(others)


def _folded_frame(folded: FoldedForm, other: Frame, graph: Graph) -> Frame:
    seams = {SEAMS: folded.seams.tolist()} if len(folded.seams) else {}
    frame = {
        **_kind("foldedForm", "3D", other),
        "frame_parent": frames.PATTERN,
        "frame_inherit": True,
        "vertices_coords": _places(folded.vertices, graph),
        **seams,
    }
    return frame | _foreign(other, graph, frame)
