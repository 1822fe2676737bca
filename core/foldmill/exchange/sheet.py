"""From the elements of one frame to a crease pattern: oriented, joined, triangulated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from foldmill import planar
from foldmill.errors import UnreadableFile
from foldmill.exchange import cuts
from foldmill.exchange.elements import array, brief, coordinates, faces_of, graph_of
from foldmill.exchange.graph import Graph, is_order, numbered
from foldmill.exchange.json_text import Frame
from foldmill.exchange.keys import ADDED, CUT, DERIVED, JOIN, MILLIMETRES, OF, POLYGON, WRITTEN
from foldmill.exchange.limits import DEFAULT
from foldmill.pattern import Assignment, CreasePattern, Floats, Indices, codes_of
from foldmill.planarise.lines import TOUCH_MM
from foldmill.planarise.meetings import meetings
from foldmill.triangulation import triangulate


@dataclass(frozen=True, eq=False)
class Sheet:
    """A pattern read from a frame, and which of the file's elements it keeps."""

    pattern: CreasePattern
    graph: Graph
    """Its sources name the file's elements."""
    counts: dict[str, int]
    """How many vertices, edges and faces the file has."""
    reversed: set[int]
    """Faces of the file that ran clockwise among others that did not."""

    @property
    def corners(self) -> list[int]:
        """The vertex each polygon begins with; empty where there are triangles only."""
        loops = self.graph.faces
        return [loop[0] for loop in loops] if any(len(loop) > 3 for loop in loops) else []

    def foreign(self, frame: Frame) -> Frame:
        """Return the keys of a frame that are not written anew, their arrays as the pattern's."""
        other = {k: v for k, v in frame.items() if k not in WRITTEN and k not in DERIVED}
        letters = frame.get("edges_assignment")
        if isinstance(letters, list) and "J" in letters:
            other[JOIN] = [letter == "J" for letter in letters]
        return {key: self.kept(key, value) for key, value in other.items()}

    def kept(self, key: str, value: Any) -> Any:
        """Return a per-element array of the file as one of the pattern; else the value itself."""
        if key == "faceOrders" and isinstance(value, list):
            return [self._order(order) for order in value]
        kind = key.split("_", 1)[0]
        if not isinstance(value, list) or len(value) != self.counts.get(kind):
            return value
        return [value[source[0]] for source in self.graph.sources(key)]

    def _order(self, order: Any) -> Any:
        """Return [f, g, s] for polygons, s changed where face g has been turned over."""
        if not is_order(order):
            return order
        f, g, s = order
        owner = self.graph.owners
        return [owner.get(f, f), owner.get(g, g), -s if g in self.reversed else s]


def read_sheet(frame: Frame, notes: list[str]) -> Sheet:
    """Return the pattern of a frame; raises UnreadableFile or InvalidPattern.

    What had to be supposed is added to ``notes``.
    """
    points = np.array(coordinates(frame, 2), float) * scale(frame, notes)
    faces, turned, mirrored = oriented(points, faces_of(frame), notes)
    points = points * [1.0, -1.0] if mirrored else points
    graph = graph_of(frame, faces, notes)
    if not faces:
        graph.faces = _found_faces(points, graph)
        graph.face_source = numbered(len(graph.faces))
    counts = {"vertices": len(points), "edges": len(graph.edges), "faces": len(graph.faces)}
    if OF in frame and CUT in frame:
        cuts.join(graph, array(frame, OF), array(frame, CUT))
        points = points[: len(graph.vertex_source)]
    _check_sides(graph)
    if ADDED in frame and POLYGON in frame:
        pattern = _marked(points, graph, array(frame, ADDED), array(frame, POLYGON))
    else:
        pattern = _triangulated(points, graph)
    return Sheet(pattern, graph, counts, turned)


def scale(frame: Frame, notes: list[str]) -> float:
    """Return the millimetres in a frame's unit; raises UnreadableFile for an unknown one."""
    unit = frame.get("frame_unit", "unit")
    if unit == "unit":
        notes.append("The file states no unit; its coordinates are taken as millimetres.")
        return 1.0
    if not isinstance(unit, str) or unit not in MILLIMETRES:
        known = ", ".join(MILLIMETRES)
        raise UnreadableFile(
            f"The frame_unit {brief(unit)} is none of the format's units: {known}."
        )
    if unit != "mm":
        notes.append(f"The file is in {unit}; its coordinates are converted to millimetres.")
    return MILLIMETRES[unit]


def oriented(
    points: Floats, faces: list[list[int]], notes: list[str]
) -> tuple[list[list[int]], set[int], bool]:
    """Return faces that run counter-clockwise, which were turned, and whether to mirror the sheet.

    A face runs counter-clockwise seen from its front. So a sheet of clockwise faces is one seen
    from its back: it is turned over. Where only some do, the file just does not orient its faces.
    """
    areas = planar.signed_areas(points, faces)
    for number in np.flatnonzero(areas == 0).tolist():
        raise UnreadableFile(f"The face {number} has no area.")
    clockwise = set(np.flatnonzero(areas < 0).tolist())
    if clockwise and len(clockwise) == len(faces):
        notes.append(
            "All faces run clockwise: the sheet is seen from its back, and is turned over."
        )
        return faces, set(), True
    if clockwise:
        notes.append(
            f"{len(clockwise)} of {len(faces)} faces run clockwise; they are turned round, and "
            f"mountains and valleys taken as seen with y up."
        )
    turned = [f[:1] + f[:0:-1] if k in clockwise else f for k, f in enumerate(faces)]
    return turned, clockwise, False


