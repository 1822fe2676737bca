"""Lines of a file that cross or lie on each other, mended before they become a crease pattern.

A file of our own, and any other whose lines already are a planar graph, stays as it is to the byte.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from foldmill import planar
from foldmill.errors import InvalidPattern, UnreadableFile
from foldmill.exchange.elements import array, coordinates, faces_of, graph_of
from foldmill.exchange.graph import Graph
from foldmill.exchange.json_text import Frame
from foldmill.exchange.keys import (
    ADDED,
    CUT,
    DERIVED,
    DESIGN,
    DESIGNED,
    OF,
    POLYGON,
    SEAMS,
    SYMMETRY,
)
from foldmill.exchange.sheet import oriented, read_sheet, scale
from foldmill.finding import Finding, Severity
from foldmill.pattern import Floats
from foldmill.planarise import Change, Planar, planarise_graph
from foldmill.slits import banks
from foldmill.tolerances import FOLD_ANGLE_READ_DEG

RANKS = {"B": 5, "C": 4, "M": 3, "V": 3, "U": 2, "F": 1}
"""Of lines upon each other the one that does more stays: what is cut through needs no score."""

_LEFT_OUT = DERIVED | {
    *("faceOrders", "edgeOrders", ADDED, POLYGON, DESIGN, DESIGNED, SEAMS, SYMMETRY)
}
"""Keys that name what a mended file has no longer: faces, and the design it was."""

_SAID = {
    "weld": ("Vertices at one place became one:", "vertex", "vertices"),
    "crossing": ("Lines were split where they cross or meet at", "place", "places"),
    "overlap": ("Lines lay upon others and were left out along", "stretch", "stretches"),
    "joint": ("Lines that go straight on were joined at", "vertex", "vertices"),
    "crumb": ("Lines without length were left out:", "line", "lines"),
}


@dataclass(frozen=True)
class Mended:
    """A frame whose lines are a planar graph, and what was changed to get it."""

    frame: Frame
    changes: tuple[Change, ...]

    def findings(self) -> tuple[Finding, ...]:
        """Return one finding for each kind of change, with its count and first place."""
        return findings_of(self.changes)


def findings_of(changes: Sequence[Change]) -> tuple[Finding, ...]:
    """Return one finding for each kind of change, with its count and first place."""
    found = []
    for kind, (words, one, many) in _SAID.items():
        own = [change for change in changes if change.what == kind]
        if own:
            x, y = own[0].x, own[0].y
            count = f"{len(own)} {one if len(own) == 1 else many}"
            where = f"({x:g}, {y:g}) mm" if len(own) == 1 else f"first at ({x:g}, {y:g}) mm"
            message = f"{words} {count}."
            found.append(Finding(f"mended-{kind}", Severity.INFO, where, message, at=(x, y)))
    return tuple(found)


def mend(frame: Frame, notes: list[str], most: int | None = None) -> Mended:
    """Return a frame whose lines meet only at vertices; the frame itself where they do already.

    A mended frame is in mm and lists no faces; arrays over its edges and vertices follow them, with
    null for a new vertex. Every part of a split line keeps letter and fold angle. Raises
    UnreadableFile where creases of different fold angles lie upon each other, saying where, and
    InvalidPattern where the lines would become more than ``most``.
    """
    if OF in frame and CUT in frame:
        return Mended(frame, ())  # written by foldmill, the banks of its cuts upon each other
    faces, unit = faces_of(frame), scale(frame, [])
    points = np.array(coordinates(frame, 2), float) * unit
    graph = graph_of(frame, faces, [])
    found = _planarised(points, graph, most)
    if not found.changes or _has_slit(frame):
        return Mended(frame, ())
    _refuse_conflicts(found.changes, graph)
    scale(frame, notes)
    graph_of(frame, faces, notes)
    whole = [face for face in faces if planar.signed_area(points[face])]
    mirrored = oriented(points, whole, notes)[2]
    return Mended(_frame(frame, graph, found, points, mirrored), found.changes)


def _planarised(points: Floats, graph: Graph, most: int | None) -> Planar:
    """Return the planar graph of the lines; those of one letter and one angle have one role."""
    kinds = list(zip(graph.letters, graph.angles, strict=True))
    names = {kind: number for number, kind in enumerate(dict.fromkeys(kinds))}
    ranks = [RANKS[letter] for letter in graph.letters]
    roles = [names[kind] for kind in kinds]
    return planarise_graph(points, np.array(graph.edges, np.intp), roles, ranks, most)


def _has_slit(frame: Frame) -> bool:
    """Tell whether a frame is a pattern already, whose lines upon each other are a slit's banks."""
    try:
        return len(banks(read_sheet(frame, []).pattern)) > 0
    except (UnreadableFile, InvalidPattern):
        return False


def _refuse_conflicts(changes: Sequence[Change], graph: Graph) -> None:
    for change in changes:
        one, two = change.line, change.under
        if change.what != "overlap" or not {graph.letters[one], graph.letters[two]} <= {*"MV"}:
            continue
        if abs(graph.angles[one] - graph.angles[two]) > FOLD_ANGLE_READ_DEG:
            said = [f"{n} is {graph.letters[n]}, {graph.angles[n]:g}°" for n in sorted((one, two))]
            raise UnreadableFile(
                f"Two creases lie upon each other at ({change.x:g}, {change.y:g}) mm and fold "
                f"differently: edge {said[0]}; edge {said[1]}. Remove one of them."
            )


def _frame(frame: Frame, graph: Graph, found: Planar, points: Floats, mirrored: bool) -> Frame:
    used, edges = np.unique(found.edges, return_inverse=True)
    places = found.points[used]
    own = {(x, y): number for number, (x, y) in reversed(list(enumerate(points.tolist())))}
    sources = {
        "vertices": [own.get((x, y)) for x, y in places.tolist()],
        "edges": found.lines.tolist(),
    }
    counts = {"vertices": len(points), "edges": len(graph.edges)}
    mended: Frame = {}
    for key, value in frame.items():
        kind = key.split("_", 1)[0]
        if kind == "faces" or key in _LEFT_OUT:
            continue
        listed = isinstance(value, list) and len(value) == counts.get(kind)
        mended[key] = _spread(value, sources[kind]) if listed else value
    letters = array(frame, "edges_assignment") if "edges_assignment" in frame else graph.letters
    return mended | {
        "frame_unit": "mm",
        "vertices_coords": (places * [1.0, -1.0] if mirrored else places).tolist(),
        "edges_vertices": edges.reshape(-1, 2).tolist(),
        "edges_assignment": [letters[line] for line in found.lines],
        "edges_foldAngle": [graph.angles[line] for line in found.lines],
    }


def _spread(value: list[Any], sources: Sequence[int | None]) -> list[Any]:
    return [None if source is None else value[source] for source in sources]