def _found_faces(points: Floats, graph: Graph) -> list[list[int]]:
    """Return the faces between the lines of a frame that lists none."""
    lines = np.array(graph.edges, np.intp)
    if (points[lines[:, 0]] == points[lines[:, 1]]).all(axis=1).any():
        raise UnreadableFile("An edge has no length, so no faces can be found between the lines.")
    loops = [[int(v) for v in loop] for loop in planar.polygons(points, lines)]
    for loop in loops:
        twice = next((v for k, v in enumerate(loop) if v in loop[:k]), None)
        if twice is not None:
            _refuse_crossing(points, lines)
            raise UnreadableFile(
                f"The lines at vertex {twice} end inside the sheet, so they bound no faces; remove "
                f"them, or draw them on to another line."
            )
    if not loops:
        raise UnreadableFile("The lines of this file enclose no face.")
    return loops


def _refuse_crossing(points: Floats, lines: Indices) -> None:
    """Refuse lines that meet between their ends: they bound no faces before they are split."""
    edge, _, vertex, spots = meetings(points, lines, TOUCH_MM, DEFAULT.lines)
    if len(edge):
        x, y = spots[vertex[0]]
        raise UnreadableFile(
            f"The edge {edge[0]} meets another between its ends, at ({x:.4g}, {y:.4g}) mm, and "
            f"there is no vertex that both have; so it is at {len(np.unique(vertex))} places."
        )


def _check_sides(graph: Graph) -> None:
    """Refuse faces whose sides are no edges, and faces that lie on the same side of an edge."""
    known = {*graph.edges, *((b, a) for a, b in graph.edges)}
    owners: dict[tuple[int, int], int] = {}
    for number, face in enumerate(graph.faces):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            if (a, b) not in known:
                raise UnreadableFile(f"The face {number} has the side {a}-{b}, which is no edge.")
            if (a, b) in owners:
                raise UnreadableFile(
                    f"The faces {owners[a, b]} and {number} lie on the same side of the edge "
                    f"{a}-{b}: a sheet has one face on either side."
                )
            owners[a, b] = number
    for number, (a, b) in enumerate(graph.edges):
        sides = ((a, b) in owners) + ((b, a) in owners)
        wanted = {"B": 1, "C": sides}.get(graph.letters[number], 2)
        if sides != wanted:
            kind = "boundary" if wanted == 1 else "crease"
            raise UnreadableFile(
                f"The edge {number} ({a}-{b}) is marked {graph.letters[number]}, but has faces on "
                f"{sides} of its sides; a {kind} has {wanted}."
            )


def _triangulated(points: Floats, graph: Graph) -> CreasePattern:
    _check_polygons(points, graph.faces)
    faces, owners, extra = triangulate(points, graph.faces)
    old, new = len(graph.edges), len(extra)
    return CreasePattern(
        points,
        np.vstack([np.array(graph.edges, np.intp), extra]),
        np.append(codes_of(graph.letters), np.full(new, Assignment.F)).astype(np.uint8),
        np.append(graph.angles, np.zeros(new)),
        faces,
        np.append(np.zeros(old, bool), np.ones(new, bool)),
        owners,
    )


def _check_polygons(points: Floats, loops: list[list[int]]) -> None:
    import shapely

    for number, loop in enumerate(loops):
        if len(loop) > 3 and not shapely.Polygon(points[loop]).is_valid:
            raise UnreadableFile(f"The sides of face {number} cross or touch each other.")


def _marked(points: Floats, graph: Graph, added: list[Any], polygon: list[Any]) -> CreasePattern:
    """Return the pattern of a file that was written triangle by triangle."""
    if not _marks_fit(graph, added, polygon):
        raise UnreadableFile(f"{ADDED} and {POLYGON} do not fit the file's edges and faces.")
    flags = np.array([added[source[0]] is True for source in graph.edge_source], bool)
    pattern = CreasePattern(
        points,
        np.array(graph.edges, np.intp),
        codes_of(graph.letters),
        np.array(graph.angles),
        np.array(graph.faces, np.intp),
        flags,
        np.array(polygon, np.intp),
    )
    graph.edge_source = [s for s, flag in zip(graph.edge_source, flags, strict=True) if not flag]
    graph.face_source = [(polygon.index(number),) for number in range(max(polygon) + 1)]
    graph.owners = dict(enumerate(polygon))
    return pattern


def _marks_fit(graph: Graph, added: list[Any], polygon: list[Any]) -> bool:
    return (
        all(source[0] < len(added) for source in graph.edge_source)
        and len(polygon) == len(graph.faces) > 0
        and all(len(face) == 3 for face in graph.faces)
        and all(isinstance(number, int) for number in polygon)
        and sorted(set(polygon)) == list(range(len(set(polygon))))
    )
